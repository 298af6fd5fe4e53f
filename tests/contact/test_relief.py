"""What faces miss each other by is taken off depths near their edge: by the kernel, by its twin, and by sampling."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.contact.clearance import queries as distances
from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, motions, segment_motions
from toolaxis.contact.clearance.relief import relief_over, relief_over_numpy
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.shape.face import Face
from toolaxis.shape.seams import REACH, Mismatch
from toolaxis.tools.tool import Tool

BALL = Tool.ball(8)


def plane(corner, one, two, number):
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    face = Face.from_bspline(np.asarray(corner) + s[..., None] * np.asarray(one) + t[..., None] * np.asarray(two))
    return replace(face, number=number, label=str(number))


def stair(height):
    """z = 0 left of x = 0, higher to the right of it; the higher face stands out."""
    faces = (plane([-20, -10, 0], [20, 0, 0], [0, 20, 0], 1), plane([0, -10, height], [20, 0, 0], [0, 20, 0], 2))
    segment = np.array([[0.0, -10, 0, 0, 0, 0, height], [0, 0, 0, 0, 10, 0, height]])
    return forest(faces).missing(Mismatch(segment, np.array([[0, 0], [0, 2], [0, 2]]), 0.0))


def sampled(cells, tips):
    """The greatest of depth less relief over dense places of both faces, for a ball that stands at tips."""
    found = []
    for tip in tips:
        worst = 0.0
        for face, (low, high, z) in enumerate(((-3.0, 0.0, 0.0), (0.0, 3.0, cells.mismatch.segment[0, 6]))):
            x = np.linspace(low, high, 60_001)
            depth = 4.0 - np.sqrt((x - tip[0])**2 + (z - tip[2] - 4.0)**2)
            off = face * cells.mismatch.segment[0, 6] * np.clip(2.0 - np.hypot(x, z) / REACH, 0.0, 1.0)
            worst = max(worst, float((depth - off).max()))
        found.append(worst)
    return np.array(found)


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("height", [0.0034, 0.012])
def test_depth_less_what_the_faces_miss(height, compiled, monkeypatch):
    if not compiled:
        monkeypatch.setattr(distances._compiled, "available", False)
    cells = stair(height)
    x = np.array([-1.5, -0.3, -0.1, -0.02, 0.0, 0.3, 0.9, 1.5])
    tips = np.column_stack([x, np.zeros(8), np.linspace(-0.004, 0.001, 8)])
    found = np.maximum(-lower_bounds(cells, BALL, motions(tips, [0, 0, 1]), 0.0, 1e-5).lower[:, 0], 0.0)
    assert found == pytest.approx(sampled(cells, tips), abs=2.5e-5)


def test_a_cutter_on_the_lower_face_is_free_beside_the_seam():
    """Each place on the face at z = 0, right up to the edge, and on to the higher face; nothing is left to charge."""
    for height in (0.0034, 0.012):
        x = np.linspace(-2.0, 2.0, 81)
        tips = np.column_stack([x, np.zeros(81), np.where(x > 0, height, 0.0)])
        required = np.tile([-0.0005, -np.inf, -np.inf], (2, 1))
        moves = segment_motions(tips, [0, 0, 1])
        assert (keeps_limits(stair(height), BALL, moves, required).blocked < 0).all()
        plain = forest(stair(height).faces)
        assert (keeps_limits(plain, BALL, moves, required).blocked >= 0).any()


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("tolerance", [0.002, 0.01])
def test_what_is_deeper_is_found(tolerance, compiled, monkeypatch):
    """Deeper than tolerance and step beside the seam; deeper than the tolerance away from it or on the lower face."""
    if not compiled:
        monkeypatch.setattr(distances._compiled, "available", False)
    height = 0.006
    cells, required = stair(height), np.tile([-tolerance, -np.inf, -np.inf], (2, 1))

    def blocked(x, depth_in_higher):
        tip = [[x, 0.0, height - depth_in_higher]]
        return keeps_limits(cells, BALL, motions(tip, [0, 0, 1]), required).blocked[0] >= 0

    assert not blocked(0.2, tolerance + height - 3e-4) and blocked(0.2, tolerance + height + 3e-4)
    assert not blocked(2.0, tolerance - 3e-4) and blocked(2.0, tolerance + 3e-4)
    assert not blocked(-2.0, height + tolerance - 3e-4) and blocked(-2.0, height + tolerance + 3e-4)


def test_distances_are_not_enlarged():
    """Only depths are less; where the cutter stays away its distance is the same."""
    cells = stair(0.006)
    tips = [[0.1, 0.0, 0.5], [0.1, 0.0, 0.008]]
    far = lower_bounds(cells, BALL, motions(tips, [0, 0, 1]), 5.0, 1e-5).lower[:, 0]
    assert far == pytest.approx([0.494, 0.002], abs=2e-5)


def test_stock_is_kept_with_the_step_taken_off():
    cells = stair(0.006)
    left = cells.missing(cells.mismatch._replace(stock=0.3))
    tip = [[0.2, 0.0, 0.3]]
    assert lower_bounds(left, BALL, motions(tip, [0, 0, 1]), 5.0, 1e-5).lower[0, 0] == pytest.approx(0.3, abs=2e-5)
    assert lower_bounds(cells, BALL, motions(tip, [0, 0, 1]), 5.0, 1e-5).lower[0, 0] == pytest.approx(0.294, abs=2e-5)


def test_bounds_over_balls_hold_and_the_twin_agrees():
    rng = np.random.default_rng(8)
    segment = np.hstack([rng.uniform(-2, 2, (12, 6)), rng.uniform(0.0005, 0.02, (12, 1))])
    relief = (segment, np.array([[0, 5], [5, 5], [5, 12], [0, 12]]), 0.0)
    face, centre, radius = rng.integers(-1, 3, 200), rng.uniform(-3, 3, (200, 3)), rng.uniform(0, 1, 200)
    least, greatest = relief_over_numpy(relief, face, centre, radius)
    for k in range(200):
        assert relief_over(relief, face[k], tuple(centre[k]), radius[k]) == pytest.approx((least[k], greatest[k]))
        if face[k] < 0:
            assert least[k] == 0.0
        inner = rng.normal(size=(50, 3))
        inner = centre[k] + radius[k] * rng.random((50, 1)) * inner / np.linalg.norm(inner, axis=1, keepdims=True)
        low, high = relief_over_numpy(relief, np.full(50, face[k]), inner, np.zeros(50))
        assert (high >= least[k] - 1e-12).all() and (high <= greatest[k] + 1e-12).all()
        assert face[k] < 0 or np.array_equal(low, high)
