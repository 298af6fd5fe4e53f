"""What is planned: sub-surfaces, found or given by hand, each with what is known of its axis."""

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import Cancelled, Fault, InvalidInput, ToolAxisError, fault
from toolaxis.job.planning.edit_axis import evaluate_given_axis
from toolaxis.job.planning.failures import fail_face
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.sub_surface import SubSurface, division_from
from toolaxis.plan.zone import Zone
from toolaxis.regions.divide_by_reach import ReachDivision
from toolaxis.search.face_problem import FaceProblem
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import letters, split_at_kinks
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool
from toolaxis.work import is_out_of_work

Array = NDArray[np.float64]

#: How reasons begin that tell what was given by hand, and why an axis that was given does not serve.
LOCKED, REFUSED_LOCK, REFUSED_HINT = "locked by hand: ", "locked axis refused: ", "axis kept so far refused: "
#: Share of a face that may lie in two sub-surfaces, or of a sub-surface outside its face, by how finely it is looked.
_SLACK, _GRID = 0.01, 48
#: A face of more facets, each smaller on the mean than the square of the cutter's radius, is not machined.
_FACETS = 16


class Target(NamedTuple):
    """A sub-surface, the axis that its division or the choice of its tool reckoned with, if any, whether it shares that
    with others, the axes that others have, what of it was given by hand, what became of it where its division failed or
    was refused, whether it is divided by reach before an axis is looked for that reaches all of it, and whether it is
    planned whole however long that takes."""

    face: Face
    axis: Array | None = None
    shared: bool = False
    others: tuple[Array, ...] = ()
    given: SubSurface | None = None
    ended: Operation | None = None
    in_pieces: bool = False
    however_long: bool = False


def by_axis(targets: list[Target]) -> list[Target]:
    """Sub-surfaces in an order in which each axis is set once: that of the first one with each axis.

    Parameters
    ----------
    targets : list of Target
        Each with an axis.
    """
    names = [(np.round(np.asarray(target.axis), 9) + 0.0).tobytes() for target in targets]
    return [targets[k] for k in sorted(range(len(targets)), key=lambda k: names.index(names[k]))]


def by_reach(face: Face, whole: Operation, division: ReachDivision, others: tuple[Array, ...] = ()) -> list[Target]:
    """Sub-surfaces of a face, each with an axis that reaches it, and what none reaches, which has ended.

    Parameters
    ----------
    face : Face
    whole : Operation
        Of the face as a whole, without an axis.
    division : ReachDivision
        With a sub-surface at least.
    others : tuple of (3,) arrays
        Axes that others have.
    """
    targets = [Target(face.trimmed(piece.loops, face.label + letters(k)), piece.axis, others=others)
               for k, piece in enumerate(division.pieces)]
    if division.rest:
        every = tuple(loop for loops in division.rest for loop in loops)
        part = face.trimmed(every, face.label + letters(len(targets)))
        pieces = f" in {len(division.rest)} places" if len(division.rest) > 1 else ""
        words = (f"none of the {division.tried} axes tried reaches enough of {part.area:.1f} mm2{pieces} of face "
                 f"{face.label} for a sub-surface of its own")
        none = Orientation(None, outcome="not_found", reasons=(words, *whole.orientation.reasons))
        targets.append(Target(part, ended=Operation(1, part, whole.tool, none)))
    return targets


def made_of(target: Target, operations: Iterable[Operation]) -> Operation | None:
    """What was made of a target; None where it has not been planned.

    Parameters
    ----------
    target : Target
    operations : iterable of Operation
    """
    return next((op for op in operations if op.face is target.face), None)


def shrink_refused(targets: Sequence[Target], operations: Sequence[Operation], whole: Operation,
                   division: ReachDivision) -> list[Target]:
    """Sub-surfaces of a face with those smaller for which no axis was found, and the rest larger by that.

    Parameters
    ----------
    targets : sequence of Target
        From `by_reach`.
    operations : sequence of Operation
        What was made of them.
    whole : Operation
        Of the face as a whole, without an axis.
    division : ReachDivision

    Returns
    -------
    list of Target
        What can not be made smaller, or needs not, stands in it as it was.
    """
    refused = []
    for k, piece in enumerate(division.pieces):
        op = made_of(targets[k], operations)
        if op is None or op.done or op.failed or not piece.smaller:
            continue
        if not is_out_of_work(op.orientation.reasons):  # a smaller one takes as much work
            refused.append(k)
    if not refused:
        return list(targets)
    anew = by_reach(whole.face, whole, division.shrink(refused), targets[0].others)
    return [anew[k] if k in refused or k >= len(division.pieces) else targets[k] for k in range(len(anew))]


def read_division(path: str | Path) -> tuple[SubSurface, ...]:
    """The division in a file.

    Parameters
    ----------
    path : str or Path
        A JSON file as `toolaxis.plan.sub_surface.division_document` writes it, a plan.json, or the folder of one.

    Raises
    ------
    InvalidInput
        When it cannot be read, or is neither.
    """
    file = Path(path)
    file = file / "plan.json" if file.is_dir() else file
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as reason:
        raise InvalidInput(f"the division {path} cannot be read: {reason}") from reason
    return division_from(document)


def targets_of_given(part: Part, division: Sequence[SubSurface], numbers: Iterable[int],
                     tool: Tool) -> dict[int, list[Target]]:
    """Targets for the faces whose division is given, by the faces' numbers.

    Parameters
    ----------
    part : Part
    division : sequence of SubSurface
        Those of other faces are left aside.
    numbers : iterable of int
        The faces that are planned.
    tool : Tool

    Raises
    ------
    InvalidInput
        When a border leaves its face, or sub-surfaces of a face overlap.
    """
    wanted = set(numbers)
    chosen = sorted((one for one in division if one.face in wanted), key=lambda one: one.face)
    found: dict[int, list[Target]] = {}
    for number, group in groupby(chosen, key=lambda one: one.face):
        rows = list(group)
        whole = part.face(number)
        try:
            named = [(one, _piece(whole, one, k, len(rows))) for k, one in enumerate(rows)]
            _check_apart(whole, [piece for _, piece in named])
            found[number] = [Target(smooth, one.axis, given=one) for one, piece in named
                             for smooth in split_at_kinks(piece)]
        except ToolAxisError:
            raise
        except Exception as reason:
            found[number] = [lost_face(whole, tool, fault(reason))]
    return found


def lost_face(face: Face, tool: Tool, why: Fault) -> Target:
    """A face on which the program failed before an axis was looked for.

    Parameters
    ----------
    face : Face
    tool : Tool
    why : Fault
    """
    return Target(face, ended=fail_face(1, face, tool, why))


def why_faceted(face: Face, tool: Tool) -> str:
    """Why a face is left to clean-up: kinks cut it into facets, too many and too small for axes; empty where not.

    Parameters
    ----------
    face : Face
    tool : Tool
    """
    count = len(split_at_kinks(face))
    if count <= _FACETS or face.area > count * tool.radius**2:
        return ""
    return (f"face {face.number} is left entirely as rest material: kinks cut its {face.area:.1f} mm2 into {count} "
            "facets that are too small for axes of their own; make it smooth in CAD to have it machined")


def smooth_pieces(faces: Iterable[Face], tool: Tool) -> list[Target]:
    """Faces divided where they have kinks; those that are left to clean-up for too many of them have ended.

    Parameters
    ----------
    faces : iterable of Face
    tool : Tool
    """
    found: list[Target] = []
    for face in faces:
        try:
            why = why_faceted(face, tool)
            found += [_leave_whole(face, tool, why)] if why else map(Target, split_at_kinks(face))
        except Cancelled:
            raise
        except Exception as reason:
            found.append(lost_face(face, tool, fault(reason)))
    return found


def _leave_whole(face: Face, tool: Tool, why: str) -> Target:
    """A face that is left to clean-up before an axis was looked for."""
    none = Orientation(None, outcome="not_found", reasons=(why,))
    return Target(face, ended=Operation(1, face, tool, none, zones=(Zone(face.outline, face.area),)))


def not_divided(part: Part, division: Sequence[SubSurface]) -> tuple[str, ...]:
    """Warnings about faces that their given sub-surfaces do not cover.

    Parameters
    ----------
    part : Part
    division : sequence of SubSurface
    """
    notes = []
    for number, group in groupby(sorted(division, key=lambda one: one.face), key=lambda one: one.face):
        whole, rows = part.face(number), list(group)
        if all(one.region for one in rows):
            left = 1 - sum(whole.trimmed(one.region).area for one in rows) / whole.area
            if left > _SLACK:
                notes.append(f"{100 * left:.1f} % of face {number} lies in none of the sub-surfaces that are given: "
                             "it is not machined")
    return tuple(notes)


def _piece(whole: Face, one: SubSurface, k: int, count: int) -> Face:
    """A sub-surface as a face; its border on the face's."""
    label = one.label or (str(whole.number) + letters(k) if count > 1 else str(whole.number))
    if not one.region:
        return whole.trimmed(whole.trims, label)
    piece = whole.trimmed(one.region, label)
    (u0, u1), (v0, v1) = whole.surface.domain
    slack = 1e-9 * np.array([u1 - u0, v1 - v0])
    low, high = np.array([u0, v0]) - slack, np.array([u1, v1]) + slack
    uv = piece.grid(_GRID, _GRID)
    off = any(((loop < low) | (loop > high)).any() for loop in piece.trims)
    if off or (len(uv) and not whole.contains(uv).mean() >= 1 - _SLACK):
        raise InvalidInput(f"sub-surface {label} leaves face {whole.number}: draw its border on the face")
    return piece


def _check_apart(whole: Face, pieces: Sequence[Face]) -> None:
    uv = whole.grid(_GRID, _GRID)
    held = np.array([piece.contains(uv) for piece in pieces])
    if len(uv) and (held.sum(axis=0) > 1).mean() > _SLACK + 2 * len(pieces) / _GRID**2:
        pairs = held.astype(int) @ held.T.astype(int)
        np.fill_diagonal(pairs, 0)
        i, j = map(int, np.unravel_index(int(pairs.argmax()), pairs.shape))
        raise InvalidInput(f"sub-surfaces {pieces[i].label} and {pieces[j].label} overlap: let each place of face "
                           f"{whole.number} lie in one of them")


def with_given(targets: Sequence[Target], given: dict[int, list[Target]], order: Sequence[int]) -> list[Target]:
    """All targets in the order of the faces.

    Parameters
    ----------
    targets : sequence of Target
        Of the faces whose division is not given, in their order.
    given : dict of int to list of Target
    order : sequence of int
        Numbers of all faces.
    """
    place = {number: k for k, number in reversed(list(enumerate(order)))}
    every = [*targets, *(one for number in given for one in given[number])]
    return sorted(every, key=lambda one: place.get(one.face.number, len(place))) if given else list(targets)


def plan_locked(task: FaceProblem, given: SubSurface, search: Callable[[FaceProblem],
                                                                       tuple[Orientation, ToolPath | None]],
                ) -> tuple[Orientation, ToolPath | None]:
    """The orientation of a sub-surface of which axis or feed are given, and the passes that were proven.

    Parameters
    ----------
    task : FaceProblem
    given : SubSurface
    search : callable
        What searches an axis where none is given, or the one that is given may not be used and is not locked.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    feed = given.feed or None
    notes = (f"{LOCKED}feed {feed}",) if feed else ()
    bound = task if feed is None else replace(task, worth=replace(task.worth, feed=feed))
    if given.axis is not None:
        found, path = evaluate_given_axis(bound, given.axis, feed)
        if given.locked:
            words = f"{LOCKED}axis" + (f" and feed {feed}" if feed else "")
            refused = tuple(f"{REFUSED_LOCK}{one}" for one in found.reasons)
            return replace(found, reasons=(words, *found.reasons) if path is not None else refused), path
        if path is not None:
            return replace(found, reasons=(*notes, *found.reasons)), path
        notes = (*notes, *(f"{REFUSED_HINT}{one}" for one in found.reasons))
    found, path = search(bound)
    return replace(found, reasons=(*notes, *found.reasons)), path


def held_in(division: Sequence[SubSurface]) -> str:
    """Which axis or feed a division keeps, as a clause; empty where it keeps none.

    Parameters
    ----------
    division : sequence of SubSurface
    """
    held = next((one for one in division if one.held and (one.locked or one.feed)), None)
    return "" if held is None else f"a sub-surface of face {held.face} has a lock"
