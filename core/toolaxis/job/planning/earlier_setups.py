"""What plans of earlier setups left of a part: all that a plan of the next one is to machine."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.polygon_boolean import divide_nearly, unite_polygons, without
from toolaxis.numeric.polygons import signed_area
from toolaxis.plan.face_share import FaceShare
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.skin.join import join
from toolaxis.strategies.strategy import Strategy

Loops = tuple[NDArray[np.float64], ...]

#: Area up to which what is left of a face is not worth a sub-surface, mm^2.
_LEAST = 0.01
#: Share of the area inside a face's borders, in its parameters, up to which a loop encloses nothing.
_NOTHING = 1e-9
#: Share of a face up to which areas are the same.
_SHARE = 1e-3
#: How far boxes and areas of faces may differ of parts that are the same one, in parts of the diagonal and the area.
_SAME = 1e-6


def check_after(strategy: Strategy, *, named: bool = False, divided: bool = False) -> None:
    """Check that a plan for a later setup asks for nothing but what earlier plans left.

    Parameters
    ----------
    strategy : Strategy
    named : bool
        Whether faces are named.
    divided : bool
        Whether sub-surfaces are given by hand.

    Raises
    ------
    InvalidInput
        When it asks for something else too.
    """
    if named:
        raise InvalidInput("faces are named, and earlier setups too: leave one of both out")
    if divided:
        raise InvalidInput("sub-surfaces given by hand do not go with earlier setups: leave one of both out")
    if strategy.in_layers:
        raise InvalidInput(f"strategy {strategy.name!r} does not go with earlier setups, which leave pieces of "
                           "faces: take another one")


def join_as_before(part: Part, earlier: Sequence[Plan]) -> tuple[Part, tuple[int, ...]]:
    """A part with the faces joined that the last plan of an earlier setup joined, and the numbers of its faces.

    Parameters
    ----------
    part : Part
        With all its faces, none joined.
    earlier : sequence of Plan
        Of earlier setups, the first one first.

    Returns
    -------
    part : Part
    numbers : tuple of int
        Of the faces and skins that the plan was asked for, those that were not begun when it was stopped among them.

    Raises
    ------
    InvalidInput
        When a plan is one of another part.
    """
    for number, plan in enumerate(earlier, 1):
        _check_same_part(part, plan, number)
    last = earlier[-1]
    asked = {op.face.number for op in last.operations}
    for rows in (last.held, last.unplanned, last.machined_before):
        asked |= {one.face for one in rows}
    for face in last.part.faces:
        if face.members:
            part = join(part, face.numbers, np.inf, np.inf)
    # A face that a skin hides is told of by its own number.
    numbers = sorted(face.number for face in part.faces if asked & set(face.numbers))
    return part, tuple(numbers)


def _check_same_part(part: Part, plan: Plan, number: int) -> None:
    """Refuse a plan of another part."""
    own, its = part.faces, (plan.part.original or plan.part).faces
    same = len(own) == len(its) and all(_is_same_face(one, other, _SAME * part.diagonal)
                                        for one, other in zip(own, its, strict=True))
    if not same:
        raise InvalidInput(f"the plan of setup {number} is one of another part: plan all setups of one part")


def _is_same_face(one: Face, other: Face, most: float) -> bool:
    """Whether faces of two parts have the same number, the same box to so many mm, and the same area."""
    if one.number != other.number or np.abs(one.box - other.box).max() > most:
        return False
    return abs(one.area - other.area) <= _SAME * one.area


def leave_out_machined(faces: Sequence[Face], earlier: Sequence[Plan],
                       ) -> tuple[tuple[Face, ...], tuple[FaceShare, ...]]:
    """What of faces no plan of an earlier setup machines, and what these machine: all and nothing without any.

    Parameters
    ----------
    faces : sequence of Face
        Of the part, skins as one face each.
    earlier : sequence of Plan
        Of earlier setups, the first one first.

    Raises
    ------
    InvalidInput
        When nothing is left of any face.

    Notes
    -----
    An operation machines its sub-surface without the zones that it leaves.  What operations machine on faces that were
    joined otherwise is not taken off: it is asked for once more.

    **Properties**: 1. what is left and what is machined add up to the faces.
    """
    if not earlier:
        return tuple(faces), ()
    left, before = [], []
    for face in faces:
        done = [op for plan in earlier for op in plan.operations if op.done and op.face.numbers == face.numbers]
        rest = _rest_of(face, done)
        if rest is not None and rest.area >= _LEAST:
            left.append(rest if done else face)
        if done:
            before.append(FaceShare.besides(face, rest))
    if not left:
        raise InvalidInput("earlier setups machine all that is asked for: nothing is left to plan")
    return tuple(left), tuple(before)


def _rest_of(face: Face, done: Sequence[Operation]) -> Face | None:
    """What operations leave of a face; None where that is nothing."""
    loops = face.outline
    expected = face.area
    for op in done:
        # Sub-surfaces and zones were cut out of the face: they have its very corners, and edges cancel out.
        loops = unite_polygons(without(loops, op.face.outline), _zones_of(op))
        expected -= op.face.area - sum(zone.area for zone in op.zones if zone.at_wall)
    rest = _trim_to(face, loops)
    found = 0.0 if rest is None else rest.area
    if abs(found - expected) <= max(_SHARE * face.area, _LEAST):
        return rest
    loops = face.outline  # sub-surfaces overlap, as those given by hand may a little
    for op in done:
        loops = _take_off(loops, op)
    return _trim_to(face, loops)


def _trim_to(face: Face, loops: Loops) -> Face | None:
    """What of a face lies inside loops; None where that is nothing.

    Corners on the edge of another loop lie beside it by rounding: what is between is no piece of the face.
    """
    least = _NOTHING * sum(abs(signed_area(loop)) for loop in face.outline)
    kept = tuple(loop for loop in loops if abs(signed_area(loop)) > least)
    return face.trimmed(kept) if kept else None


def _zones_of(op: Operation) -> Loops:
    """Borders of what an operation leaves of its sub-surface."""
    return tuple(loop for zone in op.zones if zone.at_wall for loop in zone.loops)


def _take_off(loops: Loops, op: Operation) -> Loops:
    """What is left inside loops by an operation: all outside of its sub-surface, and the zones that it leaves."""
    zones = _zones_of(op)
    try:
        _, outside = divide_nearly(loops, op.face.outline)
        inside = divide_nearly(loops, zones)[0] if zones else ()
    except InvalidInput:  # borders cannot be told apart: it is asked for once more
        return loops
    return (*outside, *inside)
