"""Strip width to the second order: cutter and surface as quadratic forms at the contact."""

from math import sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.frame import Feed, frame_from_normal
from toolaxis.contact.strip.cutter_parameters import CAP, CutterParameters, cutter_parameters
from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.numeric.triples import Triple, cross, dot, plus
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.numeric.vectors import dot as dots
from toolaxis.shape.differential import DEGENERATE, curvature_form
from toolaxis.shape.face import Face
from toolaxis.shape.surface import Derivatives
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Form: TypeAlias = tuple[float, float, float]
"""Entries (ff, fk, kk) of a symmetric form in the frame of feed and left."""

SHARPEST = 1e-9
"""Corner radius, as a share of R, that stands in for a sharp corner in curvatures."""
#: Share of a feed's length below which what of it lies in the tangent plane is no direction.
_LOST = 1e-9
#: Contacts with an axis each that are screened at once, every axis at every one of them.
_TOGETHER = 64


@jit
def surface_form(d: Array, feed: Triple, left: Triple, normal: Triple) -> Form:
    """Second fundamental form in an orthonormal tangent frame, 1/mm, positive where bending towards the normal.

    Parameters
    ----------
    d : (6, 3) array
        S, Su, Sv, Suu, Suv, Svv.
    feed, left, normal : Triple
    """
    su, sv = (d[1, 0], d[1, 1], d[1, 2]), (d[2, 0], d[2, 1], d[2, 2])
    l, m = dot((d[3, 0], d[3, 1], d[3, 2]), normal), dot((d[4, 0], d[4, 1], d[4, 2]), normal)
    n = dot((d[5, 0], d[5, 1], d[5, 2]), normal)
    return _turn_form((l, m, n), (dot(su, feed), dot(sv, feed), dot(su, left), dot(sv, left)))


@jit_inline
def _turn_form(second: Form, tangent: tuple[float, float, float, float]) -> Form:
    """A second fundamental form in the frame of feed and left; zeros where Su and Sv span no plane.

    Parameters
    ----------
    second : (L, M, N)
        Of the parameters, mm.
    tangent : tuple of float
        Components of Su and of Sv along the feed, then along left, mm.
    """
    l, m, n = second
    a, b, p, q = tangent
    det = a * q - b * p
    if det == 0.0:
        return 0.0, 0.0, 0.0
    uf, vf, uk, vk = q / det, -p / det, -b / det, a / det
    return (uf * uf * l + 2.0 * uf * vf * m + vf * vf * n, uf * uk * l + (uf * vk + vf * uk) * m + vf * vk * n,
            uk * uk * l + 2.0 * uk * vk * m + vk * vk * n)


@jit
def cutter_form(flat: float, corner: float, axis_f: float, axis_k: float) -> Form:
    """Curvature of the cutter at a contact on its corner arc, 1/mm.

    1/r along the projection of T and sin lambda / (a + r sin lambda) across it; upright on a flat bottom it is zero.

    Parameters
    ----------
    flat, corner : float
        Radii of the flat bottom and of the corner arc, mm.
    axis_f, axis_k : float
        Components of the unit axis along feed and left.
    """
    a, r = flat, max(corner, SHARPEST * (flat + corner))
    lean = sqrt(axis_f * axis_f + axis_k * axis_k)
    if a <= 0.0:
        return 1.0 / r, 0.0, 1.0 / r
    if lean <= 1e-12:
        return 0.0, 0.0, 0.0
    x, y = axis_f / lean, axis_k / lean
    across = lean / (a + r * lean)
    along = 1.0 / r
    return (along * x * x + across * y * y, (along - across) * x * y, along * y * y + across * x * x)


@jit
def compliance(surface: Form, cutter: CutterParameters, axis: Triple) -> tuple[float, float, bool]:
    """(D^-1)_kk, mm, and the advance of the covering contact along the feed per unit to the left.

    D = C_cutter - K_surface in the frame of feed and left: to the second order the lifted surface leaves the swept
    cutter at y = sqrt(2 h (D^-1)_kk), and what covers that point is the contact D_fk / D_ff y ahead.

    Parameters
    ----------
    surface : (ff, fk, kk)
        Second fundamental form in the frame, 1/mm.
    cutter : CutterParameters
    axis : Triple
        Components of the tool axis along feed, left and normal.

    Returns
    -------
    compliance, advance : float
    free : bool
        False where D is not positive definite (the cutter gouges by curvature) or the contact lies on no arc of the
        cutter; then both numbers are 0.
    """
    if axis[2] < cutter.sin - 1e-9:
        return 0.0, 0.0, False
    c_ff, c_fk, c_kk = cutter_form(cutter.flat, cutter.corner, axis[0], axis[1])
    ff, fk, kk = c_ff - surface[0], c_fk - surface[1], c_kk - surface[2]
    if not ff > 0.0:
        return 0.0, 0.0, False
    rest = kk - fk * (fk / ff)
    if not rest > 0.0:
        return 0.0, 0.0, False
    return 1.0 / rest, fk / ff, True


@jit
def _screen(forms: Array, axes: Array, cutter: CutterParameters, scallop: float, out: Array) -> None:
    """Half widths of k axes at n contacts into out (k, n); forms as in `contact_forms`."""
    cap = CAP * (cutter.flat + cutter.corner)
    for j in range(forms.shape[0]):
        f = forms[j]
        for i in range(axes.shape[0]):
            rest, _, free = compliance((f[9], f[10], f[11]), cutter, axis_in_frame(f, axes[i]))
            out[i, j] = min(sqrt(2.0 * scallop * rest), cap) / f[12] if free else 0.0


@jit_inline
def axis_in_frame(form: Array, axis: Array) -> Triple:
    """Components of an axis along feed, left and normal of a contact, from its row of `contact_forms`."""
    t = (axis[0], axis[1], axis[2])
    return dot((form[0], form[1], form[2]), t), dot((form[3], form[4], form[5]), t), dot((form[6], form[7], form[8]), t)


def screen_numpy(forms: Array, axes: Array, cutter: CutterParameters, scallop: float, out: Array) -> None:
    """The plain twin of the screening kernel, written on whole arrays; parameters as there."""
    tf, tk, tn = (axes @ forms[:, 3 * c:3 * c + 3].T for c in range(3))
    ff, fk, kk = relative_forms(forms, (tf, tk), cutter)
    with np.errstate(divide="ignore", invalid="ignore"):
        rest = kk - fk * (fk / ff)
        free = (tn >= cutter.sin - 1e-9) & (ff > 0) & (rest > 0)
        width = np.minimum(np.sqrt(2 * scallop / rest), CAP * (cutter.flat + cutter.corner)) / forms[:, 12]
    out[:] = np.where(free, width, 0.0)


def relative_forms(forms: Array, axis: tuple[Array, Array], cutter: CutterParameters) -> tuple[Array, Array, Array]:
    """Curvature of the cutter less that of the surface, entries (ff, fk, kk) in the frame of feed and left, 1/mm.

    Parameters
    ----------
    forms : (n, 13) array
        As `contact_forms` gives.
    axis : two (..., n) arrays
        Components of unit axes along feed and left.
    cutter : CutterParameters
    """
    tf, tk = axis
    a, r = cutter.flat, max(cutter.corner, SHARPEST * (cutter.flat + cutter.corner))
    lean = np.hypot(tf, tk)
    bottom = (lean <= 1e-12) & (a > 0)
    size = np.where(lean > 0, lean, 1.0)
    x, y = np.where(lean > 0, tf / size, 1.0), tk / size
    along = np.where(bottom, 0.0, 1 / r)
    across = np.where(bottom, 0.0, lean / (a + r * lean) if a > 0 else 1 / r)
    return (np.asarray(along * x * x + across * y * y - forms[:, 9]),
            np.asarray((along - across) * x * y - forms[:, 10]),
            np.asarray(along * y * y + across * x * x - forms[:, 11]))


def screen_many(forms: Array, axes: Array, cutter: CutterParameters, scallop: float) -> Array:
    """Second-order half widths of many axes at many contacts, (k, n).

    Parameters
    ----------
    forms : (n, 13) array
        As of `contact_forms`.
    axes : (k, 3) array
        Unit vectors.
    cutter : CutterParameters
    scallop : float
        mm
    """
    out = np.empty((len(axes), len(forms)))
    (_screen if _compiled.available else screen_numpy)(forms, np.ascontiguousarray(axes), cutter, float(scallop), out)
    return out


def second_order_each(forms: Array, axes: Array, cutter: CutterParameters, scallop: float) -> Array:
    """Second-order half widths of contacts with an axis each, (n,).

    Parameters
    ----------
    forms : (n, 13) array
        As of `contact_forms`.
    axes : (n, 3) array
        Unit vectors.
    cutter : CutterParameters
    scallop : float
        mm
    """
    parts = [slice(begin, begin + _TOGETHER) for begin in range(0, len(forms), _TOGETHER)]
    return np.concatenate([np.diagonal(screen_many(forms[part], axes[part], cutter, scallop)) for part in parts]
                          or [np.empty(0)])


def contact_forms(face: Face, uv: ArrayLike, feed: Feed, steps: bool) -> Array:
    """What the screen needs of a surface, once for all axes.

    Parameters
    ----------
    face : Face
    uv : (n, 2) array_like
    feed : "u", "v" or (3,) or (n, 3) array_like
    steps : bool
        Whether widths are wanted in the step parameter instead of mm.

    Returns
    -------
    (n, 13) array
        Feed, left, normal, second fundamental form (ff, fk, kk) in 1/mm, and mm to the left per unit of the answer.
    """
    rows = as_rows(uv, 2, "uv")
    if steps and not isinstance(feed, str):
        raise InvalidInput("step widths need feed 'u' or 'v': a vector has no step parameter")
    d = face.evaluate(rows)
    compiled = _compiled.available and isinstance(feed, str) and feed in ("u", "v")
    if not compiled or len(face.surface.turning_cells.rows_in(rows)):
        return _forms_plainly(face, rows, d, feed, steps)
    forms, plain = np.empty((len(rows), 13)), np.empty(len(rows), dtype=bool)
    _fill_forms(d, -1.0 if face.flip else 1.0, feed == "u", steps, forms, plain)
    if plain.any():
        some = Derivatives(*(every[plain] for every in d))
        forms[plain] = _forms_plainly(face, rows[plain], some, feed, steps)
    return forms


def _forms_plainly(face: Face, rows: Array, d: Derivatives, feed: Feed, steps: bool) -> Array:
    """The plain twin of the kernel, for degenerate places and folds too."""
    along: ArrayLike = feed
    if isinstance(feed, str):
        if feed not in ("u", "v"):
            raise InvalidInput(f"feed is {feed!r}: it must be 'u', 'v' or a vector")
        along = d.su if feed == "u" else d.sv
    frame = frame_from_normal(face.normal(rows, d), along)
    form = curvature_form(d, frame.normal, frame.feed)
    pace = np.ones(len(rows))
    if steps:
        pace = np.abs(dots(d.sv if feed == "u" else d.su, frame.left))
    return np.column_stack([*frame, form[:, 0, 0], form[:, 0, 1], form[:, 1, 1], pace])


@jit
def _fill_forms(at: Derivatives, sense: float, along_u: bool, steps: bool, out: Array,
                plain: NDArray[np.bool_]) -> None:
    """Rows of `contact_forms` along a parameter, but where Su and Sv nearly span no plane: these are marked.

    Parameters
    ----------
    at : Derivatives
    sense : float
        1 where the normal out of the material is Su x Sv, -1 where it is the opposite.
    along_u, steps : bool
    out : (n, 13) array
        Receives the rows.
    plain : (n,) array of bool
        Receives which of them are left to the plain twin.
    """
    for i in range(out.shape[0]):
        su, sv = (at.su[i, 0], at.su[i, 1], at.su[i, 2]), (at.sv[i, 0], at.sv[i, 1], at.sv[i, 2])
        normal = cross(su, sv)
        size, largest = sqrt(dot(normal, normal)), max(dot(su, su), dot(sv, sv))
        plain[i] = not size > 2.0 * DEGENERATE * largest
        if plain[i]:
            continue
        normal = (sense * normal[0] / size, sense * normal[1] / size, sense * normal[2] / size)
        way, aside = (su, sv) if along_u else (sv, su)
        feed = plus(way, normal, -dot(way, normal))
        size = sqrt(dot(feed, feed))
        plain[i] = not size > 2.0 * _LOST * sqrt(dot(way, way))
        if plain[i]:
            continue
        feed = (feed[0] / size, feed[1] / size, feed[2] / size)
        left = cross(normal, feed)
        a, b, p, q = dot(su, feed), dot(sv, feed), dot(su, left), dot(sv, left)
        l = dot((at.suu[i, 0], at.suu[i, 1], at.suu[i, 2]), normal)
        m = dot((at.suv[i, 0], at.suv[i, 1], at.suv[i, 2]), normal)
        n = dot((at.svv[i, 0], at.svv[i, 1], at.svv[i, 2]), normal)
        ff, fk, kk = _turn_form((l, m, n), (a, b, p, q))
        for c in range(3):
            out[i, c], out[i, 3 + c], out[i, 6 + c] = feed[c], left[c], normal[c]
        out[i, 9], out[i, 10], out[i, 11] = ff, fk, kk
        out[i, 12] = abs(dot(aside, left)) if steps else 1.0


def second_order_many_axes(face: Face, tool: Tool, uv: ArrayLike, axes: ArrayLike, scallop: float, feed: Feed = "u",
                           steps: bool = True) -> Array:
    """Second-order half widths of many axes at many contacts.

    Parameters
    ----------
    face : Face
    tool : Tool
    uv : (n, 2) array_like
        Parameters of the contacts.
    axes : (k, 3) array_like
        Tool axes, tip to spindle.
    scallop : float
        Scallop height h, mm.
    feed : "u", "v" or, where steps is False, (3,) or (n, 3) array_like
    steps : bool
        Answer in the step parameter instead of mm.

    Returns
    -------
    (k, n) array
        Half width, the same on both sides: sqrt(2 h (D^-1)_kk), for steps divided by |S_step . k|; at most 4 R; 0
        where D is not positive definite (curvature gouge) or the contact is not on the cutter's bottom or arc.

    Raises
    ------
    InvalidInput
        When the scallop height is not above zero and below the tool's radius, or an array has a wrong shape.

    Notes
    -----
    Upright on a flat bottom the cutter has no curvature: D = -K.

    **Source**: [zhu2016] Sec. 2.2 uses the section's width; this is that of the swept cutter, the limit of
    `strip_width` for small h.
    """
    cutter = cutter_parameters(tool, scallop, 0.0)
    forms = contact_forms(face, uv, feed, steps)
    return screen_many(forms, np.asarray(unit(as_rows(axes, 3, "axes"))), cutter, scallop)


def second_order_width(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, scallop: float,
                       feed: Feed = "u") -> Array:
    """Strip width to the second order, 2 sqrt(2 h (D^-1)_kk), mm.

    Parameters
    ----------
    face, tool, uv, axis, scallop, feed
        As in `strip_width`.

    Returns
    -------
    (n,) array
        Left and right half width together, mm; conventions as in `second_order_many_axes`.

    Raises
    ------
    InvalidInput
        As in `second_order_many_axes`.
    """
    return 2 * _one_axis_each(contact_forms(face, uv, feed, False), tool, axis, scallop)


def second_order_step_widths(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, scallop: float,
                             feed: str = "u") -> Array:
    """Half widths in the step parameter to the second order.

    Parameters
    ----------
    face, tool, uv, axis, scallop, feed
        As in `step_widths`.

    Returns
    -------
    (n, 2) array
        Towards lower and upper step parameter (equal), conventions as in `second_order_many_axes`.

    Raises
    ------
    InvalidInput
        As in `second_order_many_axes`.
    """
    half = _one_axis_each(contact_forms(face, uv, feed, True), tool, axis, scallop)
    return np.column_stack([half, half])


def _one_axis_each(forms: Array, tool: Tool, axis: ArrayLike, scallop: float) -> Array:
    cutter = cutter_parameters(tool, scallop, 0.0)
    rows = np.ascontiguousarray(unit(as_rows(axis, 3, "axis")))
    screen = _screen if _compiled.available else screen_numpy
    if len(rows) not in (1, len(forms)):
        raise InvalidInput(f"{len(rows)} axes for {len(forms)} contacts: give one axis, or one for each contact")
    out = np.empty(len(forms))
    for k in range(len(rows)):
        part = slice(None) if len(rows) == 1 else slice(k, k + 1)
        screen(forms[part], rows[k:k + 1], cutter, float(scallop), out[None, part])
    return out
