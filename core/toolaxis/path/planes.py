"""Passes along parallel planes that contain the tool axis."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from toolaxis.advice import DIVIDE
from toolaxis.cldata.toolpath import ToolPath
from toolaxis.contact.strip.second_order import contact_forms, screen_numpy
from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.numeric.grids import grid_nodes
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.cl_points import trace
from toolaxis.path.free_chart import FreeChart
from toolaxis.path.links import Linking
from toolaxis.path.parametrization import Cut
from toolaxis.path.pass_count import Count, measure
from toolaxis.path.pass_layout import Layout, Reach, lay_out
from toolaxis.path.width_correction import lean_ratios
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance, ToleranceLike
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

_GRID = 64
_ITERATIONS = 25
#: Places each way that are found again along the axis, between those of the grid; from what distance on another place
#: was found, as a share of the face's diagonal.
_COVERED, _OTHER = 15, 1e-6
#: Points of a pass at which it is asked whether its plane meets the surface.
_ALONG = 17
#: Least cosine between axis and normal.
_SEEN = 1e-6
_RULE = ("parallel planes need a face that is seen along the axis everywhere: use iso-parametric passes, or "
         f"{DIVIDE}")


@dataclass(frozen=True, eq=False)
class PlaneChart(FreeChart):
    """A face seen along the tool axis: along = S . l, step = S . m, both mm, with l, m, T right-handed.

    Attributes
    ----------
    face : Face
    axis : (3,) array
        Unit tool axis T.
    direction : (3,) array
        Feed direction; its part across the axis counts.

    Raises
    ------
    InvalidInput
        When the direction lies along the axis.
    UnsupportedGeometry
        When the face is not seen from its outer side everywhere along the axis.
    """

    axis: Array
    direction: Array

    def __post_init__(self) -> None:
        axis = unit(as_rows(self.axis, 3, "axis")[0])
        feed = unit(as_rows(self.direction, 3, "direction")[0])
        across = feed - (feed @ axis) * axis
        if np.linalg.norm(across) < 1e-6:
            raise InvalidInput(f"direction {feed.tolist()} lies along the axis {axis.tolist()}: give one across it")
        object.__setattr__(self, "axis", axis)
        object.__setattr__(self, "direction", unit(across))
        facing = self.face.normal(self.face.grid(48, 48)) @ axis
        if facing.size and facing.min() <= _SEEN:
            raise UnsupportedGeometry(f"face {self.face.label} turns away from the axis (n . T = {facing.min():.3g}): "
                                      f"{_RULE}")
        self._check_covered()

    def _check_covered(self) -> None:
        """Check that no place of the face lies above another, by whether places are found again along the axis."""
        uv = self.face.grid(_COVERED, _COVERED)
        if not len(uv):
            return
        points = self.face.evaluate(uv).point
        places = points @ self.frame.T
        found = self.face.evaluate(self.uv(places[:, 0], places[:, 1])).point
        off = np.linalg.norm(found - points, axis=1)
        worst = int(np.argmax(off))
        if off[worst] > _OTHER * self.face.diagonal:
            raise UnsupportedGeometry(f"face {self.face.label} covers itself as seen along the axis, by "
                                      f"{abs((found - points)[worst] @ self.axis):.2f} mm at "
                                      f"{np.round(points[worst], 2).tolist()}: {_RULE}")

    @cached_property
    def frame(self) -> Array:
        """Rows l, m: the directions of along and step."""
        return np.stack([self.direction, np.cross(self.axis, self.direction)])

    @property
    def breaks(self) -> tuple[Array, Array]:
        """None: knots do not run along the planes."""
        return np.empty(0), np.empty(0)

    @cached_property
    def _grid(self) -> tuple[Array, cKDTree]:
        u0, u1, v0, v1 = self.face.bounds
        uv = grid_nodes(np.linspace(u0, u1, _GRID + 1), np.linspace(v0, v1, _GRID + 1))
        uv = uv.reshape(-1, 2)
        uv = uv[self.face.normal(uv) @ self.axis > _SEEN]  # beyond a trimmed face its surface may turn away
        return uv, cKDTree(self.face.evaluate(uv).point @ self.frame.T)

    def uv(self, along: Array, step: Array) -> Array:
        """Parameters (n, 2) of the face at along and step, (n,) each, by Newton's method; beyond the face too."""
        target = np.column_stack([along, step])
        start, tree = self._grid
        uv = start[tree.query(target)[1]].copy()
        todo = np.arange(len(uv))
        (u0, u1), (v0, v1) = self.face.surface.domain
        far = np.array([u1 - u0, v1 - v0])
        for _ in range(_ITERATIONS):
            d = self.face.evaluate(uv[todo])
            miss = target[todo] - d.point @ self.frame.T
            a, b = (d.su @ self.frame.T).T, (d.sv @ self.frame.T).T
            det = a[0] * b[1] - a[1] * b[0]
            det = np.where(np.abs(det) > 1e-300, det, 1e-300)
            move = np.column_stack([miss[:, 0] * b[1] - miss[:, 1] * b[0], a[0] * miss[:, 1] - a[1] * miss[:, 0]])
            move /= det[:, None]
            move *= np.minimum(1.0, 0.5 / np.maximum((np.abs(move) / far).max(axis=1), 1e-300))[:, None]
            uv[todo] += move
            todo = todo[(np.abs(move) / far).max(axis=1) > 1e-13]
            if not len(todo):
                break
        return np.asarray(uv)

    def are_found(self, pieces: Array) -> Bools:
        """Whether planes meet the face, or what continues it beyond its border, all along pieces of passes, (k,).

        Parameters
        ----------
        pieces : (k, 3) array
            along0, along1 and step of each.
        """
        share = np.linspace(0.0, 1.0, _ALONG)
        along = pieces[:, :1] + share * (pieces[:, 1:2] - pieces[:, :1])
        target = np.column_stack([along.ravel(), np.repeat(pieces[:, 2], _ALONG)])
        uv = self.uv(*target.T)
        off = np.linalg.norm(self.places(uv) - target, axis=1)
        good = (off <= _OTHER * self.face.diagonal) & (self.face.normal(uv) @ self.axis > 0)
        return np.asarray(good.reshape(-1, _ALONG).all(axis=1))

    def check_pieces(self, pieces: Array) -> None:
        """Check that passes can be followed, beyond the border of the face too.

        Parameters
        ----------
        pieces : (k, 3) array
            along0, along1 and step of each.

        Raises
        ------
        UnsupportedGeometry
            When what continues the face turns away from the axis where a pass runs out.
        """
        lost = np.flatnonzero(~self.are_found(pieces))
        if len(lost):
            raise UnsupportedGeometry(f"{len(lost)} of {len(pieces)} passes cannot run out beyond the border of face "
                                      f"{self.face.label}, where its surface turns away from the axis: {_RULE}")

    def places(self, uv: Array) -> Array:
        """Along and step of parameters of the face, (n, 2): the inverse of `uv`."""
        return np.asarray(self.face.evaluate(uv).point @ self.frame.T)

    def feed_at(self, uv: Array) -> Array:
        """Unit feed directions of passes at parameters, (n, 3): along the planes, in the face."""
        return np.asarray(unit(np.cross(self.frame[1], self.face.normal(uv))))

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter, towards its lower and its upper end.

        The strip's border is found in the section normal to the feed and then seen along the axis, with the bend of
        the section to the second order.
        """
        uv, feed = self.clip(along, step)
        width = strip_width(self.face, cut.tool, uv, cut.axis, cut.scallop, feed, cut.allowance)
        forms = contact_forms(self.face, uv, feed, False)
        across = self.frame[1]
        lean = forms[:, 3:6] @ across
        bend = 0.5 * forms[:, 11] * (forms[:, 6:9] @ across)
        left, right = width[:, 0], width[:, 1]
        lower = right * lean - bend * right**2
        upper = left * lean + bend * left**2
        return np.column_stack([lower, upper])

    def screen(self, cut: Cut, along: Array, step: Array) -> Array:
        """About the two half widths together, (n,), in the step parameter: second-order, corrected for the lean."""
        uv, feed = self.clip(along, step)
        forms = contact_forms(self.face, uv, feed, False)
        half = np.empty((1, len(forms)))
        screen_numpy(forms, cut.axis[None], cut.numbers, cut.scallop, half)
        ratio = lean_ratios(cut.leans, forms[:, :3] @ cut.axis, forms[:, 3:6] @ cut.axis)
        return np.asarray(2 * half[0] * ratio * (forms[:, 3:6] @ self.frame[1]))

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far, in the along parameter, the cutter reaches at scallop height before and behind a contact, (n, 2)."""
        uv, feed = self.clip(along, step)
        across = np.cross(self.face.normal(uv), feed)
        width = strip_width(self.face, cut.tool, uv, cut.axis, cut.scallop, across, cut.allowance)
        return np.asarray(width * (feed @ self.frame[0])[:, None])


def layout(face: Face, tool: Tool, axis: ArrayLike, scallop: float, direction: ArrayLike, *, allowance: float = 0.0,
           reach: Reach | None = None, progress: Progress = NO_PROGRESS) -> Layout:
    """Place parallel passes without tracing them.

    Parameters
    ----------
    face, tool, axis, scallop, direction, allowance, reach, progress
        As for `passes`.
    """
    cut = Cut(tool, axis, scallop, allowance)  # type: ignore[arg-type]
    return lay_out(PlaneChart(face, cut.axis, direction), cut, reach, progress)  # type: ignore[arg-type]


def count(face: Face, tool: Tool, axis: ArrayLike, scallop: float, direction: ArrayLike,
          allowance: float = 0.0) -> Count:
    """Real-valued number and length of parallel passes with exact strip widths.

    Parameters
    ----------
    face, tool, axis, scallop, direction, allowance
        As for `passes`.
    """
    cut = Cut(tool, axis, scallop, allowance)  # type: ignore[arg-type]
    return measure(PlaneChart(face, cut.axis, direction), cut)  # type: ignore[arg-type]


def passes(face: Face, tool: Tool, axis: ArrayLike, scallop: float, direction: ArrayLike, *, sense: str = "zigzag",
           allowance: float = 0.0, reach: Reach | None = None, tolerance: ToleranceLike = None,
           box: ArrayLike | None = None, linking: Linking | None = None, progress: Progress = NO_PROGRESS) -> ToolPath:
    """Passes in which parallel planes that contain the axis cut the face.

    Parameters
    ----------
    face : Face
        Seen from outside along the axis everywhere.
    tool : Tool
    axis : (3,) array_like
        From tip to spindle.
    scallop : float
        Scallop height, mm.
    direction : (3,) array_like
        Feed direction; its part across the axis counts.
    sense : str
        "zigzag", "climb" or "conventional".
    allowance, reach, tolerance, box, linking, progress
        As in `toolaxis.path.iso_parametric.passes`.

    Returns
    -------
    ToolPath

    Raises
    ------
    InvalidInput, UnsupportedGeometry
        When an argument is out of range, or the face turns away from the axis.

    Notes
    -----
    **Properties**: (1) contacts of a pass lie in one plane; (2) the scallop height is kept.
    """
    placed = layout(face, tool, axis, scallop, direction, allowance=allowance, reach=reach, progress=progress)
    return trace(placed, Tolerance.of(tolerance).chord_for(scallop), sense, box, linking)
