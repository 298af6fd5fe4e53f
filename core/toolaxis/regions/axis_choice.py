"""Which axes the surfaces of a part share that one tool machines: least cutting time and index moves together."""

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from toolaxis.regions.cells import FaceCells
from toolaxis.regions.prices import widths
from toolaxis.regions.reach_screen import ReachScreen
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.searched_scene import tighten_scene
from toolaxis.regions.tool_choice import AxisTime
from toolaxis.search.face_problem import FaceProblem
from toolaxis.shape.measure import mean_width

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: What a step has to save, s, and the time that stands for an axis that does not serve, s.
_LEAST_SAVED, _NEVER = 1e-6, 1e9
#: Size of cells in radii of the cutter and in mean widths of the face at most, and how many of them about.
_SIZE, _ACROSS, _CELLS = 0.4, 1 / 3, 200
#: Share of what its own axis reaches of a surface that another may miss.
_MISSED = 0.01


def reckon_axes(job: FaceProblem, scene: ReachScene, axes: Array, own: int, rate: float,
                move: float) -> tuple[AxisTime, ...]:
    """The axes that reach all that one of them reaches of a surface, and take less than an index move longer.

    Parameters
    ----------
    job : FaceProblem
        Of the surface.
    scene : ReachScene
        Of the part that it belongs to.
    axes : (k, 3) array
        Unit vectors.
    own : int
        Number of the axis that is known to reach it.
    rate : float
        Feed rate, mm/s.
    move : float
        Time of an index move, s.

    Returns
    -------
    tuple of AxisTime
        The quickest first; that one alone where the screening does not see what it reaches.
    """
    worth = job.worth
    face = worth.face
    tool = worth.tool
    size = min(_SIZE * tool.radius, _ACROSS * mean_width(face))
    least_size = (face.area / _CELLS) ** 0.5
    cells = FaceCells.sized(face, max(size, least_size))
    strip = widths(cells, [tool], axes, worth.scallop, worth.allowance, worth.greatest_step_over)[0]
    screen = ReachScreen(cells, tighten_scene(job, scene))
    is_reached = screen.screen([tool], axes, (strip > 0)[None])[0]
    area = is_reached @ cells.area
    if not area[own] > 0:
        return (AxisTime(own, 0.0),)
    length = cells.area / np.where(is_reached, strip, 1.0)
    lengths = np.where(is_reached, length, 0.0)
    seconds = lengths.sum(axis=1) / rate
    reaches_enough = area >= (1 - _MISSED) * area[own]
    is_quick = seconds <= seconds[own] + move
    good = np.flatnonzero(reaches_enough & is_quick)
    order = np.argsort(seconds[good], kind="stable")
    return tuple(AxisTime(int(k), float(seconds[k])) for k in good[order])


def choose_axes(options: Sequence[Sequence[AxisTime]], used: Collection[int], move: float) -> tuple[int, ...]:
    """The axis of each surface with which all take least time together.

    Parameters
    ----------
    options : sequence of sequence of AxisTime
        Of each surface, one at least.
    used : collection of int
        Axes that the tool is used under anyway: these cost no index move.
    move : float
        Time of an index move, s.

    Returns
    -------
    tuple of int

    Notes
    -----
    The facility location problem: axes are added, dropped and exchanged one by one as long as that saves time, the best
    such step each time.  On small cases that is the optimum nearly always; the difference is seconds.
    """
    if not options:
        return ()
    axes = sorted({one.axis for some in options for one in some})
    column = {axis: k for k, axis in enumerate(axes)}
    every = np.arange(len(axes))
    seconds = np.full((len(options), len(axes)), _NEVER)
    for row, some in enumerate(options):
        for one in some:
            seconds[row, column[one.axis]] = one.seconds
    price = np.array([0.0 if axis in used else move for axis in axes])
    cheapest = int((seconds.sum(axis=0) + price).argmin())
    quickest = np.isin(every, seconds.argmin(axis=1))
    tried = [_improve_choice(seconds, price, begin) for begin in (quickest, every == cheapest)]
    held = min(tried, key=lambda one: _cost(seconds, price, one))
    chosen = np.where(held, seconds, np.inf).argmin(axis=1)
    return tuple(axes[k] for k in chosen)


def _cost(seconds: Array, price: Array, held: Bools) -> float:
    """Time of all surfaces with the axes that are held, index moves included, s."""
    cutting = _least(seconds, held).sum()
    moves = price[held].sum()
    return float(cutting + moves)


def _improve_choice(seconds: Array, price: Array, held: Bools) -> Bools:
    """Axes that are held, (k,), better by single steps until none of these saves time."""
    while (step := _best_step(seconds, price, held)) is not None:
        changed = [axis for axis in step if axis is not None]
        held = held.copy()
        held[changed] ^= True
    return held


def _best_step(seconds: Array, price: Array, held: Bools) -> tuple[int | None, int | None] | None:
    """Which axis to drop and which to add, one of them or both, to save most time; None where no step saves any."""
    dropped = [int(axis) for axis in np.flatnonzero(held)]
    # Rows: no axis is dropped, or each of those that are held.
    rest = [held, *(_without(held, axis) for axis in dropped)]
    left = np.vstack([_least(seconds, one) for one in rest])
    unpaid = np.append(0.0, price[dropped])
    price_to_add = np.where(held, np.inf, price)
    # Columns: each axis is added, or none.
    cost = np.empty((len(left), len(held) + 1))
    for row, times in enumerate(left):
        with_one_more = np.minimum(times[:, None], seconds)
        cost[row, :-1] = with_one_more.sum(axis=0) + price_to_add
        cost[row, -1] = times.sum()
    cost -= unpaid[:, None]
    if cost.min() >= cost[0, -1] - _LEAST_SAVED:
        return None
    best, added = divmod(int(cost.argmin()), len(held) + 1)
    drop = dropped[best - 1] if best else None
    add = added if added < len(held) else None
    return drop, add


def _without(held: Bools, axis: int) -> Bools:
    """Axes that are held, one of them dropped."""
    others = np.arange(len(held)) != axis
    return np.asarray(held & others)


def _least(seconds: Array, held: Bools) -> Array:
    """The time of each surface with the quickest of the axes that are held, s."""
    return np.asarray(seconds[:, held].min(axis=1, initial=_NEVER))
