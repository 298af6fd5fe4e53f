"""Rates of the numeric kernels beside their peers, in one run on one thread: splines, trim loops, first call."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import NdBSpline

from toolaxis.numeric import bspline
from toolaxis.numeric.polygons import inside, slabs
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.nurbs import NurbsSurface

POINTS = 100_000
ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


def seconds(work: Callable[[], object], repeats: int) -> float:
    """Least processor time of a call, s."""
    best = np.inf
    for _ in range(repeats):
        start = time.thread_time()
        work()
        best = min(best, time.thread_time() - start)
    return float(best)


def patch(degree: int, rational: bool) -> NurbsSurface:
    """A wavy patch of 12 x 10 control points."""
    rng = np.random.default_rng(0)
    x, y = np.meshgrid(np.linspace(0, 80, 12), np.linspace(0, 60, 10), indexing="ij")
    points = np.stack([x, y, 10 * np.sin(x / 20) * np.cos(y / 25) + rng.normal(size=x.shape)], -1)
    return NurbsSurface.from_points(points, (degree, degree),
                                    weights=rng.uniform(0.8, 1.3, x.shape) if rational else None)


def scipy_rate(surface: NurbsSurface, uv: np.ndarray) -> tuple[float, np.ndarray]:
    """Points per second of NdBSpline with five derivatives of a polynomial surface, and its answers."""
    spline = NdBSpline((surface.knots_u, surface.knots_v), surface.control[..., :3].copy(), surface.degree)

    def work() -> np.ndarray:
        return np.stack([spline(uv, nu=list(order)) for order in ORDERS], axis=1)

    return len(uv) / seconds(work, 3), work()


def kernel_surface(surface: NurbsSurface) -> Any:
    """The same surface in the CAD kernel."""
    from OCP.Geom import Geom_BSplineSurface
    from OCP.gp import gp_Pnt

    from toolaxis.cad.ocp.kernel_names import IntegerArray, PointGrid, RealArray, RealGrid

    nu, nv = surface.control.shape[:2]
    poles, weights = PointGrid(1, nu, 1, nv), RealGrid(1, nu, 1, nv)
    for i in range(nu):
        for j in range(nv):
            w = float(surface.control[i, j, 3])
            poles.SetValue(i + 1, j + 1, gp_Pnt(*(float(c) / w for c in surface.control[i, j, :3])))
            weights.SetValue(i + 1, j + 1, w)
    tables = []
    for knots in (surface.knots_u, surface.knots_v):
        values, counts = np.unique(knots, return_counts=True)
        real, whole = RealArray(1, len(values)), IntegerArray(1, len(values))
        for i, (value, count) in enumerate(zip(values, counts, strict=True)):
            real.SetValue(i + 1, float(value))
            whole.SetValue(i + 1, int(count))
        tables.append((real, whole))
    (ku, mu), (kv, mv) = tables
    return Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, *surface.degree, False, False)


def kernel_rate(surface: NurbsSurface, uv: np.ndarray) -> tuple[float, float, np.ndarray]:
    """D2 calls per second of the CAD kernel from Python, the same with their answers read, and the answers."""
    from OCP.gp import gp_Pnt, gp_Vec

    geometry, point, vectors = kernel_surface(surface), gp_Pnt(), [gp_Vec() for _ in range(5)]
    su, sv, suu, svv, suv = vectors
    pairs, answers = uv.tolist(), np.empty((len(uv), 6, 3))

    def call() -> None:
        for u, v in pairs:
            geometry.D2(u, v, point, su, sv, suu, svv, suv)

    def read() -> None:
        for row, (u, v) in zip(answers, pairs, strict=True):
            geometry.D2(u, v, point, su, sv, suu, svv, suv)
            row[:] = [(a.X(), a.Y(), a.Z()) for a in (point, su, sv, suu, suv, svv)]

    return len(uv) / seconds(call, 3), len(uv) / seconds(read, 3), answers


def agreement(found: np.ndarray, wanted: np.ndarray) -> float:
    """Greatest difference over the greatest entry, the worst of the six vectors."""
    return float((np.abs(found - wanted).max(axis=(0, 2)) / np.abs(wanted).max(axis=(0, 2))).max())


def spline_table() -> None:
    """Position and five derivatives."""
    rng = np.random.default_rng(1)
    uv = rng.uniform(0, 1, (POINTS, 2))
    few = uv[:20_000]
    print(f"position and five derivatives, {POINTS} random points, million points/s of processor time")
    print(f"{'surface':26}{'toolaxis':>9}{'one by one':>11}{'numpy':>8}{'NdBSpline':>10}{'OCP D2':>8}"
          f"{'and read':>9}{'/NdBSpline':>11}{'/OCP':>6}{'/read':>6}{'differ':>9}")
    for degree, rational in ((3, False), (3, True), (2, True), (5, False), (5, True)):
        surface = patch(degree, rational)
        data, out = surface.data, np.empty((POINTS, 6, 3))
        bspline.surface_derivatives_many(data, uv)
        bspline._many(data, uv, out)
        ours = POINTS / seconds(lambda d=data: bspline.surface_derivatives_many(d, uv), 15)
        single = POINTS / seconds(lambda d=data, o=out: bspline._many(d, uv, o), 15)
        twin = len(few) / seconds(lambda d=data: bspline.surface_derivatives_many_numpy(d, few), 3)
        by_kernel, by_reading, answers = kernel_rate(surface, few)
        by_scipy, other = scipy_rate(surface, few) if not rational else (np.nan, answers)
        found = bspline.surface_derivatives_many(data, few)
        differ = max(agreement(found, answers), agreement(found, other))
        name = f"degree {degree} {'rational' if rational else 'polynomial'}"
        print(f"{name:26}{ours / 1e6:9.2f}{single / 1e6:11.2f}{twin / 1e6:8.2f}{by_scipy / 1e6:10.3f}"
              f"{by_kernel / 1e6:8.3f}{by_reading / 1e6:9.3f}{ours / by_scipy:11.1f}{ours / by_kernel:6.0f}"
              f"{ours / by_reading:6.0f}{differ:9.1e}")
    print("the aim is 10 times NdBSpline, 40 times OCP, 1e-10; 'one by one' is the kernel that other kernels call;")
    print("'and read' is D2 with its six vectors put into an array, which is what the others deliver\n")


def trim_table() -> None:
    """Points in a trim loop."""
    import matplotlib.path
    import shapely

    rng = np.random.default_rng(0)
    points = rng.uniform(-1.3, 1.3, (POINTS, 2))
    print(f"point in trim loop, {POINTS} points, ms of processor time")
    print(f"{'vertices':>8}{'toolaxis':>10}{'index':>8}{'shapely':>9}{'matplotlib':>12}{'/shapely':>10}{'differ':>8}")
    for count in (50, 500, 5000):
        angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
        reach = 1 + 0.3 * np.sin(7 * angle) + 0.02 * rng.normal(size=count)
        loop = np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])
        table, polygon, path = slabs((loop,)), shapely.Polygon(loop), matplotlib.path.Path(loop, closed=False)
        shapely.prepare(polygon)
        answer = inside(table, points)
        ours = seconds(lambda t=table: inside(t, points), 15)
        index = seconds(lambda p=loop: slabs((p,)), 15)
        theirs = seconds(lambda p=polygon: shapely.contains_xy(p, points), 7)
        slow = seconds(lambda p=path: p.contains_points(points), 1) if count <= 500 else np.nan
        differ = int((answer != shapely.contains_xy(polygon, points)).sum())
        print(f"{count:8}{ours * 1e3:10.2f}{index * 1e3:8.2f}{theirs * 1e3:9.2f}{slow * 1e3:12.1f}"
              f"{theirs / ours:10.1f}{differ:8}")
    print()


def face_table() -> None:
    """What a face is asked for."""
    angle = np.linspace(0, 2 * np.pi, 500, endpoint=False)
    loop = np.column_stack([0.5 + 0.4 * np.cos(angle), 0.5 + 0.4 * np.sin(angle)])
    surface, uv = patch(3, True), np.random.default_rng(1).uniform(0, 1, (POINTS, 2))
    face = Face(surface, (loop,))
    targets = face.evaluate(uv[:2000]).point + np.random.default_rng(2).normal(0, 5, (2000, 3))
    rows = [("normals", lambda: face.normal(uv), POINTS), ("principal curvatures", lambda: face.curvature(uv), POINTS),
            ("nearest points", lambda: nearest(face, targets), len(targets)),
            ("area", lambda: Face(surface, (loop,)).area, 1), ("box", lambda: Face(surface, (loop,)).box, 1)]
    print("a bicubic rational face with a loop of 500 vertices, processor time")
    for name, work, count in rows:
        work()
        print(f"{name:24}{seconds(work, 3) / count * 1e6:10.2f} us each")
    print()


START = """
import time
t = time.perf_counter()
import numpy as np
n = time.perf_counter()
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.numeric.polygons import inside, slabs
i = time.perf_counter()
s = NurbsSurface.from_points(np.random.default_rng(0).normal(size=(6, 6, 3)))
s.evaluate(np.array([[0.3, 0.4]]))
c = time.perf_counter()
s.evaluate(np.array([[2.0, 0.4]]))
o = time.perf_counter()
inside(slabs((np.eye(3)[:, :2],)), np.zeros((1, 2)))
print(i - n, c - i, o - c, time.perf_counter() - o)
"""


def start_table() -> None:
    """First calls in a new process, compiling and from disk."""
    print("first calls in a new process, s")
    print(f"{'':8}{'import':>8}{'spline':>8}{'beyond':>8}{'loop':>8}")
    with tempfile.TemporaryDirectory() as folder:
        path = os.pathsep.join([str(Path(bspline.__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
        for name in ("cold", "warm"):
            done = subprocess.run([sys.executable, "-c", START], capture_output=True, text=True, check=True,
                                  env={**os.environ, "NUMBA_CACHE_DIR": folder, "PYTHONPATH": path})
            print(f"{name:8}" + "".join(f"{float(x):8.2f}" for x in done.stdout.split()))
    print()


def main() -> None:
    """Print every table."""
    spline_table()
    trim_table()
    face_table()
    start_table()


if __name__ == "__main__":
    main()
