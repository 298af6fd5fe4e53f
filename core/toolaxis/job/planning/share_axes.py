"""Sub-surfaces of divided faces that get an axis which serves several of them: fewer index moves."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from toolaxis.job.planning.parallel import abreast
from toolaxis.job.planning.sub_surfaces import Target
from toolaxis.plan.plan import INDEX_SECONDS
from toolaxis.progress import Progress
from toolaxis.regions.axis_choice import choose_axes
from toolaxis.regions.tool_choice import AxisTime
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: From a face, axes (k, 3) and the number of its own, those that serve it too.
Reckon = Callable[[Face, Array, int, Progress], tuple[AxisTime, ...]]


def share_axes(targets: Sequence[Target], used: Sequence[Array], reckon: Reckon, workers: int,
               progress: Progress) -> tuple[list[Target], bool]:
    """Sub-surfaces with the axes with which all take least time together, index moves included.

    Parameters
    ----------
    targets : sequence of Target
        Each with the axis of its division.
    used : sequence of (3,) arrays
        Axes under which the tool machines something else.
    reckon : callable
        What axes serve a face, and in what time.
    workers : int
        Processes.
    progress : Progress

    Returns
    -------
    list of Target
        That axis first; where it is another one, that of the division is the first of the others.
    bool
        Whether the user stopped it: then they are as they were.
    """
    if not targets:
        return [], False
    every, numbers = np.unique(np.array([*used, *(target.axis for target in targets)]), axis=0, return_inverse=True)
    numbers = numbers.ravel()
    own = [int(k) for k in numbers[len(used):]]

    def _reckon(k: int, inner: Progress) -> tuple[AxisTime, ...]:
        inner.report("choice of axes", k, len(targets))
        return reckon(targets[k].face, every, own[k], inner)

    found = abreast(_reckon, len(targets), workers, progress)
    if found.cancelled:
        return list(targets), True
    # Where the program fails on one, it keeps its own.
    options = [found.results.get(k, (AxisTime(axis, 0.0),)) for k, axis in enumerate(own)]
    chosen = choose_axes(options, {int(k) for k in numbers[:len(used)]}, INDEX_SECONDS)
    return [_with_axis(target, every[k]) if k != before else target
            for target, k, before in zip(targets, chosen, own, strict=True)], False


def _with_axis(target: Target, axis: Array) -> Target:
    """A sub-surface with another axis to begin from, and its own behind that."""
    assert target.axis is not None
    return target._replace(axis=axis, others=(target.axis, *target.others))
