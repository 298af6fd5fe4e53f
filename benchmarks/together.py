"""Strip width, gouge and clearance together, in one run on one thread.

Gouge and clearance are decided by bounds that hold between points.
"""

from collections.abc import Callable

import numpy as np
from benchmarks.bounds_rates import BODY, box, patch, seconds

from toolaxis.contact.clearance.clearance import clears
from toolaxis.contact.clearance.gouge import gouges
from toolaxis.contact.placement import place
from toolaxis.contact.strip.second_order import second_order_many_axes
from toolaxis.contact.strip.width import step_widths_many_axes
from toolaxis.shape.bounding.bounding_tree import cells
from toolaxis.tools.tool import Tool

TOOLS = (Tool.torus(12, 1, **BODY), Tool.ball(8, **BODY), Tool.flat(10, **BODY))
SCALLOP, CONTACTS, AXES = 0.02, 60, 40


def leaning(count: int, low: float, high: float) -> np.ndarray:
    """Axes between two angles from +z, rad."""
    rng = np.random.default_rng(2)
    lean, way = rng.uniform(low, high, count), rng.uniform(0, 2 * np.pi, count)
    return np.stack([np.sin(lean) * np.cos(way), np.sin(lean) * np.sin(way), np.cos(lean)], -1)


def together() -> None:
    """Every axis at every contact: width, then gouge, then clearance of those that do not gouge."""
    face = patch()
    around, skin = box(face), cells(face)
    uv = np.random.default_rng(3).uniform(0.05, 0.95, (CONTACTS, 2))
    print(f"{CONTACTS} contacts x {AXES} axes, us of processor time a pair; aim: 100,000 pairs/s for all three, 10 us")
    print(f"{'tool':14}{'axes':>12}{'free %':>8}{'width':>8}{'exact':>8}{'gouge':>8}{'clear':>8}"
          f"{'pairs/s':>10}{'exact':>10}")
    for tool in TOOLS:
        for name, low, high in (("15-30 deg", 15, 30), ("0-60 deg", 0, 60)):
            axes = leaning(AXES, np.radians(low), np.radians(high))
            tips = np.concatenate([place(face, tool, uv, axis) for axis in axes])
            rows = np.repeat(axes, CONTACTS, axis=0)
            free = ~gouges(tool, tips, rows, skin, 0.002)
            work: list[Callable[[], object]] = [
                lambda t=tool, a=axes: second_order_many_axes(face, t, uv, a, SCALLOP),
                lambda t=tool, a=axes: step_widths_many_axes(face, t, uv, a, SCALLOP),
                lambda t=tool, p=tips, a=rows: gouges(t, p, a, skin, 0.002),
                lambda t=tool, p=tips[free], a=rows[free]: clears(t, p, a, around)]
            for call in work:
                call()
            width, exact, deep, clear = (1e6 * seconds(call, 5) / len(rows) for call in work)
            print(f"{tool.name:14}{name:>12}{100 * free.mean():8.0f}{width:8.3f}{exact:8.2f}{deep:8.2f}{clear:8.2f}"
                  f"{1e6 / (width + deep + clear):10,.0f}{1e6 / (exact + deep + clear):10,.0f}")
    print("'width' is the second-order one that the search screens with; the last column takes the exact one instead\n")


def main() -> None:
    """Print the table."""
    together()


if __name__ == "__main__":
    main()
