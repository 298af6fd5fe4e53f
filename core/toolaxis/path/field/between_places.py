"""Whether strips are narrower between the places of a field's table than at these, so that more places are needed."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.width import strip_width
from toolaxis.path.field.direction_table import even_places
from toolaxis.path.field.level_chart import LevelChart
from toolaxis.path.parametrization import Cut

Array = NDArray[np.float64]

#: Levels of a field at each of which the narrowest place counts.
_LEVELS = 24


def hidden_passes(chart: LevelChart, cut: Cut, count: int) -> float:
    """How many more passes a field takes, as a share, for narrow places halfway between those of its table.

    Parameters
    ----------
    chart : LevelChart
    cut : Cut
    count : int
        Places of the table each way.
    """
    uv = even_places(chart.face, 2 * count - 1)
    known = np.zeros((2 * count - 1, 2 * count - 1), dtype=bool)
    known[::2, ::2] = True
    inside = chart.face.contains(uv)
    uv, known = uv[inside], known.ravel()[inside]
    if not known.any():
        return 0.0
    halves = strip_width(chart.face, cut.tool, uv, cut.axis, cut.scallop, chart.feed_at(uv), cut.allowance)
    width = np.minimum(halves.sum(axis=1), cut.greatest_step_over)
    across = np.maximum(width * chart.gradient(uv), np.finfo(float).tiny)
    step = chart.field.at(uv).value
    low, high = step.min(), step.max()
    level = np.minimum((_LEVELS * (step - low) / max(high - low, np.finfo(float).tiny)).astype(int), _LEVELS - 1)
    greatest = np.zeros((2, _LEVELS))
    np.maximum.at(greatest[0], level[known], 1 / across[known])
    np.maximum.at(greatest[1], level, 1 / across)
    return float(greatest[1].sum() / greatest[0].sum() - 1)
