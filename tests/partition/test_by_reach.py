"""Faces that no axis reaches whole: what one axis reaches is machined, and the rest is told."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.inputs.tool_file import load_tool
from toolaxis.partition.by_reach import divide_by_reach
from toolaxis.search.fixed_axis import task
from toolaxis.shape.face import Face


def grooved(depth: float) -> Face:
    """A patch of 50 x 40 mm with a groove along y near one end, 2 mm wide."""
    x, y = np.meshgrid(np.linspace(0, 50, 101), np.linspace(0, 40, 6), indexing="ij")
    groove = -depth * np.exp(-(((x - 40) / 1.2) ** 2))
    return Face.from_bspline(np.stack([x, y, 1.5 * np.sin(x / 15) + groove], axis=-1))


def vault() -> Face:
    """Three quarters of a tube of 15 mm radius, 40 mm long, its outer side machined."""
    turn, along = np.meshgrid(np.linspace(-2.4, 2.4, 25), np.linspace(0, 40, 5), indexing="ij")
    return Face.from_bspline(np.stack([15 * np.sin(turn), along, 15 * np.cos(turn)], axis=-1), flip=True)


@pytest.mark.parametrize(("face", "tool", "least"), [(grooved(3.0), "torus:8x2", 0.75), (vault(), "ball:8", 0.98)])
def test_pieces_and_rest_add_up(face: Face, tool: str, least: float) -> None:
    found = divide_by_reach(task(face, load_tool(tool), 0.05))
    areas = [face.trimmed(loops).area for loops, _ in found.pieces]
    rest = sum(face.trimmed(loops).area for loops in found.rest)
    assert sum(areas) + rest == pytest.approx(face.area, rel=1e-5)
    assert sum(areas) >= least * face.area and areas == sorted(areas, reverse=True) and found.tried > 0


def test_a_face_with_a_groove_is_machined_beside_it_and_the_groove_is_told() -> None:
    made = ta.plan(grooved(3.0), "torus:8x2", 0.1, workers=1)
    done, rest = [op for op in made.operations if op.done], [op for op in made.operations if not op.done]
    assert made.outcome == "incomplete" and len(done) >= 1 and len(rest) == 1
    assert sum(op.face.area for op in done) > 0.75 * grooved(3.0).area
    assert rest[0].orientation.reasons[0].startswith("none of the") and "mm2" in rest[0].orientation.reasons[0]
    assert any("corner radius 2 mm gouges" in why for why in rest[0].orientation.reasons)
    verdict = ta.verify(replace(made, operations=tuple(done)))
    assert verdict.passed, verdict.reasons


def test_a_body_is_machined_from_several_sides() -> None:
    made = ta.plan(vault(), "ball:8", 0.2, workers=1)
    assert made.outcome == "complete" and 2 <= len(made.operations) <= 4
    assert sum(op.face.area for op in made.operations) == pytest.approx(vault().area, rel=1e-4)
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons
    again = ta.plan(vault(), "ball:8", 0.2, workers=2)
    for one, other in zip(made.operations, again.operations, strict=True):
        assert one.path is not None and other.path is not None and np.array_equal(one.path.cl, other.path.cl)
        assert all(map(np.array_equal, one.face.trims, other.face.trims))


def test_nobody_is_asked_where_the_division_is_given() -> None:
    made = ta.plan(vault(), "ball:8", 0.2, regions=1, workers=1)
    assert made.outcome == "incomplete" and len(made.operations) == 1
