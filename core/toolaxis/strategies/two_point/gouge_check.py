"""Whether a cutter gouges on motions on which its axis turns: bounds that hold between all points of a path.

While the axis turns by up to an angle from a middle one, no point of the cutter leaves the place that it has under the
middle axis by more than the angle times its distance from the tip.  Motions are cut so short that this costs only a
share of the gouge that is allowed; and because it costs less near the tip, the lower end of the cutter, which touches
the skin, is looked at apart from what is above, which only has to stay out of it.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.clearance.gouge import least_distance, skin_cells
from toolaxis.contact.clearance.queries import keeps_limits
from toolaxis.errors import InvalidInput
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import angle_between, as_rows, unit
from toolaxis.shape.bounding.bounding_tree import BoundingTree
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Share of the allowed distance that the turning on a piece may cost, coarse first, and pieces looked at together.
SHARES, AT_ONCE = (0.85, 0.4, 0.1), 65536


def turning_gouges(tool: Tool, tips: ArrayLike, axis: ArrayLike, skin: BoundingTree | list[Face] | tuple[Face, ...],
                   limit: float, *, allowance: float = 0.0) -> Flags:
    """Whether the cutter may reach deeper than a limit between points of a path: False is proven, (n - 1,).

    Parameters
    ----------
    tool : Tool
        With an upright side.
    tips : (n, 3) array_like
        mm
    axis : (n, 3) array_like
        Unit tool axis, tip to spindle; interpolated linearly between the points, as cutter location data are.
    skin : Cells or sequence of Face
    limit : float
        Depth below the stock that is left, mm, above zero.
    allowance : float
        Stock left on the skin, mm.

    Raises
    ------
    InvalidInput
        When shapes do not fit, or the limit is not a finite number above zero.

    Notes
    -----
    **Properties**: 1. False only where no point between the ends gouges deeper; 2. a straight motion without a turn is
    judged as `toolaxis.contact.clearance.gouge.segment_gouges` does.
    """
    rows = as_rows(tips, 3, "tool tips")
    axes = unit(as_rows(axis, 3, "axis"))
    if len(axes) != len(rows):
        raise InvalidInput(f"{len(axes)} axes are given for {len(rows)} tips: one is needed for each")
    if not (np.isfinite(limit) and limit > 0):
        raise InvalidInput(f"gouge limit is {limit} mm: it must be a finite number above zero")
    cells = skin_cells(skin)
    split = _split(tool)
    deep = least_distance(tool, limit, allowance)
    room = allowance - deep
    answer = np.ones(max(len(rows) - 1, 0), dtype=bool)
    for share in SHARES:
        left = np.flatnonzero(answer)
        parts = max(1, len(left) // 256)
        for some in np.array_split(left, parts):
            motions = _TurningMotions(rows[some], rows[some + 1], axes[some], axes[some + 1])
            answer[some] = _check_motions(split, motions, cells, deep, share * room)
    return answer


class _SplitCutter(NamedTuple):
    """A cutter in two: the tool with its lower end as cutter and the rest as shank, and their reach from the tip."""

    tool: Tool
    near: float
    far: float


class _TurningMotions(NamedTuple):
    """Straight motions of the tip, (k, 3) mm each, and the axes at both ends."""

    begin: Array
    end: Array
    before: Array
    after: Array


def _split(tool: Tool) -> _SplitCutter:
    """The cutter in two: its lower end, and the rest as if it were a shank; how far their points are from the tip."""
    radius = tool.radius
    top = tool.profile.top
    low = max(0.5 * radius, 2 * tool.corner_radius)
    low = min(low, top)
    upper = None
    if top > low:
        upper = np.array([[radius, low], [radius, top]])
    parted = replace(tool, flute_length=low, shank=upper, holder=None, stickout=None)
    near = float(np.hypot(radius, low))
    far = float(np.hypot(radius, top))
    return _SplitCutter(parted, near, far)


def _check_motions(split: _SplitCutter, motions: _TurningMotions, cells: BoundingTree, deep: float,
                   cost: float) -> Flags:
    """Whether some motions were not proven, (k,): least signed distance of the lower end, and what turning may cost."""
    begin, end, before, after = motions
    # A little more than half of the turn: pieces are judged by the axis at their middle.
    turned = 0.5001 * angle_between(before, after)
    parts = np.ceil(turned * split.near / cost)
    parts = np.maximum(parts, 1).astype(np.int64)
    owner, number = number_parts(parts)
    place = (number + 0.5) / parts[owner]
    half = 0.5 / parts[owner]
    way = (end - begin)[owner]
    turn = (after - before)[owner]
    tip = begin[owner] + place[:, None] * way
    middle = before[owner] + place[:, None] * turn
    axis = middle / np.linalg.norm(middle, axis=1, keepdims=True)
    moves = np.stack([tip, half[:, None] * way, axis], axis=1)
    size = turned / parts
    slack = float(size.max(initial=0.0))
    limits = [deep + split.near * slack, max(split.far * slack, 1e-9), -np.inf]
    required = np.tile(limits, (len(cells.faces), 1))
    found = keeps_limits(cells, split.tool, moves, required)
    bad = np.zeros(len(before), dtype=bool)
    bad[owner[found.blocked >= 0]] = True
    return bad
