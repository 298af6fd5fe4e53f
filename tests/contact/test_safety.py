"""Thousands of random cases of gouge and collision against dense sampling: "safe" must never be said wrongly."""

import numpy as np
import pytest
from dense import (
    COMPONENTS,
    LIMITS,
    LOWERED,
    POSES,
    a_tool,
    a_turn,
    bicubic,
    contacts,
    cylinder,
    least_phi,
    phi,
    samples_of,
    told_at_most,
    unit,
)

from toolaxis.contact.clearance.clearance import clearances, clears
from toolaxis.contact.clearance.gouge import gouges, penetration
from toolaxis.contact.clearance.surroundings import Surroundings
from toolaxis.shape.face import Face

SOME = range(20)

# ---- the two statements --------------------------------------------------------------------------------------------

def _judge_gouges(seed, limit):
    """Rows (true depth, told at most, bound, exceeds, rounded) of one scene: contacts, some of them lowered.

    A contact that was lowered is that deep; a sharp corner may be told to be deeper than the skin lies inside it.
    """
    rng = np.random.default_rng([1, seed])
    face = Face.from_bspline(bicubic(rng, rng.uniform(20, 80, 2), rng.uniform(0, 2)))
    tool, sampled = a_tool(rng), samples_of(face)
    tips, axis, n = contacts(rng, face, tool, rng.uniform(0.05, 0.5))
    lowered = rng.choice(LOWERED[limit], POSES)
    tips = tips - lowered[:, None] * n
    least = [least_phi(tool, [sampled], tip, t, "cutter")[0] for tip, t in zip(tips, axis, strict=True)]
    inside = np.maximum(0.0, -np.array(least))
    return np.column_stack([np.maximum(inside, lowered), np.maximum(told_at_most(tool, inside), lowered),
                            penetration(tool, tips, axis, (face,)), gouges(tool, tips, axis, (face,), limit),
                            np.full(POSES, tool.corner_radius > 0)])


def _judge_collisions(seed):
    """Rows (true distances, bounds, safe) of one scene; nearest places set to -0.005, 0.02 or left as they come."""
    rng = np.random.default_rng([2, seed])
    tool = a_tool(rng)
    moved = [cylinder(rng, rng.uniform(5, 40), rng.uniform(20, 60)),
             Face.from_bspline((bicubic(rng, rng.uniform(20, 60, 2), rng.uniform(0, 3)) - [20, 20, 0]) @ a_turn(rng)),
             Face.from_bspline((bicubic(rng, rng.uniform(20, 60, 2), 0) - [20, 20, 0])[::5, ::5] @ a_turn(rng), (1, 1))]
    faces = [samples_of(face) for face in moved]
    axis = unit(rng.standard_normal((POSES, 3)))
    tips = np.empty((POSES, 3))
    truth = np.empty((POSES, 3))
    for k in range(POSES):
        component = COMPONENTS[rng.integers(3)]
        start = unit(rng.standard_normal(3) - axis[k]) * 120
        tips[k], truth[k] = _planted(tool, faces, (start, axis[k], component), rng.choice([-0.005, 0.02, 0.3]))
    around = Surroundings(tuple(moved), np.zeros((3, 3)))
    return np.column_stack([truth, clearances(tool, tips, axis, around, 5.0).distance,
                            clears(tool, tips, axis, around).safe])


def _planted(tool, faces, pose, wanted):
    """A tip near the start at which a component's distance is about the wanted one, and all true distances there."""
    tip, axis, component = pose
    for _ in range(3):
        value, place = least_phi(tool, faces, tip, axis, component)
        h = 1e-6
        steps = [(place - h * d, place + h * d) for d in np.eye(3)]
        rise = [phi(tool, a, tip, axis, component) - phi(tool, b, tip, axis, component) for a, b in steps]
        slope = np.array(rise) / (2 * h)
        tip = tip + (wanted - value) * slope / max(np.linalg.norm(slope), 0.5)
    return tip, [least_phi(tool, faces, tip, axis, c)[0] for c in COMPONENTS]


def _check_gouges(rows, limit):
    depth, most, bound, exceeds, rounded = rows.T
    assert (bound >= depth - 1e-7).all()
    tight = bound <= most + 0.0005 + 0.05 * np.maximum(0, most - 0.1)
    assert tight[rounded == 1].mean() > 0.999
    assert tight[rounded == 0].mean() > 0.85  # the search above stops short in valleys of sharp edges
    assert not (~exceeds.astype(bool) & (depth > limit + 1e-7)).any()
    shallow = most < limit - 0.0005
    assert exceeds[shallow].mean() < 0.01
    assert bound[(depth < 1e-5) & (rounded == 1)].max() < 0.001
    assert (bound[(depth < 1e-5) & (rounded == 0)] < 0.001).mean() > 0.98
    assert 0.05 < exceeds.mean() < 0.95


def _check_collisions(rows):
    truth, bound, safe = rows[:, :3], rows[:, 3:6], rows[:, 6].astype(bool)
    outside = truth > 0
    assert (bound <= np.minimum(truth, 5.0) + 1e-6)[outside].all()
    assert (bound[~outside] < 1e-6).all()  # how deep, counts to the next border of one convex piece
    apart = (truth > 0) & (truth < 5)
    assert (bound[apart] >= truth[apart] - 0.002).mean() > 0.999
    least = truth.min(axis=1)
    assert not (safe & (least < -1e-6)).any()
    assert safe[least >= 0.02 - 1e-6].mean() >= 0.99
    assert ((least < -0.003) & (least > -0.007)).mean() > 0.1
    assert ((least > 0.015) & (least < 0.025)).mean() > 0.1


@pytest.mark.parametrize("limit", LIMITS)
def test_gouges_are_never_missed(limit):
    _check_gouges(np.vstack([_judge_gouges(seed, limit) for seed in SOME]), limit)


def test_collisions_are_never_missed():
    _check_collisions(np.vstack([_judge_collisions(seed) for seed in SOME[:12]]))


@pytest.mark.long
@pytest.mark.parametrize("limit", LIMITS)
def test_gouges_are_never_missed_in_5000_cases(limit):
    _check_gouges(np.vstack([_judge_gouges(seed, limit) for seed in range(250)]), limit)


@pytest.mark.long
def test_collisions_are_never_missed_in_5000_cases():
    _check_collisions(np.vstack([_judge_collisions(seed) for seed in range(250)]))
