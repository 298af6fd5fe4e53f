"""Sub-surfaces, and rests of them, that wait for a tool of the rack."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygon_boolean import join_touching
from toolaxis.plan.operation import Operation
from toolaxis.regions.tool_choice import AxisTime, ToolChain
from toolaxis.shape.face import Face
from toolaxis.skin.alike import AlikeFace

Array = NDArray[np.float64]

#: Share of what a tool reaches of a face under any axis that it must reach under one to be asked for the whole face,
#: and share of the face.
_WHOLE, _MUCH = 0.8, 0.3


@dataclass(frozen=True, eq=False)
class WaitingSurface:
    """What waits for a tool: a sub-surface, or what is left of it.

    root : Face
        The sub-surface that was asked for.
    loops : tuple of (m, 2) arrays
        In (u, v) of it, what earlier tools left; empty for the whole of it.
    tool : int
        Number of the tool.
    left_by : frozenset of int
        Places in the list of operations of those that left it.
    in_pieces : bool
        Whether the tool reaches too little of it under one axis to be asked for all of it.
    axes : tuple of AxisTime
        Axes under which the choice of tools reckoned with it, the quickest first.
    axis : (3,) array or None
        The axis that was chosen of these.
    shared : bool
        Whether the tool machines something else under that axis too.
    copies : tuple of AlikeFace
        Faces that are alike the root, on which the same was done so far.
    """

    root: Face
    loops: tuple[Array, ...]
    tool: int
    left_by: frozenset[int] = frozenset()
    in_pieces: bool = False
    axes: tuple[AxisTime, ...] = ()
    axis: Array | None = None
    shared: bool = False
    copies: tuple[AlikeFace, ...] = ()

    @property
    def area(self) -> float:
        """Area of what waits, mm^2, without copies."""
        return self.root.trimmed(self.loops).area if self.loops else self.root.area


def is_in_pieces(chain: ToolChain) -> bool:
    """Whether the first tool of a chain reaches too little of a face under one axis to be asked for all of it.

    Parameters
    ----------
    chain : ToolChain
    """
    return chain.first < _WHOLE or chain.share < _MUCH


def wait_alone(op: Operation, origin: WaitingSurface, alike: AlikeFace,
               left_by: frozenset[int]) -> list[WaitingSurface]:
    """What waits on a face where an operation that is done on its like is refused, or may have an axis of its own.

    Parameters
    ----------
    op : Operation
        On the face that it is alike.
    origin : WaitingSurface
        Of which that operation was made.
    alike : AlikeFace
    left_by : frozenset of int
        Places in the list of operations of those that left it on the copy.

    Returns
    -------
    list of WaitingSurface
        Empty where its loops enclose nothing there.
    """
    whole = op.face.label == origin.root.label
    loops = () if whole else alike.carry_loops(op.face.outline)
    if not whole and not loops:
        return []
    axis = origin.axis if op.orientation.axis is None else op.orientation.axis
    moved = None if axis is None else alike.matrix[:3, :3] @ axis
    return [WaitingSurface(alike.face, loops, origin.tool, left_by, origin.in_pieces and whole, axis=moved)]


def merge_waiting(some: Sequence[WaitingSurface]) -> list[WaitingSurface]:
    """What waits for a tool, that of one sub-surface together; rests apart from what no tool has machined yet.

    Areas tell by that what is counted already.

    Parameters
    ----------
    some : sequence of WaitingSurface
    """
    found: dict[tuple[int, bool, tuple[str, ...]], WaitingSurface] = {}
    for one in some:
        key = id(one.root), bool(one.left_by), tuple(alike.face.label for alike in one.copies)
        before = found.get(key)
        found[key] = one if before is None else replace(
            one, loops=join_touching((*before.loops, *one.loops)), left_by=before.left_by | one.left_by,
            in_pieces=before.in_pieces or one.in_pieces, axes=_axes_for_both(before.axes, one.axes))
    return list(found.values())


def _axes_for_both(one: Sequence[AxisTime], other: Sequence[AxisTime]) -> tuple[AxisTime, ...]:
    """The axes for two surfaces together, the quickest first; the second's where they have none in common."""
    seconds = {axis.axis: axis.seconds for axis in one}
    both = [AxisTime(axis.axis, axis.seconds + seconds[axis.axis]) for axis in other if axis.axis in seconds]
    return tuple(sorted(both, key=lambda axis: (axis.seconds, axis.axis))) or tuple(other)


def find_origin(face: Face, named: Mapping[str, WaitingSurface]) -> WaitingSurface:
    """Of which sub-surface that waited a face is one, or a piece: pieces have letters behind its name.

    Parameters
    ----------
    face : Face
    named : mapping of str to WaitingSurface
        By the labels of their faces.
    """
    label = face.label
    while label not in named:
        label = label[:-1]
    return named[label]
