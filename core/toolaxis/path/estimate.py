"""How many passes a face takes, from strip widths at its sample points only."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.second_order import (
    axis_in_frame,
    compliance,
    contact_forms,
    screen_many,
    screen_numpy,
)
from toolaxis.contact.strip.width import step_widths
from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.parametrization import IsoChart, rows
from toolaxis.path.pass_count import panels
from toolaxis.path.sampling import Samples, sample_points
from toolaxis.path.trim_intervals import row_points
from toolaxis.path.width_correction import lean_ratio, lean_ratios, lean_table, screening_cutter
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_ROWS = 24
_ROW_GAPS = 24
_END_ROWS = 5
_FEEDS = ("u", "v")


class Estimates(NamedTuple):
    """Estimates for k axes in both feed directions.

    passes : (k, 2), real-valued number of passes with feed u and v;  length : (k, 2), mm, of the tip's motion.
    inf where the cutter gouges by curvature or leaves no strip.
    """

    passes: Array
    length: Array


class _SampledPasses(NamedTuple):
    """Passes that stand for all others with one feed: geometry of their points, once for all axes.

    Points at the ends of passes belong to places of their own on the border, numbered after the sample points.
    """

    forms: Array
    points: Array
    start: NDArray[np.int64]
    joined: NDArray[np.bool_]
    weight: Array
    owner: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Estimator:
    """A face made ready for estimates with many axes; make it with `Estimator.of`.

    Attributes
    ----------
    face : Face
    tool : Tool
    scallop, allowance : float
        mm
    greatest_step_over : float
        Greatest distance of neighbouring passes, mm; infinite for none.
    samples : Samples
    rows : pair
        Geometry along some passes, for feed u and v.
    ends : pair of (m, 2) arrays
        Parameters of some ends of passes, for feed u and v: sample points of their own, for the narrowest place of a
        pass is often its end, where the exact width feels that the surface goes on straight ahead.
    leans : array
        Ratio of exact to second-order widths on a plane, see `lean_table`.
    """

    face: Face
    tool: Tool
    scallop: float
    allowance: float
    greatest_step_over: float
    samples: Samples
    rows: tuple[_SampledPasses, _SampledPasses]
    ends: tuple[Array, Array]
    leans: Array

    @staticmethod
    def of(face: Face, tool: Tool, scallop: float, allowance: float = 0.0,
           samples: Samples | None = None, greatest_step_over: float = np.inf) -> "Estimator":
        """Prepare a face.

        Parameters
        ----------
        face : Face
        tool : Tool
        scallop, allowance : float
            mm
        samples : Samples, optional
            Sample points; those of `sample_points` with its defaults unless given.
        greatest_step_over : float
            mm
        """
        screening_cutter(tool, scallop, allowance)
        chosen = samples or sample_points(face, tool)
        rows_u, ends_u = _prepare(face, "u", chosen)
        rows_v, ends_v = _prepare(face, "v", chosen)
        leans = lean_table(tool, scallop)
        return Estimator(face, tool, scallop, allowance, greatest_step_over, chosen, (rows_u, rows_v),
                         (ends_u, ends_v), leans)

    def many(self, axes: ArrayLike, feeds: str = "uv", exact: bool = True) -> Estimates:
        """Estimates for many axes.

        Parameters
        ----------
        axes : (k, 3) array_like
        feeds : str
            "u", "v" or "uv": the feed directions that are wanted; the other's column is inf, and so is one in which no
            pass that is looked at meets the face, as small parts of it far apart lie between them.
        exact : bool
            False leaves out the exact widths at the sample points and is some hundred times faster: good for
            screening, optimistic where the axis is near a normal.
        """
        directions = unit(as_rows(axes, 3, "axis"))
        number = len(directions)
        passes = np.full((number, 2), np.inf)
        length = np.full((number, 2), np.inf)
        for k, feed in enumerate(_FEEDS):
            if feed not in feeds or not len(self.rows[k].owner):
                continue
            places = np.concatenate([self.samples.uv, self.ends[k]])
            if exact:
                ratio = self._ratios(directions, feed, places)
            else:
                ratio = np.ones((number, len(places)))
            passes[:, k], length[:, k] = self._sums(self.rows[k], directions, ratio)
        return Estimates(passes, length)

    def literal(self, axes: ArrayLike, feed: str = "u") -> Array:
        """Estimated passes, (k,), as the paper has them: the width at its sample point stands for the whole patch.

        Parameters
        ----------
        axes : (k, 3) array_like
        feed : str

        Notes
        -----
        **Source**: [zhu2016] Eqs. (3) to (5); the average strip width of Eq. (6) is one over the result.
        """
        directions = unit(as_rows(axes, 3, "axis"))
        width = self._widths(directions, feed, self.samples.uv)
        of_step = [2, 3] if feed == "u" else [0, 1]
        low, high = self.samples.extents[:, of_step].T
        edges = np.unique(np.concatenate([low, high]))
        middle = (edges[1:] + edges[:-1]) / 2
        within = (low < middle[:, None]) & (high > middle[:, None])
        is_cut = width > 0
        rate = 1 / np.where(is_cut, width, 1.0)  # Eq. (3), per unit of the parameter
        rate = np.where(is_cut, rate, np.inf)
        section = np.where(within, rate[:, None, :], 0.0).max(axis=2)  # Eq. (5)
        return np.asarray(section @ np.diff(edges))  # Eq. (4), added up

    def _sums(self, table: _SampledPasses, axes: Array, ratio: Array) -> tuple[Array, Array]:
        passes = np.empty(len(axes))
        length = np.empty(len(axes))
        sizes = (self._cutter(), self.scallop, self.greatest_step_over)
        kernel = _sum_rows if _compiled.available else sum_rows_numpy
        kernel(table, np.ascontiguousarray(axes), np.ascontiguousarray(ratio), self.leans, sizes, passes, length)
        return passes, length

    def _cutter(self) -> CutterParameters:
        return screening_cutter(self.tool, self.scallop, self.allowance)

    def _widths(self, axes: Array, feed: str, places: Array) -> Array:
        """Exact strip widths (k, n) in the step parameter at n places."""
        number = len(axes)
        uv = np.tile(places, (number, 1))
        axis = np.repeat(axes, len(places), axis=0)
        halves = step_widths(self.face, self.tool, uv, axis, self.scallop, feed, self.allowance)
        is_cut = (halves > 0).all(axis=1)
        width = np.where(is_cut, halves.sum(axis=1), 0.0)
        return np.asarray(width).reshape(number, -1)

    def _ratios(self, axes: Array, feed: str, places: Array) -> Array:
        """Exact over second-order widths corrected for the lean, (k, n); 0 where there is none."""
        forms = contact_forms(self.face, places, feed, True)
        second = screen_many(forms, axes, self._cutter(), self.scallop)
        along = axes @ forms[:, :3].T
        across = axes @ forms[:, 3:6].T
        second *= lean_ratios(self.leans, along, across)
        exact = self._widths(axes, feed, places)
        is_known = second > 0
        ratio = exact / np.where(is_known, 2 * second, 1.0)
        return np.where(is_known, ratio, 0.0)


def estimate(face: Face, tool: Tool, axis: ArrayLike, scallop: float, feed: str = "u", *,
             samples: Samples | None = None, allowance: float = 0.0, literal: bool = False) -> float | Array:
    """Number of passes from strip widths at sample points.

    Parameters
    ----------
    face : Face
    tool : Tool
    axis : (3,) or (k, 3) array_like
        From tip to spindle.
    scallop : float
        Scallop height, mm.
    feed : str
        "u" or "v": the parameter that varies along the passes.
    samples : Samples, optional
        Sample points; those of `sample_points` with its defaults unless given.
    allowance : float
        Stock left on the surface, mm.
    literal : bool
        The paper's scheme, in which one width stands for a patch.

    Returns
    -------
    float or (k,) array; inf where the axis leaves no strip.

    Raises
    ------
    InvalidInput
        When an argument is out of range.

    Notes
    -----
    Ours carries the exact width from the sample point over its patch in proportion to the second-order width, takes a
    few more samples where passes end, and makes sections thin; so a patch counts with its narrowest place on each
    pass, not with its middle.

    **Source**: [zhu2016] Sec. 3.3.

    **Properties**: (1) range over width where the width is constant; (2) within 2 % of passes really made where every
    normal is 3 degrees or more from the axis; (3) moving, mirroring or swapping parameters changes nothing.
    """
    if feed not in _FEEDS:
        raise InvalidInput(f"feed is {feed!r}: it must be 'u' or 'v'")
    ready = Estimator.of(face, tool, scallop, allowance, samples)
    axes = as_rows(axis, 3, "axis")
    if literal:
        passes = ready.literal(axes, feed)
    else:
        both = ready.many(axes, feed).passes
        passes = both[:, _FEEDS.index(feed)]
    return float(passes[0]) if np.ndim(axis) == 1 else passes


def _prepare(face: Face, feed: str, samples: Samples) -> tuple[_SampledPasses, Array]:
    """Rows of points, and the parameters of the chosen ends of passes."""
    chart = IsoChart(face, feed)
    a0, a1, s0, s1 = chart.bounds
    steps, weight = _gauss(panels(chart))
    found = rows(chart, steps)
    points = row_points(found, (a1 - a0) / _ROW_GAPS)
    line = found.line[points.interval]
    uv = chart.uv(points.along, steps[line])
    start = np.searchsorted(line, np.arange(len(steps) + 1)).astype(np.int64)
    joined = np.diff(points.interval, prepend=-1) == 0
    begins = ~joined
    is_last = ~np.append(joined[1:], False)
    ends = np.flatnonzero(begins | is_last)
    share = (np.arange(_END_ROWS) + 0.5) / _END_ROWS
    some = (share * len(steps)).astype(int)
    chosen = ends[np.isin(line[ends], some)]
    owner = samples.owner(uv)
    if len(chosen):
        along = points.along / (a1 - a0)
        step = steps[line] / (s1 - s0)
        place = np.column_stack([along, step])
        apart = ((place[ends, None] - place[chosen]) ** 2).sum(axis=2)
        owner[ends] = len(samples) + apart.argmin(axis=1)
    forms = contact_forms(face, uv, feed, True)
    point = np.ascontiguousarray(face.evaluate(uv).point)
    return _SampledPasses(forms, point, start, joined, weight, owner), uv[chosen]


def _gauss(edges: Array) -> tuple[Array, Array]:
    """Places and weights of about `_ROWS` passes on panels of the step parameter."""
    share = np.diff(edges) / (edges[-1] - edges[0])
    steps = []
    weights = []
    for low, high, part in zip(edges[:-1], edges[1:], share, strict=True):
        number = max(3, int(np.ceil(_ROWS * part)))
        nodes, weight = np.polynomial.legendre.leggauss(number)
        middle = (low + high) / 2
        half = (high - low) / 2
        steps.append(middle + half * nodes)
        weights.append(half * weight)
    return np.concatenate(steps), np.concatenate(weights)


@jit
def _tip(form: Array, point: Array, cutter: CutterParameters, axis: Array, out: Array) -> None:
    """Tool tip, less the constant shift along the axis."""
    nt = form[6] * axis[0] + form[7] * axis[1] + form[8] * axis[2]
    across = np.sqrt(max(1.0 - nt * nt, 0.0))
    pull = cutter.flat / across if across > 1e-12 else 0.0
    for c in range(3):
        out[c] = point[c] + cutter.offset * form[6 + c] + pull * (form[6 + c] - nt * axis[c])


@jit
def _square(form: Array, axis: Array, cutter: CutterParameters, leans: Array) -> float:
    """Square of the strip width in the step parameter over 8 h: second-order, corrected for the lean."""
    lean = axis_in_frame(form, axis)
    rest, _, free = compliance((form[9], form[10], form[11]), cutter, lean)
    if not free:
        return 0.0
    ratio = lean_ratio(leans, lean[0], lean[1]) / form[12]
    return float(rest * ratio * ratio)


@jit
def _sum_rows(table: _SampledPasses, axes: Array, ratio: Array, leans: Array,
              sizes: tuple[CutterParameters, float, float], passes: Array, length: Array) -> None:
    """Passes and length of each axis: sums over rows of weight over the narrowest strip."""
    forms, points, start, joined, weight, owner = table
    cutter, scallop, greatest = sizes
    widest = greatest * greatest / (8.0 * scallop)
    here, last = np.empty(3), np.empty(3)
    for i in range(axes.shape[0]):
        total = path = 0.0
        for row in range(weight.shape[0]):
            least, run, q0, q1 = np.inf, 0.0, 0.0, 0.0
            for j in range(start[row], start[row + 1]):
                q2 = _square(forms[j], axes[i], cutter, leans) * ratio[i, owner[j]] ** 2
                q2 = min(q2, widest / max(forms[j, 12] ** 2, 1e-300))
                least = min(least, q2)
                if joined[j]:
                    bend = q2 - 2.0 * q1 + q0
                    if joined[j - 1] and q1 <= q0 and q1 <= q2 and bend > 0.0 and q1 > 0.0:
                        least = min(least, max(q1 - 0.125 * (q2 - q0) ** 2 / bend, 0.5 * q1))
                q0, q1 = q1, q2
                _tip(forms[j], points[j], cutter, axes[i], here)
                if joined[j]:
                    run += np.sqrt((here[0] - last[0]) ** 2 + (here[1] - last[1]) ** 2 + (here[2] - last[2]) ** 2)
                last[:] = here
            if start[row + 1] > start[row]:
                rate = weight[row] / (2.0 * np.sqrt(2.0 * scallop * least)) if least > 0.0 else np.inf
                total += rate
                path += rate * run
        passes[i] = total
        length[i] = path


def sum_rows_numpy(table: _SampledPasses, axes: Array, ratio: Array, leans: Array,
                   sizes: tuple[CutterParameters, float, float], passes: Array, length: Array) -> None:
    """The plain twin of the summing kernel, written on whole arrays.

    Parameters
    ----------
    table : tuple
        Forms (n, 13), points (n, 3), first point of each row and n (rows + 1,), whether a point continues the one
        before (n,), weights (rows,), sample that each point belongs to (n,).
    axes : (k, 3) array
    ratio : (k, samples) array
        Exact over second-order width corrected for the lean.
    leans : array
        See `lean_table`.
    sizes : (cutter, scallop, greatest step-over)
    passes, length : (k,) array
        Receive the sums.
    """
    forms, points, start, joined, weight, owner = table
    cutter, scallop, greatest = sizes
    full = np.flatnonzero(np.diff(start) > 0)
    begins = start[full]
    normal = forms[:, 6:9]
    pace = np.maximum(forms[:, 12], 1e-300)
    for i, axis in enumerate(axes):
        half = np.empty((1, len(forms)))
        screen_numpy(forms, axis[None], cutter, scallop, half)
        leaning = lean_ratios(leans, forms[:, :3] @ axis, forms[:, 3:6] @ axis)
        width = 2 * half[0] * ratio[i, owner] * leaning
        width = np.minimum(width, greatest / pace)
        square = _with_vertices(width**2, joined)
        narrowest = np.sqrt(np.minimum.reduceat(square, begins))
        tip = _tips_numpy(cutter, points, normal, axis)
        chords = np.linalg.norm(np.diff(tip, axis=0), axis=1)
        step = np.append(0.0, chords) * joined
        is_cut = narrowest > 0
        strips = 1 / np.where(is_cut, narrowest, 1.0)
        rate = weight[full] * np.where(is_cut, strips, np.inf)
        passes[i] = rate.sum()
        length[i] = (rate * np.add.reduceat(step, begins)).sum()


def _tips_numpy(cutter: CutterParameters, points: Array, normal: Array, axis: Array) -> Array:
    """Tool tips, less the constant shift along the axis, (n, 3); as `_tip`."""
    nt = normal @ axis
    across = np.sqrt(np.maximum(1 - nt**2, 0.0))
    leans = across > 1e-12
    pull = cutter.flat / np.where(leans, across, 1.0)
    pull = np.where(leans, pull, 0.0)
    outwards = normal - nt[:, None] * axis
    return np.asarray(points + cutter.offset * normal + pull[:, None] * outwards)


def _with_vertices(square: Array, joined: NDArray[np.bool_]) -> Array:
    """Local minima lowered to the vertex of the parabola through them and their neighbours."""
    out = square.copy()
    before = square[:-2]
    here = square[1:-1]
    after = square[2:]
    bend = before - 2 * here + after
    within = joined[1:-1] & joined[2:]
    low = within & (here <= before) & (here <= after) & (bend > 0)
    vertex = here - 0.125 * (after - before) ** 2 / np.where(bend > 0, bend, 1.0)
    out[1:-1] = np.where(low, np.maximum(vertex, 0.5 * here), here)
    return out
