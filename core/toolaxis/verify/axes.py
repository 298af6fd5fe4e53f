"""Room around the tool: the least distance of each of its components from faces, along all motions."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric import compiled as _compiled
from toolaxis.numeric.compiled import compiled
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.verify.axes_numpy import clear_numpy
from toolaxis.verify.blocks import balls, curve_order, in_chunks
from toolaxis.verify.cells import Cells, face_cells, split
from toolaxis.verify.motions import Motions, grouped, motions_from_cl
from toolaxis.verify.solids import meridian, reach_of
from toolaxis.verify.sweep import LOOK, least_over_motion, moment

Array = NDArray[np.float64]
Index: TypeAlias = NDArray[np.int64]
Body: TypeAlias = tuple[Array, tuple[Array, Array, Array, Array]]
TakenOff: TypeAlias = Callable[[Index, Array], Array]

#: Side of the cells at the start, mm; error at which the search ends, mm, or as a share of the distance.
CELL, RESOLUTION, SHARE = 3.0, 5e-4, 1e-3

#: Once cells are smaller than FINE, mm, only so many are split again, the closest first; most rounds.
FINE, _BEAM, _ROUNDS = 0.5, 4_000, 12

#: Distances above this are not measured, mm.
FAR = 100.0

#: More than this many times what is enough need only be known to this share of itself.
AMPLE, AMPLE_SHARE = 5.0, 0.05


@dataclass(frozen=True)
class Clearance:
    """The least distance found.

    Attributes
    ----------
    component : str
        "cutter", "shank" or "holder".
    distance : float
        mm; negative where the component is inside the material; `FAR` where nothing is nearer.
    face : str
        Label of the face; empty where nothing is near.
    point : (float, float, float)
        The place on the face, mm.
    motion : int
        Index of the cutter location at which the motion arrives; -1 where nothing is near.
    uncertainty : float
        Error by the spacing of the points looked at last, and by turning motions, mm.
    """

    component: str
    distance: float
    face: str
    point: tuple[float, float, float]
    motion: int
    uncertainty: float


@compiled
def _clear_block(body: Body, tables: tuple[Array, Index, Array], block: tuple[Array, int, int],
                 out: tuple[Array, Index, Array], limit: float) -> None:
    """Distances of one block of points from all motions; those above the limit stay as they are."""
    solids, motion = body
    groups, first, slack = tables
    ball, low, high = block
    value, by, point = out
    bound = np.empty(groups.shape[0])
    for g in range(groups.shape[0]):
        w0, w1, w2 = ball[0] - groups[g, 0], ball[1] - groups[g, 1], ball[2] - groups[g, 2]
        z = w0 * groups[g, 4] + w1 * groups[g, 5] + w2 * groups[g, 6]
        rho = np.sqrt(max(w0 * w0 + w1 * w1 + w2 * w2 - z * z, 0.0))
        nearest = np.inf
        for j in range(solids.shape[0]):
            nearest = min(nearest, meridian(solids[j], rho, z)[0])
        bound[g] = nearest - groups[g, 3] - groups[g, 7] - ball[3]
    for g in np.argsort(bound):
        lever = -np.inf
        for i in range(low, high):
            lever = max(lever, value[i])
        lever = min(lever, limit)
        if bound[g] > lever:
            break
        for k in range(first[g], first[g + 1]):
            for j in range(solids.shape[0]):
                middle, _, _ = moment(solids[j], motion, (k, 0.5), (ball[0], ball[1], ball[2], 0.0, 0.0, 0.0), 0.0)
                if middle - slack[k] - ball[3] <= lever:
                    for i in range(low, high):
                        _approach((solids[j], motion), k, point, (value, by), i)


@compiled
def _approach(body: Body, k: int, point: Array, out: tuple[Array, Index], i: int) -> None:
    solid, motion = body
    value, by = out
    ray = (point[i, 0], point[i, 1], point[i, 2], 0.0, 0.0, 0.0)
    middle, slope, _ = moment(solid, motion, (k, 0.5), ray, 0.0)
    if middle - 0.5 * abs(slope) - LOOK < value[i]:
        least, _, _, _ = least_over_motion(solid, motion, k, ray, 0.0)
        if least < value[i]:
            value[i] = least
            by[i] = k


@compiled
def _clear(body: Body, tables: tuple[Array, Index, Array], blocks: tuple[Array, Index],
           out: tuple[Array, Index, Array, NDArray[np.bool_]], levels: tuple[float, float, int, int]) -> None:
    """Distances of the points of blocks levels[2] up to levels[3], true where within a margin of the least so far."""
    ball, first = blocks
    value, by, point, counts = out
    best, margin, low, high = levels
    for b in range(low, high):
        _clear_block(body, tables, (ball[b], first[b], first[b + 1]), (value, by, point), best + margin)
        for i in range(first[b], first[b + 1]):
            if counts[i] and value[i] < best:
                best = value[i]


class _Search:
    """Distances of points from one component along the motions."""

    def __init__(self, solids: Array, motions: Motions, workers: tuple[int, Callable[[float, float], None]],
                 taken_off: TakenOff | None = None) -> None:
        self.solids, self.motions, self.workers, self.taken_off = solids, motions, workers, taken_off
        reach = reach_of(solids)
        lean = np.linalg.norm(motions.axis + 0.5 * motions.turn, axis=1)
        slack = 0.5 * np.linalg.norm(motions.step, axis=1) + 0.5 * np.linalg.norm(motions.turn, axis=1) / lean * reach
        groups, first = grouped(motions)
        groups[:, 7] *= reach
        self.tables = (groups, first, slack)

    def distances(self, cells: Cells, best: float, margin: float) -> tuple[Array, Index]:
        """Distance of each cell's centre, true where it is within the margin of the least, and the motion's index."""
        order = curve_order(cells.point)
        point = np.ascontiguousarray(cells.point[order])
        value, by = np.full(len(order), FAR), np.full(len(order), -1, dtype=np.int64)
        motion = (self.motions.start, self.motions.step, self.motions.axis, self.motions.turn)
        off = np.zeros(len(order)) if self.taken_off is None else self.taken_off(cells.owner[order], point)
        # A place at a step must not end the search for places beside it, which is farther than its distance tells.
        out = (value, by, point, np.ascontiguousarray(cells.on_face[order] & (off == 0.0)))
        kernel = _clear if _compiled.available else clear_numpy
        blocks = balls(point)

        def work(part: tuple[int, int]) -> None:
            kernel((self.solids, motion), self.tables, blocks, out, (best, margin, *part))

        in_chunks(work, len(blocks[0]), *self.workers)
        value = np.maximum(value, np.minimum(value + off, 0.0))
        result, which = np.empty_like(value), np.empty_like(by)
        result[order], which[order] = value, by
        return result, which


def clearance(cl: tuple[ArrayLike, ArrayLike, ArrayLike], component: tuple[str, Array], faces: tuple[Face, ...], *,
              enough: float = np.inf, taken_off: TakenOff | None = None, threads: int = 1,
              progress: Progress = NO_PROGRESS) -> Clearance:
    """Least distance of one component of the tool from faces along cutter location data, links included.

    Points all over the faces and their borders are measured against the swept solids, more densely around the nearest.
     At a distance d, points of spacing e miss the nearest place of a smooth face by about
    e^2 / d, of any face by e; the search ends where the lesser of both is `RESOLUTION`, or `SHARE` of d.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        As for `removal`.
    component : (str, (k, 7) array)
        Name, and its solids as `solids.cutter_solid` and `solids.frustum_solids` give them.
    faces : tuple of Face
    enough : float
        Distance that is asked for, mm: where the tool stays `AMPLE` times as far away, the search ends early.
    taken_off : callable, optional
        What faces miss each other by at points (n, 3) of those with some indices (n,), mm: depths are less by that.
    threads : int
        Threads of the compiled kernel; the result does not depend on it.
    progress : Progress

    Raises
    ------
    InvalidInput
        When there is no cutter location, a number is not finite, or shapes do not fit.

    Properties
    ----------
    1. A component that enters a face by 0.005 mm on one motion is found.
    2. Rigid motions and mirrors change nothing.
    """
    name, solids = component
    motions = motions_from_cl(*cl, reach_of(solids))
    nothing = Clearance(name, FAR, "", (0.0, 0.0, 0.0), -1, motions.uncertainty)
    if not faces:
        return nothing
    search = _Search(solids, motions, (threads, partial(progress.report, f"{name} clearance")), taken_off)
    cells = face_cells(faces, CELL)
    best, found, error = FAR, None, 0.0
    few = cells.rows(np.arange(0, len(cells), 16))
    value, _ = search.distances(few, best, 0.0)
    best = float(value[few.on_face].min(initial=FAR))
    for _ in range(_ROUNDS):
        margin = float(cells.radius.max())
        value, by = search.distances(cells, best, margin)
        here = np.where(cells.on_face, value, np.inf)
        i = int(np.argmin(here))
        if here[i] < best or (found is None and here[i] <= best and by[i] >= 0):
            best = float(here[i])
            found = (int(cells.owner[i]), cells.point[i], int(motions.arrival[by[i]]))
        near = np.flatnonzero((value - cells.radius <= best) & (by >= 0))
        radius = float(cells.radius[near].max(initial=0.0))
        error = min(radius, radius**2 / max(best, RESOLUTION))
        ample = AMPLE_SHARE if best - error > AMPLE * enough else SHARE
        if not len(near) or error <= max(RESOLUTION, ample * best):
            break
        if radius < FINE:
            near = near[np.argsort(value[near], kind="stable")[:_BEAM]]
        cells = split(faces, cells.rows(np.sort(near)))
    if found is None:
        return nothing
    x, y, z = (float(c) for c in found[1])
    return Clearance(name, best, faces[found[0]].label, (x, y, z), found[2], motions.uncertainty + error)
