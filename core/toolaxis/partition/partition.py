"""Faces divided into sub-surfaces that fixed axes cut in the least length."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import LONGER_STICKOUT, SMALLER_TOOL
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import Obstacles
from toolaxis.machine.limits import AxisLimits
from toolaxis.partition.bosses import distances
from toolaxis.partition.face_division import INDEX_COST, MOST, Divider, Regions
from toolaxis.partition.ring_division import Distance, candidates, slivers
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.machine_limits import intersect_limits
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import ToleranceLike
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]


def partition(source: Face | Part, tool: Tool, scallop: float, count: int | str | None = None, *,
              machine: AxisLimits | str | None = None, obstacles: Obstacles = None, part: Part | None = None,
              faces: Sequence[int] | None = None, tolerance: ToleranceLike = None, allowance: float = 0.0,
              index_cost: float = INDEX_COST, progress: Progress = NO_PROGRESS) -> tuple[Face, ...]:
    """Divide faces into sub-surfaces so that fixed axes, one for each, cut them in the least length.

    Parameters
    ----------
    source : Face or Part
        A part's sculptured faces are divided one by one.
    tool : Tool
    scallop : float
        Scallop height, mm.
    count : int or "auto", optional
        Sub-surfaces for each face, at most 16; what pays for its index moves unless given.
    machine : AxisLimits or str, optional
        What the machine allows; see `toolaxis.machine.limits`.
    obstacles : Part, Face or sequence of Face, optional
        What the tool must keep away from besides the part.
    part : Part, optional
        The part that a single face belongs to, by its number.
    faces : sequence of int, optional
        Faces of a part instead of its sculptured ones.
    tolerance : float or Tolerance, optional
        The machining tolerance, mm, or all tolerances: 0.01 mm unless given.
    allowance : float
        Stock left on the faces, mm.
    index_cost : float
        What one more sub-surface costs, in mm of cutting length: its index move, retract and mark on the border.
    progress : Progress

    Returns
    -------
    tuple of Face
        Pieces of the faces with their own trims, in the order of the faces; `regions` tells more of a single face.

    Raises
    ------
    InvalidInput
        When an argument is out of range, or a face cannot be divided into so many sub-surfaces.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.1 takes the division as given; here it is the cheapest one by cuts along iso-parametric
    lines of a lattice, each piece with its cheapest axis and feed, from exact strip widths at the nodes.

    **Properties**: 1. the pieces are the face, without overlap; 2. more sub-surfaces never take more length.
    """
    whole, chosen = part, [source] if isinstance(source, Face) else []
    if isinstance(source, Part):
        whole, chosen = source, [source.face(number) for number in faces] if faces else list(source.sculptured)
        if not chosen:
            raise InvalidInput("the part has no sculptured face: name faces, planes and cylinders among them")
    pieces: list[Face] = []
    for face in chosen:
        job = task(face, tool, scallop, intersect_limits(machine, None), obstacles, part=whole, tolerance=tolerance,
                   allowance=allowance)
        standing = distances(face, job.worth.tool, whole, obstacles)
        pieces += regions(job, count, index_cost, progress.within(f"face {face.label}"), standing).faces
    return tuple(pieces)


def regions(job: FaceProblem, count: int | str | None = None, index_cost: float | None = None,
            progress: Progress = NO_PROGRESS, bosses: Sequence[Distance] = (),
            begin: Array | None = None) -> Regions:
    """Divide one face.

    Parameters
    ----------
    job : FaceProblem
        From `toolaxis.search.face_problem.task`; with the objective "time" the division goes by time, else by length.
    count, progress
        As for `partition`.
    index_cost : float, optional
        What one more sub-surface costs, mm or s; `Divider.index_cost` unless given.
    bosses : sequence of callable
        Distances to what stands on the face, from `toolaxis.partition.bosses.distances`: it is also divided around
        them, and the cheaper division is taken.
    begin : (k, 3) array, optional
        Axes to begin with, in place of axes all over the hemisphere; the first is known to machine the whole face.

    Raises
    ------
    InvalidInput
        When the face cannot be divided into so many sub-surfaces.
    Cancelled
        When the user asked to stop.
    """
    number = check_count(count)
    divider = Divider(job, most=MOST if number is None else number, progress=progress, begin=begin)
    known = divider.best.known
    label = job.worth.face.label
    if not len(known) and number in (None, 1):
        return Regions((job.worth.face,), np.zeros((0, 3)), (), (), np.zeros((0, 2)))
    around = [one for one in candidates(divider, bosses) if np.isfinite(one.curve).any()] if len(bosses) else []
    if number is None:
        least = np.min([divider.curve, *(one.curve for one in around)], axis=0)
        each = divider.index_cost if index_cost is None else index_cost
        number = int(np.argmin(least + each * np.arange(len(least))))
    for one in sorted(around, key=lambda one: float(one.curve[number])):
        if not one.curve[number] < divider.curve[number]:
            break
        near = one.closer(divider, number)
        found = near.regions(number)
        if near.curve[number] < divider.curve[number] and len(found) == number and not slivers(found, job.worth.tool):
            return found
    if number not in known:
        raise InvalidInput(f"face {label} cannot be divided into {number} sub-surfaces: {_why_not(divider, number)}")
    return divider.regions(number)


def _why_not(divider: Divider, number: int) -> str:
    known = divider.best.known
    if len(known) and number > known[-1]:
        return f"at most {known[-1]} are wider than the cutter"
    return "some places allow no axis that goes with their neighbours' one; ask for more, or take " \
           f"{SMALLER_TOOL}, {LONGER_STICKOUT} or fewer obstacles"


def check_count(count: int | str | None, what: str = "sub-surfaces") -> int | None:
    """A number of sub-surfaces or orientations, or None where the program is to choose.

    Parameters
    ----------
    count : int, "auto" or None
    what : str
        What is counted.

    Raises
    ------
    InvalidInput
        When it is neither, or out of range.
    """
    if count is None or count == "auto":
        return None
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or not 1 <= count <= MOST:
        raise InvalidInput(f"number of {what} is {count!r}: it must be a whole number from 1 to {MOST}, "
                           "or auto")
    return int(count)
