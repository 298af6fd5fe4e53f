"""The hemisphere of axes as an equal-area map: strip width in colour, forbidden axes in grey by reason."""

from collections.abc import Mapping
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.equal_area import equal_area, from_equal_area
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.plan.orientation import REASONS, AxisMap
from toolaxis.report.figures.plots import VERMILION, figure

Array = NDArray[np.float64]

_SIZE = 420
_GREYS = ("#ffffff", "#f4f4f4", "#e3e3e3", "#cfcfcf", "#b5b5b5", "#8f8f8f", "#6e6e6e", "#4c4c4c")
#: Marker and colour of each named axis; what is not listed here is drawn as a small triangle.
_MARKS = {"chosen": ("*", VERMILION, 15.0), "sectors [zhu2016]": ("P", "#CC79A7", 9.5),
          "Roman's rule": ("X", "#56B4E9", 9.5), "mean normal": ("+", "black", 10.0),
          "other lobes": ("D", "white", 6.5)}


def _directions(pole: Array, right: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Unit vectors of the pixels of the disc, (size * size, 3), and which pixels lie on it."""
    line = (np.arange(_SIZE) + 0.5) / _SIZE * 2.0 - 1.0
    x, y = np.meshgrid(line, line)
    flat = np.stack([x.reshape(-1), y.reshape(-1)], axis=1)
    on_disc = (flat**2).sum(axis=1) <= 1.0
    return from_equal_area(flat, pole, right), on_disc


def hemisphere_picture(found: AxisMap, area: float, pole: ArrayLike, marks: Mapping[str, ArrayLike],
                       name: str) -> Figure:
    """All axes that were looked at, each standing for the directions nearest to it.

    Parameters
    ----------
    found : AxisMap
    area : float
        Area of the face, mm^2: strip width is area over cutting length.
    pole : (3,) array_like
        Mean normal; the map's centre.
    marks : mapping of str to (3,) or (n, 3) array_like
        Axes to mark: "chosen", "sectors [zhu2016]", "Roman's rule", "mean normal", "other lobes".
    name : str
    """
    from scipy.spatial import cKDTree

    centre = unit(pole)
    right = perpendicular(centre)[0]
    rows, on_disc = _directions(centre, right)
    _, nearest = cKDTree(found.axis).query(rows)
    free = found.reason == 0
    is_cut = free & (found.length > 0)
    width = area / np.where(is_cut, found.length, np.inf)
    width = np.where(free, width, np.nan)
    made = figure(10.0, 6.2)
    side, ax = made.subplots(1, 2, width_ratios=(0.3, 1.0))
    reason = found.reason[nearest].astype(float)
    grey = np.where(on_disc & ~free[nearest], reason, np.nan).reshape(_SIZE, _SIZE)
    greys = ListedColormap(list(_GREYS))
    ax.imshow(grey, origin="lower", extent=(-1, 1, -1, 1), cmap=greys, vmin=-0.5, vmax=len(_GREYS) - 0.5,
              interpolation="nearest")
    if free.any():
        colour = np.where(on_disc, width[nearest], np.nan).reshape(_SIZE, _SIZE)
        range_of_colours = Normalize(float(np.nanpercentile(width, 3)), float(np.nanmax(width)))
        image = ax.imshow(colour, origin="lower", extent=(-1, 1, -1, 1), cmap="viridis", interpolation="nearest",
                          norm=range_of_colours)
        bar = made.colorbar(image, ax=ax, shrink=0.75, extend="min")
        bar.set_label("average strip width (screening), mm")
    x, y = _on_map(found.axis, centre, right, 1.0)
    ax.plot(x, y, ".", color="black", markersize=1.0, alpha=0.35)
    _circles(ax)
    _mark(ax, marks, centre, right)
    reasons = {int(code) for code in found.reason if code > 0}
    _legends(side, ax, sorted(reasons))
    ax.set_title(f"{name}: axes around the mean normal, {len(found.axis)} looked at", fontsize=10)
    return made


def _on_map(axes: ArrayLike, pole: Array, right: Array, radius: float) -> tuple[Array, Array]:
    """Places on the map of axes that lie inside a radius: x and y."""
    place = equal_area(axes, pole, right)
    inside = np.linalg.norm(place, axis=1) <= radius
    x, y = place[inside].T
    return x, y


def _circles(ax: Axes) -> None:
    for angle in (30, 60, 90):
        radius = np.sqrt(2) * np.sin(np.radians(angle) / 2)
        width, line = (1.2, "-") if angle == 90 else (0.6, "--")
        ax.add_patch(Circle((0, 0), radius, fill=False, edgecolor="black", linewidth=width, linestyle=line))
        x = radius * np.sin(0.35)
        y = -radius * np.cos(0.35) + 0.01
        ax.text(x, y, f"{angle}°", fontsize=7, ha="center", va="bottom")
    ax.set_xlim(-1.03, 1.03)
    ax.set_ylim(-1.03, 1.03)
    ax.set_aspect("equal")
    ax.set_axis_off()


def _mark(ax: Axes, marks: Mapping[str, ArrayLike], pole: Array, right: Array) -> None:
    for label, axes in marks.items():
        shape, colour, size = _MARKS.get(label, ("^", "white", 7.0))
        x, y = _on_map(axes, pole, right, 1.0 + 1e-9)
        if not len(x):
            continue
        # A plus has no inside: it is all edge.
        edge: dict[str, Any] = {"markeredgewidth": 2.0}
        if shape != "+":
            edge = {"markeredgecolor": "black", "markeredgewidth": 0.8}
        ax.plot(x, y, shape, color=colour, markersize=size, label=label, zorder=5, linestyle="none", **edge)


def _legends(side: Axes, ax: Axes, reasons: list[int]) -> None:
    side.set_axis_off()
    marks, labels = ax.get_legend_handles_labels()
    named = side.legend(marks, labels, loc="upper left", bbox_to_anchor=(0.0, 1.0), fontsize=9, frameon=False,
                        title="axes", alignment="left", borderaxespad=0.0)
    side.add_artist(named)
    handles = [Patch(facecolor=_GREYS[code], edgecolor="#555555", linewidth=0.5, label=_wrap(REASONS[code]))
               for code in reasons]
    if handles:
        side.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 0.0), fontsize=9, frameon=False,
                    title="forbidden by", alignment="left", borderaxespad=0.0)


def _wrap(text: str) -> str:
    return "\n".join(wrap(text, 20))
