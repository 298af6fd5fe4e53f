"""Cutters dropped on a mesh beside opencamlib, and tips placed on the exact face, in one run on one thread."""

import time

import numpy as np
from benchmarks.bounds_rates import patch, seconds

from toolaxis.contact.clearance.gouge import gouges
from toolaxis.contact.drop_cutter.drop_cutter import cutter_of, drop_cutter, drop_many, tree_of
from toolaxis.contact.drop_cutter.drop_cutter_numpy import drop_numpy
from toolaxis.contact.placement import place
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.shape.bounding.bounding_tree import cells
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

POINTS, AXIS = 20_000, unit([0.3, -0.15, 1.0])
#: Size of the patch, mm, squares along its side, two triangles each, points for opencamlib, and the aim over its rate.
SIZES = ((300, 71, 1000, 10), (300, 224, 100, 20), (300, 500, 30, 80), (100, 500, 15, 80))
BUCKETS = (1, 100)


def mesh(face: Face, frame: np.ndarray, side: int) -> np.ndarray:
    """Triangles of a face in the tool's frame, (n, 3, 3)."""
    t = np.linspace(0, 1, side + 1)
    uv = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1).reshape(-1, 2)
    p = (face.evaluate(uv).point @ frame.T).reshape(side + 1, side + 1, 3)
    low, a, b, high = p[:-1, :-1], p[1:, :-1], p[:-1, 1:], p[1:, 1:]
    return np.concatenate([np.stack(half, axis=2).reshape(-1, 3, 3) for half in ((low, a, high), (low, high, b))])


def theirs(triangles: np.ndarray, xy: np.ndarray) -> tuple[list[float], np.ndarray]:
    """Points per second of opencamlib's bull cutter, 12 mm with 1 mm corners, with each size of bucket, and heights."""
    import opencamlib as ocl

    surface, cutter, rates = ocl.STLSurf(), ocl.BullCutter(12, 1, 60), []
    for triangle in triangles:
        surface.addTriangle(ocl.Triangle(*(ocl.Point(*map(float, corner)) for corner in triangle)))
    for bucket in BUCKETS:
        drop = ocl.BatchDropCutter()
        drop.setBucketSize(bucket)
        drop.setSTL(surface)
        drop.setThreads(1)
        drop.setCutter(cutter)
        for x, y in xy:
            drop.appendPoint(ocl.CLPoint(float(x), float(y), -1000.0))
        start = time.process_time()
        drop.run()
        rates.append(len(xy) / (time.process_time() - start))
    return rates, np.array([point.z for point in drop.getCLPoints()])


def row(width: int, side: int, count: int, aim: int) -> None:
    """Print what one mesh gives."""
    face, tool, axis = patch().transformed(np.diag([width / 100] * 3 + [1])), Tool.torus(12, 1), AXIS
    frame, cutter, out = np.array([*perpendicular(axis), axis]), cutter_of(tool), np.empty(POINTS)
    tips = place(face, tool, np.random.default_rng(4).uniform(0.1, 0.9, (POINTS, 2)), axis)
    xyz = tips @ frame.T
    xy, some = np.ascontiguousarray(xyz[:, :2]), slice(0, count)
    triangles = mesh(face, frame, side)
    (plain, bucket), heights = theirs(triangles, xy[some])
    building = seconds(lambda: tree_of(triangles, cutter), 3)
    tree = tree_of(triangles, cutter)
    ours = POINTS / seconds(lambda: drop_many(cutter, tree, xy, out), 3)
    twin = 20 / seconds(lambda: drop_numpy(cutter, triangles, xy[:20]), 1)
    whole = POINTS / seconds(lambda: drop_cutter(triangles, tool, xy), 2)
    free = ~gouges(tool, tips[some], axis, cells(face), 0.002)
    differ, off = np.abs(out[some] - heights).max(), np.abs(out - xyz[:, 2])[some][free].max()
    print(f"{width:8}{len(triangles):10,}{ours:10,.0f}{twin:11,.0f}{plain:11,.0f}{bucket:9,.0f}{ours / plain:7,.0f}"
          f"{ours / bucket:7,.0f}{aim:5}{differ:10.1e}{off:10.5f}{building:8.3f}{whole:11,.0f}", flush=True)


def dropped() -> None:
    """Points per second on meshes of several sizes."""
    print("torus 12x1 on a freeform patch, points/s of processor time, trees already built; differ: greatest")
    print("difference of heights from opencamlib, mm; off face: from tips on the exact face that do not gouge, mm")
    print(f"{'patch mm':>8}{'triangles':>10}{'toolaxis':>10}{'numpy twin':>11}{'opencamlib':>11}{'buckets':>9}"
          f"{'ratio':>7}{'ratio':>7}{'aim':>5}{'differ':>10}{'off face':>10}{'tree s':>8}{'whole call':>11}")
    drop_cutter(mesh(patch(), np.eye(3), 2), Tool.torus(12, 1), [[50, 50]])
    for size in SIZES:
        row(*size)
    print(f"opencamlib as it comes, and with buckets of {BUCKETS[1]}, which it is faster with; 'whole call' is")
    print(f"drop_cutter of {POINTS} points, tree and all\n")


def placed() -> None:
    """Points per second on the exact face, and with the proof that they do not gouge."""
    face, tool, axis = patch(), Tool.torus(12, 1), AXIS
    uv = np.random.default_rng(4).uniform(0.1, 0.9, (100_000, 2))
    tips, skin = place(face, tool, uv, axis)[:2000], cells(face)
    alone = seconds(lambda: place(face, tool, uv, axis)) / len(uv)
    proof = seconds(lambda: gouges(tool, tips, axis, skin, 0.002)) / len(tips)
    print(f"tips on the exact face {1 / alone:,.0f} points/s, with the proof that they do not gouge "
          f"{1 / (alone + proof):,.0f};\na mesh is only right to its sag, these to rounding")


def main() -> None:
    """Print the table, and the rates on the face."""
    dropped()
    placed()


if __name__ == "__main__":
    main()
