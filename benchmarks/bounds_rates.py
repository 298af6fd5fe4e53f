"""Rates and tightness of gouge and clearance bounds beside dense sampling, in one run on one thread.

The samplings only look at points; the bounds hold between them.  Run it as ``python -m benchmarks bounds_rates``.
"""

import time
from collections.abc import Callable

import numpy as np

from toolaxis.contact.clearance import queries as distances
from toolaxis.contact.clearance.clearance import clearances, clears, segment_clears
from toolaxis.contact.clearance.gouge import RESOLUTION, gouges, penetration, segment_gouges
from toolaxis.contact.clearance.queries import lower_bounds, motions
from toolaxis.contact.clearance.surroundings import IGNORED, Surroundings
from toolaxis.contact.placement import place
from toolaxis.numeric.vectors import unit
from toolaxis.shape.bounding.bounding_tree import cells
from toolaxis.shape.bounding.build import build_tree
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

BODY = {"stickout": 60, "shank": [(6, 0), (6, 60)], "holder": [(10, 0), (10, 40), (25, 40), (25, 80)]}
TOOLS = (Tool.torus(12, 1, **BODY), Tool.ball(8, **BODY), Tool.flat(10, **BODY), Tool.tapered(6, 1, 4, **BODY))
PAIRS = 2000


def patch() -> Face:
    """A freeform patch of 100 mm x 100 mm, bicubic, with 4 x 4 spans."""
    x, y = np.meshgrid(np.linspace(0, 100, 7), np.linspace(0, 100, 7), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 2 * np.random.default_rng(1).standard_normal(x.shape)], axis=-1))


def box(face: Face) -> Surroundings:
    """Four walls around the patch, 10 mm away and 40 mm high, and the patch itself for shank and holder."""
    corners = np.array([[-10, -10], [110, -10], [110, 110], [-10, 110.0]])
    walls = [Face.from_bspline(np.array([[[*a, -20], [*a, 40]], [[*b, -20], [*b, 40]]], dtype=float), (1, 1))
             for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    return Surroundings.of((face, *walls), skin=(face,))


def contacts(face: Face) -> tuple[np.ndarray, np.ndarray]:
    """Parameters, and axes that lean from the normals by about 15 deg."""
    rng = np.random.default_rng(2)
    uv = rng.uniform(0.05, 0.95, (PAIRS, 2))
    return uv, unit(face.normal(uv) + 0.2 * rng.standard_normal((PAIRS, 3)))


def seconds(call: Callable[[], object], repeats: int = 3) -> float:
    """Least processor time of some calls, s."""
    best = np.inf
    for _ in range(repeats):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
    return float(best)


def sampled(tool: Tool, tips: np.ndarray, axis: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Least distance of sampled points from the whole tool, one position after another, in numpy."""
    least = []
    for tip, t in zip(tips, axis, strict=True):
        w = points - tip
        z = w @ t
        rho = np.sqrt(np.maximum(np.einsum("ij,ij->i", w, w) - z * z, 0))
        least.append(tool.distance(np.column_stack([rho, np.zeros_like(z), z])).value.min())
    return np.array(least)


def _rates(face: Face, around: Surroundings, tool: Tool) -> None:
    uv, axis = contacts(face)
    tips, skin = place(face, tool, uv, axis), cells(face)
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 64), np.linspace(0, 1, 64)), -1).reshape(-1, 2)
    near = face.evaluate(uv[0] + 0.1 * (grid - 0.5)).point
    alone = Tool(tool.kind, tool.radius, tool.corner_radius, tool.half_angle, tool.flute_length)
    line = np.column_stack([np.linspace(0.05, 0.95, PAIRS // 10), np.full(PAIRS // 10, 0.4)])
    one = unit([0.25, 0.1, 1.0])
    steps = place(face, tool, line, one)
    work: list[tuple[str, int, Callable[[], object]]] = [
        ("depth below the skin, to 0.0003 mm", PAIRS, lambda: penetration(tool, tips, axis, skin)),
        ("deeper than 0.002 mm?", PAIRS, lambda: gouges(tool, tips, axis, skin, 0.002)),
        ("  64 x 64 samples, numpy", 50, lambda: sampled(alone, tips[:50], axis[:50], near)),
        ("distances to 5 faces, to 0.001 mm", PAIRS, lambda: clearances(tool, tips, axis, around)),
        ("all required distances kept?", PAIRS, lambda: clears(tool, tips, axis, around)),
        ("motions of a pass: deeper than 0.01?", len(steps) - 1, lambda: segment_gouges(tool, steps, one, skin, 0.01)),
        ("motions of a pass: distances kept?", len(steps) - 1, lambda: segment_clears(tool, steps, one, around))]
    for name, count, call in work:
        call()
        spent = seconds(call)
        print(f"{name:38}{tool.name:15}{count / spent:12,.0f}/s{1e6 * spent / count:10.2f} us")


def _twin(face: Face, tool: Tool) -> None:
    uv, axis = contacts(face)
    tips, skin = place(face, tool, uv, axis), cells(face)
    available, distances._compiled.available = distances._compiled.available, False
    try:
        spent = seconds(lambda: gouges(tool, tips[:200], axis[:200], skin, 0.002), 1)
    finally:
        distances._compiled.available = available
    print(f"{'deeper than 0.002 mm? numpy twin':38}{tool.name:15}{200 / spent:12,.0f}/s{1e6 * spent / 200:10.2f} us")


def _tightness(face: Face) -> None:
    uv, axis = contacts(face)
    only = np.array([[0.0, IGNORED, IGNORED]])
    print(f"\n{'depth answered for free contacts':38}{'median':>10}{'worst':>10}{'cells':>9}  (mm)")
    for tool in TOOLS:
        tips = place(face, tool, uv, axis)
        found = lower_bounds(cells(face), tool, motions(tips, axis), 0.0, RESOLUTION, only)
        free = -found.lower[found.lower[:, 0] > -0.002, 0]
        print(f"  {tool.name:36}{np.median(free):10.5f}{free.max():10.5f}{found.looked.mean():9.0f}")


def main() -> None:
    """Print the tables."""
    face = patch()
    spent = seconds(lambda: build_tree(face, 0.001), 1)
    tree = cells(face)
    print(f"cells of a 100 mm patch: {len(tree.leaf):,} leaves, {tree.shape.nbytes / 1e6:.1f} MB, {1e3 * spent:.0f} ms")
    around = box(face)
    for tool in TOOLS:
        _rates(face, around, tool)
    _twin(face, TOOLS[0])
    _tightness(face)


if __name__ == "__main__":
    main()
