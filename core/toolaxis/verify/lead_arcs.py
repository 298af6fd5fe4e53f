"""Whether a tool comes to its passes and leaves them on the arcs that a plan names: from CL data and faces alone."""

from collections.abc import Sequence
from math import degrees
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify.pass_distances import find_contacts

Array = NDArray[np.float64]

#: An entry or exit of so many motions is meant as an arc: ramps have two at most.
_MOTIONS = 4
#: How far radii may be off, as a share and mm, how far an arc may turn away from its pass, and how far its plane may
#: lean from the surface's normal, rad.
_SHARE, _OFF, _TANGENT, _ASIDE = 0.01, 0.002, 0.01, 0.02


class LeadCount(NamedTuple):
    """Entries and exits of an operation: arcs, ends : int, of so many ends so many are arcs;  faults : tuple of str,
    in sentences, what is wrong with arcs."""

    arcs: int
    ends: int
    faults: tuple[str, ...]


class _PassEnd(NamedTuple):
    """name : str;  points : (m, 3) array, mm, from far to the end of the pass;  inner : (3,) array, mm, the next point
    of the pass;  end : int, index of the end of the pass."""

    name: str
    points: Array
    inner: Array
    end: int


def check_leads(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, faces: Sequence[Face], allowance: float,
                radius: float) -> LeadCount:
    """Check the arcs of an operation against the radius that is asked for.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        Cutter locations, mm, and unit axes.
    profile : Profile
    faces : sequence of Face
        What is machined.
    allowance : float
        Stock left on them, mm.
    radius : float
        Of the arcs, mm.

    Notes
    -----
    An end that is entered or left straight is counted, not a fault: there an arc was not proven free.

    **Properties**: 1. moving faces and cutter locations together changes nothing.
    """
    tips, axes, kind = cl
    leads = _find_leads(tips, kind)
    arcs = [one for one in leads if len(one.points) > _MOTIONS]
    if not arcs:
        return LeadCount(0, len(leads), ())
    ends = np.array([one.end for one in arcs])
    normals = np.full((len(arcs), 3), np.nan)
    least = np.full(len(arcs), np.inf)
    for face in faces:
        uv, off = find_contacts(face, profile, (tips[ends], axes[ends]), allowance)
        better = off < least
        normals[better], least[better] = face.normal(uv[better]), off[better]
    known = least <= max(10 * _OFF, 0.05)
    faults = [fault for k, one in enumerate(arcs)
              if (fault := _find_fault(one, normals[k] if known[k] else None, radius))]
    return LeadCount(len(arcs), len(leads), tuple(faults))


def _find_leads(tips: Array, kind: NDArray[np.int8]) -> list[_PassEnd]:
    """The entries and exits of all passes between which the tool is lifted."""
    found = []
    first_cuts = np.flatnonzero((kind[1:] == Motion.CUT) & (kind[:-1] == Motion.ENTRY)) + 1
    for cut in first_cuts:
        begin = cut - 1
        while begin > 0 and kind[begin] == Motion.ENTRY:
            begin -= 1
        if kind[begin] == Motion.LINK:  # elsewhere it goes over from a pass beside
            found.append(_PassEnd("lead-in", tips[begin + 1:cut], tips[cut], int(cut) - 1))
    last_cuts = np.flatnonzero((kind[:-1] == Motion.CUT) & (kind[1:] == Motion.EXIT))
    for cut in last_cuts:
        after = cut + 1
        while after < len(kind) and kind[after] == Motion.EXIT:
            after += 1
        if after < len(kind) and kind[after] == Motion.LINK:  # the last exit is the lift along the axis
            found.append(_PassEnd("lead-out", tips[cut:after - 1][::-1], tips[cut - 1], int(cut)))
    return found


def _find_fault(one: _PassEnd, normal: Array | None, radius: float) -> str:
    """What is wrong with an arc, as a sentence; empty where nothing is."""
    near, middle, far = one.points[-1], one.points[len(one.points) // 2], one.points[0]
    across = np.cross(middle - near, far - near)
    size = float(np.linalg.norm(across))
    where = f"{one.name} at point {one.end + 1}"
    if size == 0:
        return f"{where} is straight, and an arc of {radius:g} mm is asked for"
    across = across / size
    centre = near + _to_centre(middle - near, far - near)
    radii = np.linalg.norm(one.points - centre, axis=1)
    worst = float(radii[np.argmax(np.abs(radii - radius))])
    if abs(worst - radius) > _SHARE * radius + _OFF:
        return f"{where} has a radius of {worst:.3f} mm, and {radius:g} mm are asked for"
    way = np.cross(across, near - centre)
    feed = one.inner - near
    cosine = abs(float(way @ feed)) / float(np.linalg.norm(way) * np.linalg.norm(feed))
    turn = float(np.arccos(min(cosine, 1.0)))
    if turn > _TANGENT:
        return f"{where} meets its pass at {degrees(turn):.2f} deg, and has to touch it"
    if normal is not None:
        aside = float(np.arcsin(min(abs(float(across @ normal)), 1.0)))
        if aside > _ASIDE:
            return f"{where} leans {degrees(aside):.2f} deg from the surface's normal, and has to lie in its plane"
    return ""


def _to_centre(one: Array, other: Array) -> Array:
    """From a point to the centre of the circle through it and two others, given by the ways to these, (3,) mm."""
    across = np.cross(one, other)
    return np.asarray(np.cross(float(one @ one) * other - float(other @ other) * one, across)
                      / (2 * float(across @ across)))
