"""Strip width and roughness over a face, the front of one against the other, and what rotary axes do along a pass."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import radians
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.frame import Frame, axis_from_lead_tilt, contact_frame
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.path.moving_axis import MovingCut
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import BLUE, GREY, ORANGE, VERMILION, figure
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.roughness.passes import evaluation_length, roughness_at, spots
from toolaxis.strategies.roughness.search import NOMINAL
from toolaxis.strategies.roughness.section_width import expect_widths, section_width

Array = NDArray[np.float64]

#: Points of all passes at which strip widths are shown.
_POINTS = 4000


@dataclass(frozen=True, eq=False)
class RoughnessStudy:
    """What passes with a moving axis leave on a face; lengths in mm, Ra in um, velocities in deg/s.

    Attributes
    ----------
    place, width : (n, 2), (n,) array
        Places on the face in a plane before it, and section strip widths there.
    spot, roughness : (m, 2), (m,) array
        Places at which Ra was evaluated, and Ra.
    expected : (float, float)
        Range of the strip width.
    limit : float
        Greatest Ra allowed.
    velocities : dict of str to ((k,) array, (k, a) array)
        Ways along one pass and velocities of the rotary axes there, for each way to lean.
    axes : tuple of str
        Names of the rotary axes.
    """

    place: Array
    width: Array
    spot: Array
    roughness: Array
    expected: tuple[float, float]
    limit: float
    velocities: Mapping[str, tuple[Array, Array]]
    axes: tuple[str, ...]


def draw_roughness(plan: Plan, op: Operation, folder: Path) -> None:
    """Draw strip width and Ra over the face of an operation, and what the rotary axes do.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    folder : Path
    """
    roughness_picture(study(plan, op), op.name).savefig(folder / f"{op.name}-roughness.png")


@dataclass(frozen=True, eq=False)
class PathAxes:
    """The axes of a tool path.

    Attributes
    ----------
    feed : str
        "u" or "v".
    steps : (k,) array
        Step parameter of each pass, growing.
    runs : tuple of pairs of (n,), (n, 3) arrays
        Along parameters of each pass, growing, and the axes there.
    """

    feed: str
    steps: Array
    runs: tuple[tuple[Array, Array], ...]

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts, those of the nearest pass; see `AxisField`."""
        along, step = (uv if self.feed == "u" else uv[:, ::-1]).T
        owner = np.abs(self.steps - step[:, None]).argmin(axis=1)
        found = np.empty((len(uv), 3))
        for k in np.unique(owner):
            own, axes = self.runs[k]
            found[owner == k] = np.column_stack([np.interp(along[owner == k], own, column) for column in axes.T])
        return np.asarray(unit(found))


def path_cut(plan: Plan, op: Operation) -> tuple[MovingCut[PathAxes], Array, Array]:
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
    axes = PathAxes(feed, np.array([one[0] for one in passes]), tuple(one[1] for one in passes))
    cut = MovingCut(op.tool, axis, plan.inputs.scallop, plan.inputs.allowance_of(op.face), field=axes)
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
    wide = section_width(face, op.tool, uv[thin], axes[thin], plan.inputs.scallop, feed,
                         plan.inputs.allowance_of(op.face)).sum(axis=1)
    seen = spots(face, feed, evaluation_length(ra))
    rough = roughness_at(face, cut, cut.field.steps, seen, evaluation_length(ra))
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
                          expect_widths(op.tool, NOMINAL, plan.inputs.scallop), 1000 * ra, speeds, names)


def _velocities(plan: Plan, op: Operation, cut: MovingCut[PathAxes]) -> dict[str, tuple[Array, Array]]:
    """Ways and velocities along the middle pass: as planned, and with the constant lead."""
    k = len(cut.field.steps) // 2
    own = cut.field.runs[k][0]
    along = np.linspace(float(own[0]), float(own[-1]), 200)
    uv = np.column_stack([along, np.full(200, cut.field.steps[k])])
    uv = uv if cut.feed == "u" else uv[:, ::-1]
    point, normal = op.face.evaluate(uv).point, op.face.normal(uv)
    way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1)))
    assert isinstance(plan.machine, Mounting)
    found = {}
    for title, axes in (("planned", cut.axes(op.face, uv)), ("20° lead", axis_from_lead_tilt(
            contact_frame(op.face, uv, cut.feed), radians(20.0), 0.0))):
        tip = place(op.face, op.tool, uv, axes, plan.inputs.allowance_of(op.face))
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


def roughness_picture(study: RoughnessStudy, name: str) -> Figure:
    """Strip width and Ra over the face, and velocities of the rotary axes along a pass.

    Parameters
    ----------
    study : RoughnessStudy
    name : str
        Of the operation.
    """
    made = figure(15.0, 4.8)
    made.suptitle(f"{name}: Ra {study.roughness.mean():.3f} µm in the mean, {study.roughness.max():.3f} µm at most of "
                  f"{len(study.roughness)} places; section strip width {study.width.min():.3f} to "
                  f"{study.width.max():.3f} mm")
    _over(made, made.add_subplot(1, 3, 1), (study.place, study.width, 6.0), study.expected, "section strip width, mm")
    _over(made, made.add_subplot(1, 3, 2), (study.spot, study.roughness, 90.0), (0.0, study.limit),
          f"Ra across the feed, µm ({study.limit:g} allowed)")
    ax = made.add_subplot(1, 3, 3)
    for (title, (way, speeds)), dashes in zip(study.velocities.items(), ("-", "--", ":"), strict=False):
        for k, axis in enumerate(study.axes):
            ax.plot(way, speeds[:, k], dashes, color=(BLUE, ORANGE)[k % 2], label=f"{axis}, {title}", linewidth=1.4)
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.set(xlabel="way along the middle pass, mm", ylabel="velocity of the rotary axes, °/s")
    ax.legend(fontsize=8, frameon=False)
    return made


def _over(made: Figure, ax: Axes, rows: tuple[Array, Array, float], limits: tuple[float, float], title: str) -> None:
    place, value, size = rows
    dots = ax.scatter(place[:, 0], place[:, 1], c=value, s=size, cmap="viridis", vmin=limits[0], vmax=limits[1],
                      linewidths=0)
    over = value > limits[1]
    ax.scatter(place[over, 0], place[over, 1], s=1.6 * size, facecolors="none", edgecolors=VERMILION)
    made.colorbar(dots, ax=ax, shrink=0.85).set_label(title)
    ax.set_aspect("equal")
    ax.set(xlabel="mm", ylabel="mm")


def front_picture(rows: Sequence[tuple[str, float, float, float]], limit: float) -> Figure:
    """Mean Ra against the least strip width on the same passes, and the turning of the rotary axes against it.

    Parameters
    ----------
    rows : sequence of (title, least strip width mm, mean Ra um, sum of squared angular velocities (rad/s)^2)
        The first one for comparison, the others in growing strip width.
    limit : float
        Greatest Ra, um.
    """
    made = figure(10.0, 4.4)
    other, own = rows[0], rows[1:]
    for number, (column, label) in enumerate(((2, "mean Ra, µm"), (3, "sum of squared angular velocities, (rad/s)²"))):
        ax = made.add_subplot(1, 2, number + 1)
        ax.plot([row[1] for row in own], [row[column] for row in own], "o-", color=BLUE, label="least turning")
        ax.plot(other[1], other[column], "s", color=VERMILION, label=other[0])
        if column == 2:
            ax.axhline(limit, color=GREY, linewidth=1.0, linestyle="--")
        ax.set(xlabel="least section strip width, mm", ylabel=label)
        ax.legend(fontsize=8, frameon=False)
    return made
