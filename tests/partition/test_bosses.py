"""Bosses: found where walls rise from an inner loop, and nowhere else."""

from pathlib import Path

import numpy as np
import pytest

from toolaxis.partition.bosses import bosses_of

pytest.importorskip("OCP")
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def parts():
    from toolaxis.cad import load
    from toolaxis.cad.step.worker import read_shape

    return {name: load(read_shape(str(EXAMPLES / f"{name}.step"))[0]) for name in ("boss", "bosses", "trimmed")}


def main_face(part):
    return max(part.sculptured, key=lambda face: face.area).number


def test_a_round_post_is_one_boss_of_a_wall_and_a_top(parts):
    part = parts["boss"]
    (boss,) = bosses_of(part, main_face(part))
    assert [part.face(n).kind for n in boss.faces] == ["cylinder", "plane"]
    assert boss.walls == boss.faces[:1]
    assert np.hypot(boss.foot[:, 0] - 3, boss.foot[:, 1] + 2) == pytest.approx(12, abs=1e-3)
    assert 62 - boss.foot[:, 2].max() < boss.height < 62 - boss.foot[:, 2].min()


def test_three_posts_are_three_bosses_and_a_fillet_belongs_to_its_own(parts):
    part = parts["bosses"]
    found = bosses_of(part, main_face(part))
    assert sorted(tuple(sorted(part.face(n).kind for n in boss.faces)) for boss in found) == [
        ("bspline", "cone", "plane"), ("cylinder", "cylinder", "plane", "plane", "plane"), ("cylinder", "plane")]
    assert sorted(len(boss.walls) for boss in found) == [1, 1, 4]
    assert all(15 < boss.height < 35 for boss in found)


def test_a_hole_is_no_boss(parts):
    part = parts["trimmed"]
    assert len(part.face(1).trims) == 2
    assert bosses_of(part, 1) == ()


def test_a_face_without_inner_loops_has_none(parts):
    part = parts["boss"]
    plain = next(face.number for face in part.faces if len(face.trims) < 2)
    assert bosses_of(part, plain) == ()


def test_a_moved_part_has_the_same_bosses(parts):
    part = parts["bosses"]
    c, s = np.cos(0.7), np.sin(0.7)
    move = np.array([[c, 0, s, 10], [0, 1, 0, -5], [-s, 0, c, 3], [0, 0, 0, 1.0]])
    before, after = (bosses_of(p, main_face(p)) for p in (part, part.transformed(move)))
    assert [boss.faces for boss in before] == [boss.faces for boss in after]
    assert [boss.height for boss in before] == pytest.approx([boss.height for boss in after])
