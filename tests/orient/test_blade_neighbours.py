"""A blade between its neighbours: that no tool goes around it is seen by brute force over the whole tool, too."""

from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import label

import toolaxis as ta
from toolaxis.search.face_problem import task
from toolaxis.skin.join import join
from toolaxis.strategies.blade.plan import BladeSearch, blade

#: Half a step of angle, rad, and what points may lie inside the tool, mm.
HALF, SPARE = np.radians(0.5), 0.05
STICKOUT, ROUND = 110.0, 3.0
HOLDER = [(12.5, 0), (12.5, 60)]


@pytest.fixture(scope="module")
def part():
    """The blisk with the four faces of one blade as one, number 1."""
    return join(ta.load(Path(__file__).parents[2] / "examples" / "blisk.step"), (1, 163, 3, 161), corner=np.pi)


def cloud(faces, gap):
    """Points of faces about so far apart at most, (n, 3)."""
    rows = []
    for face in faces:
        u0, u1, v0, v1 = face.bounds
        coarse = [np.linspace(a, b, 9) for a, b in ((u0, u1), (v0, v1))]
        net = face.evaluate(np.stack(np.meshgrid(*coarse, indexing="ij"), axis=-1).reshape(-1, 2)).point
        net = net.reshape(9, 9, 3)
        sizes = [np.linalg.norm(np.diff(net, axis=k), axis=2).sum(axis=k).max() for k in (0, 1)]
        fine = [np.linspace(ends[0], ends[-1], int(size / gap) + 2) for ends, size in zip(coarse, sizes, strict=True)]
        uv = np.stack(np.meshgrid(*fine, indexing="ij"), axis=-1).reshape(-1, 2)
        rows.append(face.evaluate(uv[face.contains(uv)]).point)
    return np.concatenate(rows)


def radius(z):
    """Of the tool at heights above its tip, mm; below zero beyond its ends."""
    ball = np.sqrt(np.clip(ROUND**2 - (z - ROUND) ** 2, 0.0, None))
    return np.select([z < 0, z < ROUND, z < STICKOUT, z < STICKOUT + 60], [-1.0, ball, ROUND, 12.5], -1.0)


def free(centres, swing, points):
    """Where no point of the part lies in the tool, at ball centres by angles a degree apart, (n, 360).

    A point counts as inside only where it is at all angles half a degree around.
    """
    angles = np.arange(-np.pi, np.pi - 1e-9, 2 * HALF)
    cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
    found = np.empty((len(centres), len(angles)), dtype=bool)
    for k, centre in enumerate(centres):
        seen = points - centre
        seen = seen[np.abs(seen @ swing.direction) < 12.5]
        x, y = (seen @ way for way in swing.plane)
        up = cosine * x + sine * y + ROUND
        aside = np.hypot(cosine * y - sine * x, seen @ swing.direction)
        slack = np.hypot(x, y) * HALF + SPARE
        found[k] = ~((aside < radius(up) - slack) & (aside < radius(up - slack) - slack)).any(axis=1)
    return found


def turns(open_):
    """How often the tool turns on continuous ways around the blade, each begun at a free angle; empty without one."""
    count, wide = open_.shape
    parts, _ = label(np.tile(open_, (2, 3)))
    found = set()
    for k in np.flatnonzero(open_[0]):
        same = np.flatnonzero(parts[count] == parts[0, wide + k])
        found |= {(j - wide - k) // wide for j in same if (j - k) % wide == 0}
    return found


@pytest.mark.long
def test_no_tool_goes_around_between_neighbours_and_the_search_says_so(part):
    tool = ta.Tool.ball(6, stickout=STICKOUT, holder=HOLDER)
    found, made = blade(task(part.face(1), tool, 0.1, direction="climb", part=part))
    assert made is None and "closes on layer 1 of" in found.reasons[0] and "deg are missing" in found.reasons[0]
    search = BladeSearch(task(part.face(1), tool, 0.1, direction="climb", part=part))
    turn = search.turns[0]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(turn.centre, axis=0), axis=1))])
    centres = turn.centre[np.unique(np.searchsorted(way, np.arange(0.0, way[-1], 1.0)))]
    assert not turns(free(centres, search.swing, cloud(part.faces, 1.2)))
    alone = [part.face(number) for number in (1, 4, 159, 160, 162, 5)]
    assert 1 in turns(free(centres, search.swing, cloud(alone, 1.2)))


@pytest.mark.long
def test_alone_on_its_hub_the_blade_is_gone_around(part):
    tool = ta.Tool.ball(6, stickout=STICKOUT, holder=HOLDER)
    job = task(part.face(1), tool, 0.4, direction="climb", skin=[part.face(n) for n in (4, 159, 160, 162)],
               surroundings=[part.face(5)])
    found, made = blade(job)
    assert found.outcome == "feasible" and made is not None, found.reasons
    assert "without turning back" in found.reasons[0]
