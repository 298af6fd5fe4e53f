"""What the picture of an operation that keeps a roughness shows, from its path."""

from dataclasses import dataclass, field
from math import radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.frame import axis_from_lead_tilt, contact_frame
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.path.constant_lead import LeadCut
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.roughness.passes import evaluation_length, roughness_at, spots
from toolaxis.strategies.roughness.pictures import RoughnessStudy, roughness_picture
from toolaxis.strategies.roughness.search import NOMINAL
from toolaxis.strategies.roughness.section_width import expected_widths, section_width

Array = NDArray[np.float64]

_DPI = 110
#: Points of all passes at which strip widths are shown.
_POINTS = 4000


@dataclass(frozen=True, eq=False)
class PathCut(LeadCut):
    """What cuts with the axes of a tool path.

    Attributes
    ----------
    tool, axis, scallop, allowance, lead, feed
        As for `LeadCut`.
    steps : (k,) array
        Step parameter of each pass, growing.
    runs : tuple of pairs of (n,), (n, 3) arrays
        Along parameters of each pass, growing, and the axes there.
    """

    steps: Array = field(default_factory=lambda: np.empty(0))
    runs: tuple[tuple[Array, Array], ...] = ()

    def axes(self, face: Face, uv: Array) -> Array:
        """Unit axes at contacts, those of the nearest pass, (n, 3).

        Parameters
        ----------
        face : Face
        uv : (n, 2) array
        """
        along, step = (uv if self.feed == "u" else uv[:, ::-1]).T
        owner = np.abs(self.steps - step[:, None]).argmin(axis=1)
        found = np.empty((len(uv), 3))
        for k in np.unique(owner):
            own, axes = self.runs[k]
            found[owner == k] = np.column_stack([np.interp(along[owner == k], own, column) for column in axes.T])
        return np.asarray(unit(found))


def path_cut(plan: Plan, op: Operation) -> tuple[PathCut, Array, Array]:
    """What cuts along the passes of an operation, and the contacts on the face with their axes, (n, 2) and (n, 3).

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.

    Raises
    ------
    InvalidInput
        When no contact lies on the face.
    """
    assert op.path is not None
    path, feed = op.path, op.orientation.feed
    rows = np.flatnonzero(path.kind == Motion.CUT)
    found = nearest(op.face, path.cc[rows])
    rows, uv = rows[found.distance < 1e-6], found.uv[found.distance < 1e-6]
    if not len(rows):
        raise InvalidInput(f"no contact of {op.name} lies on its face")
    pair = uv if feed == "u" else uv[:, ::-1]
    number = np.searchsorted(path.breaks, rows, side="right")
    passes = []
    for k in np.unique(number):
        some = np.flatnonzero(number == k)
        order = some[np.argsort(pair[some, 0], kind="stable")]
        passes.append((float(np.median(pair[some, 1])), (pair[order, 0], path.axis[rows[order]])))
    passes.sort(key=lambda one: one[0])
    axis = op.orientation.axis
    assert axis is not None
    cut = PathCut(plan.tool, axis, plan.inputs.scallop, plan.inputs.allowance, float(op.orientation.lead or 0.0), feed,
                  np.array([one[0] for one in passes]), tuple(one[1] for one in passes))
    return cut, uv, path.axis[rows]


def study(plan: Plan, op: Operation) -> RoughnessStudy:
    """Strip widths and Ra over the face of an operation, and velocities of the rotary axes along its middle pass.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    """
    face, feed, ra = op.face, op.orientation.feed, plan.inputs.roughness
    cut, uv, axes = path_cut(plan, op)
    thin = slice(None, None, max(len(uv) // _POINTS, 1))
    wide = section_width(face, plan.tool, uv[thin], axes[thin], plan.inputs.scallop, feed,
                         plan.inputs.allowance).sum(axis=1)
    seen = spots(face, feed, evaluation_length(ra))
    rough = roughness_at(face, cut, cut.steps, seen, evaluation_length(ra))
    middle = face.grid(9, 9)
    up = np.asarray(unit(face.normal(middle).mean(axis=0)))
    across = contact_frame(face, middle[40:41], feed)
    x = np.asarray(unit(across.feed[0] - (across.feed[0] @ up) * up))
    plane = np.stack([x, np.cross(up, x)], axis=1)
    points = [face.evaluate(rows).point @ plane for rows in (uv[thin], seen)]
    speeds: dict[str, tuple[Array, Array]] = {}
    names: tuple[str, ...] = ()
    if plan.machine is not None:
        names = tuple(axis.name for axis in plan.machine.machine.rotary)
        speeds = _velocities(plan, op, cut)
    return RoughnessStudy(points[0], wide, points[1], 1000 * rough,
                          expected_widths(plan.tool, NOMINAL, plan.inputs.scallop), 1000 * ra, speeds, names)


def _velocities(plan: Plan, op: Operation, cut: PathCut) -> dict[str, tuple[Array, Array]]:
    """Ways and velocities along the middle pass: as planned, and with the constant lead."""
    k = len(cut.steps) // 2
    own = cut.runs[k][0]
    along = np.linspace(float(own[0]), float(own[-1]), 200)
    uv = np.column_stack([along, np.full(200, cut.steps[k])])
    uv = uv if cut.feed == "u" else uv[:, ::-1]
    point, normal = op.face.evaluate(uv).point, op.face.normal(uv)
    way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1)))
    assert isinstance(plan.machine, Mounting)
    found = {}
    for title, axes in (("planned", cut.axes(op.face, uv)), ("20° lead", axis_from_lead_tilt(
            contact_frame(op.face, uv, cut.feed), radians(20.0), 0.0))):
        tip = place(op.face, plan.tool, uv, axes, plan.inputs.allowance)
        path = ToolPath(point, tip, axes, normal, np.full(200, Motion.CUT, dtype=np.int8),
                        np.array([0, 200], dtype=np.int64))
        try:
            along_ = following(plan.machine.machine, path, plan.machine.table_from_part)
        except InvalidInput:  # the machine cannot follow it: nothing to show
            continue
        last = np.searchsorted(along_.arrival, np.arange(200), side="right") - 1
        rate = np.diff(np.degrees(along_.rotary[last]), axis=0) / np.diff(way)[:, None] * plan.inputs.feedrate / 60
        found[title] = ((way[1:] + way[:-1]) / 2, rate)
    return found


def draw_roughness(plan: Plan, op: Operation, folder: Path) -> None:
    """Draw strip width and Ra over the face of an operation, and what the rotary axes do.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    folder : Path
    """
    roughness_picture(study(plan, op), op.name).savefig(folder / f"{op.name}-roughness.png", dpi=_DPI)
