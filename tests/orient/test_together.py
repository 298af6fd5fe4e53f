"""One axis for several sub-surfaces: against a fine grid of axes, and where there is none."""

import numpy as np

import toolaxis as ta
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.fixed_axis import best_axis
from toolaxis.search.shared_axis import SharedAxisSearch, together

TOOL, H = ta.Tool.torus(12, 1), 0.1


def sheet(lean: float, shift: float = 0.0) -> ta.Face:
    """A bulging patch of 24 x 16 mm that leans to one side by degrees."""
    x, y = np.meshgrid(np.linspace(-12, 12, 5), np.linspace(-8, 8, 5), indexing="ij")
    points = np.stack([x, y, -(x**2) / 150 - y**2 / 120], axis=-1)
    c, s = np.cos(np.radians(lean)), np.sin(np.radians(lean))
    return ta.Face.from_bspline(points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) + [shift, 0, 0])


def worth_of(jobs: list[FaceProblem], axis: np.ndarray) -> float:
    """Sum of exact values, each sub-surface by itself."""
    total = 0.0
    for job in jobs:
        if job.feasibility.witness(axis) is not None:
            return np.inf
        ledger = AxisTable(job.feasibility, job.worth)
        total += min(ledger.count(axis, feed, 0.0)[0] for feed in (0, 1))
    return total


def test_no_axis_of_a_grid_serves_both_much_better() -> None:
    jobs = [task(sheet(-10), TOOL, H), task(sheet(15, 60.0), TOOL, H)]
    found = together(jobs)
    values = [worth_of(jobs, axis) for axis in found]
    assert np.allclose(np.linalg.norm(found, axis=1), 1) and values == sorted(values) and np.isfinite(values[0])
    angle = np.radians(np.arange(2, 50, 4))
    turn = np.radians(np.arange(0, 360, 20))
    grid = np.array([[np.sin(a) * np.cos(t), np.sin(a) * np.sin(t), np.cos(a)] for a in angle for t in turn])
    pool = SharedAxisSearch(jobs)
    pool.look(grid)
    assert np.isfinite(pool.price).sum() > 20
    promising = grid[np.argsort(pool.price)[:5]]
    assert values[0] <= 1.003 * min(worth_of(jobs, axis) for axis in promising)
    alone = [min(worth_of([job], lobe.axis) for lobe in best_axis(job.worth.face, TOOL, H).lobes) for job in jobs]
    assert sum(alone) <= values[0] * 1.002


def test_faces_that_look_apart_have_no_axis_in_common() -> None:
    assert len(together([task(sheet(-85), TOOL, H), task(sheet(90, 60.0), TOOL, H)])) == 0
