"""Strip width, gouge and clearance together, and tool tips beside a drop-cutter, in one run on one thread.

Gouge and clearance are decided by bounds that hold between points.  opencamlib drops its cutter on a mesh; the product
has no mesh path of its own, for it places tips on the exact face: the table sets one beside the other, point by point.
"""

import time
from collections.abc import Callable

import numpy as np
from benchmarks.bounds_rates import BODY, box, patch, seconds

from toolaxis.contact.clearance import clears
from toolaxis.contact.gouge import gouges
from toolaxis.contact.placing import place
from toolaxis.contact.second_order import second_order_many_axes
from toolaxis.contact.strip import step_widths_many_axes
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.shape.cells import cells
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

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


def mesh(face: Face, frame: np.ndarray, side: int) -> np.ndarray:
    """Triangles of a face in the tool's frame, (n, 3, 3)."""
    t = np.linspace(0, 1, side + 1)
    uv = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1).reshape(-1, 2)
    p = (face.evaluate(uv).point @ frame.T).reshape(side + 1, side + 1, 3)
    low, a, b, high = p[:-1, :-1], p[1:, :-1], p[:-1, 1:], p[1:, 1:]
    return np.concatenate([np.stack(half, axis=2).reshape(-1, 3, 3) for half in ((low, a, high), (low, high, b))])


def dropped(triangles: np.ndarray, xy: np.ndarray) -> tuple[float, np.ndarray]:
    """Seconds and heights of opencamlib's bull cutter, 12 mm with 1 mm corners, one thread."""
    import opencamlib as ocl

    surface, drop, cutter = ocl.STLSurf(), ocl.BatchDropCutter(), ocl.BullCutter(12, 1, 60)
    for triangle in triangles:
        surface.addTriangle(ocl.Triangle(*(ocl.Point(*map(float, corner)) for corner in triangle)))
    drop.setSTL(surface)
    drop.setThreads(1)
    drop.setCutter(cutter)
    for x, y in xy:
        drop.appendPoint(ocl.CLPoint(float(x), float(y), -100.0))
    start = time.process_time()
    drop.run()
    return time.process_time() - start, np.array([point.z for point in drop.getCLPoints()])


def drop_cutter() -> None:
    """Tips on the exact face, with the proof that they do not gouge, beside tips on its mesh."""
    face, tool, axis = patch(), Tool.torus(12, 1), unit([0.3, -0.15, 1.0])
    frame, skin = np.array([*perpendicular(axis), axis]), cells(face)
    uv = np.random.default_rng(4).uniform(0.1, 0.9, (100_000, 2))
    tips = place(face, tool, uv, axis)
    alone = len(uv) / seconds(lambda: place(face, tool, uv, axis))
    few = tips[:2000]
    deep = gouges(tool, few, axis, skin, 0.002)
    proven = 1 / (1 / alone + seconds(lambda: gouges(tool, few, axis, skin, 0.002)) / len(few))
    print("torus 12x1 on a 100 mm patch, points/s of processor time; differ: height of the tips that do not gouge, mm")
    print(f"{'triangles':>10}{'opencamlib':>12}{'tips':>12}{'ratio':>10}{'and proof':>12}{'ratio':>8}{'differ':>10}")
    for side, count in ((71, 300), (224, 50)):
        xyz = few[:count] @ frame.T
        triangles = mesh(face, frame, side)
        spent, height = dropped(triangles, xyz[:, :2])
        rate, free = count / spent, ~deep[:count]
        print(f"{len(triangles):10,}{rate:12,.0f}{alone:12,.0f}{alone / rate:10,.0f}{proven:12,.0f}"
              f"{proven / rate:8,.0f}{np.abs(height - xyz[:, 2])[free].max():10.5f}")
    print("opencamlib as it comes, one thread, its tree already built")
    print("a mesh is only right to its sag, the tips are right to rounding; there is no drop-cutter of our own\n")


def main() -> None:
    """Print both tables."""
    together()
    drop_cutter()


if __name__ == "__main__":
    main()
