"""How passes lie on a face: along its own parameters, or along parallel planes that contain the tool axis."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.machine.work_coordinates import mean_feed_across
from toolaxis.path.parametrization import IsoChart
from toolaxis.path.planes import PlaneChart
from toolaxis.plan.choices import ISO
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Charts of the passes that a plan can ask for.
PassChart: TypeAlias = IsoChart | PlaneChart

#: Places each way whose feed directions make up the mean one.
_GRID = 16


def chart_of(face: Face, axis: Array, feed: str, passes: str = ISO) -> PassChart:
    """The chart by which passes are laid on a face.

    Parameters
    ----------
    face : Face
    axis : (3,) array
        Tool axis, from tip to spindle.
    feed : "u" or "v"
        The parameter that varies along the passes; of planes their line: the mean direction of that parameter.
    passes : str
        One of `toolaxis.plan.choices.PASSES`.

    Raises
    ------
    UnsupportedGeometry
        When planes do not go with the face: it is not seen along the axis everywhere.
    """
    if passes == ISO:
        return IsoChart(face, feed)
    return PlaneChart(face, axis, mean_feed_across(axis, feeds_over(face, feed)))


def feeds_over(face: Face, feed: str) -> Array:
    """Feed directions over a face, (n, 3), not of unit length.

    Parameters
    ----------
    face : Face
    feed : "u" or "v"
    """
    d = face.evaluate(face.grid(_GRID, _GRID))
    return np.asarray(d.su if feed == "u" else d.sv)
