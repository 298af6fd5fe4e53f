"""Strip width and roughness over a face, the front of one against the other, and what rotary axes do along a pass."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from toolaxis.report.figures.plots import BLUE, GREY, ORANGE, VERMILION, figure

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RoughnessStudy:
    """What passes with a moving axis leave on a face; lengths in mm, Ra in um, velocities in deg/s.

    Attributes
    ----------
    place, width : (n, 2), (n,) array
        Places on the face in a plane before it, and section strip widths there.
    spot, roughness : (m, 2), (m,) array
        Places at which Ra was evaluated, and Ra.
    expected : (float, float)
        Range of the strip width.
    limit : float
        Greatest Ra allowed.
    velocities : dict of str to ((k,) array, (k, a) array)
        Ways along one pass and velocities of the rotary axes there, for each way to lean.
    axes : tuple of str
        Names of the rotary axes.
    """

    place: Array
    width: Array
    spot: Array
    roughness: Array
    expected: tuple[float, float]
    limit: float
    velocities: Mapping[str, tuple[Array, Array]]
    axes: tuple[str, ...]


def roughness_picture(study: RoughnessStudy, name: str) -> Figure:
    """Strip width and Ra over the face, and velocities of the rotary axes along a pass.

    Parameters
    ----------
    study : RoughnessStudy
    name : str
        Of the operation.
    """
    made = figure(15.0, 4.8)
    made.suptitle(f"{name}: Ra {study.roughness.mean():.3f} µm in the mean, {study.roughness.max():.3f} µm at most of "
                  f"{len(study.roughness)} places; section strip width {study.width.min():.3f} to "
                  f"{study.width.max():.3f} mm")
    _over(made, made.add_subplot(1, 3, 1), (study.place, study.width, 6.0), study.expected, "section strip width, mm")
    _over(made, made.add_subplot(1, 3, 2), (study.spot, study.roughness, 90.0), (0.0, study.limit),
          f"Ra across the feed, µm ({study.limit:g} allowed)")
    ax = made.add_subplot(1, 3, 3)
    for (title, (way, speeds)), dashes in zip(study.velocities.items(), ("-", "--", ":"), strict=False):
        for k, axis in enumerate(study.axes):
            ax.plot(way, speeds[:, k], dashes, color=(BLUE, ORANGE)[k % 2], label=f"{axis}, {title}", linewidth=1.4)
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.set(xlabel="way along the middle pass, mm", ylabel="velocity of the rotary axes, °/s")
    ax.legend(fontsize=8, frameon=False)
    return made


def _over(made: Figure, ax: Axes, rows: tuple[Array, Array, float], limits: tuple[float, float], title: str) -> None:
    place, value, size = rows
    dots = ax.scatter(place[:, 0], place[:, 1], c=value, s=size, cmap="viridis", vmin=limits[0], vmax=limits[1],
                      linewidths=0)
    over = value > limits[1]
    ax.scatter(place[over, 0], place[over, 1], s=1.6 * size, facecolors="none", edgecolors=VERMILION)
    made.colorbar(dots, ax=ax, shrink=0.85).set_label(title)
    ax.set_aspect("equal")
    ax.set(xlabel="mm", ylabel="mm")


def front_picture(rows: Sequence[tuple[str, float, float, float]], limit: float) -> Figure:
    """Mean Ra against the least strip width on the same passes, and the turning of the rotary axes against it.

    Parameters
    ----------
    rows : sequence of (title, least strip width mm, mean Ra um, sum of squared angular velocities (rad/s)^2)
        The first one for comparison, the others in growing strip width.
    limit : float
        Greatest Ra, um.
    """
    made = figure(10.0, 4.4)
    other, own = rows[0], rows[1:]
    for number, (column, label) in enumerate(((2, "mean Ra, µm"), (3, "sum of squared angular velocities, (rad/s)²"))):
        ax = made.add_subplot(1, 2, number + 1)
        ax.plot([row[1] for row in own], [row[column] for row in own], "o-", color=BLUE, label="least turning")
        ax.plot(other[1], other[column], "s", color=VERMILION, label=other[0])
        if column == 2:
            ax.axhline(limit, color=GREY, linewidth=1.0, linestyle="--")
        ax.set(xlabel="least section strip width, mm", ylabel=label)
        ax.legend(fontsize=8, frameon=False)
    return made
