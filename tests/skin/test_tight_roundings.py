"""Skins with roundings much tighter than the grid of what stands for them: the passes leave nothing all the same."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.path.rest_material import FACTOR, OVERLOOKED, Excess
from toolaxis.skin.find import find_skins

SCALLOP, LENGTH = 0.005, 110.0


def arc(start: np.ndarray, radius: float, angles: tuple[float, float]) -> np.ndarray:
    """Control points (x, z) of the cubic nearest to an arc; its way leans by the angles at both ends."""
    first, last = (np.array([np.cos(angle), np.sin(angle)]) for angle in angles)
    turn = abs(angles[1] - angles[0])
    pull = radius * 4 / 3 * np.tan(turn / 4)
    end = start + radius * np.tan(turn / 2) * (first + last)
    return np.array([start, start + pull * first, end - pull * last, end])


def ridge(radius: float, turn: float) -> list[np.ndarray]:
    """A rising line, a rounding, a falling line, a hollow twice as wide, a rising line."""
    up, down = (np.array([np.cos(turn / 2), sign * np.sin(turn / 2)]) for sign in (1, -1))
    pieces = [np.linspace(np.zeros(2), 1.2 * up, 4)]
    for size, angles, way in ((radius, (turn / 2, -turn / 2), down), (2 * radius, (-turn / 2, turn / 2), up)):
        pieces.append(arc(pieces[-1][-1], size, angles))
        pieces.append(np.linspace(pieces[-1][-1], pieces[-1][-1] + 1.2 * way, 4))
    return pieces


def edge(radius: float, turn: float) -> list[np.ndarray]:
    """A rounding of an edge in two halves, and nothing beside it."""
    first = arc(np.zeros(2), radius, (turn / 2, 0.0))
    return [first, arc(first[-1], radius, (0.0, -turn / 2))]


def drawn(pieces: list[np.ndarray], lean: float) -> ta.Part:
    """A profile drawn along a gentle wave in y, leaned to one side."""
    y = np.linspace(0, LENGTH, 9)
    turned = np.array([[np.cos(lean), -np.sin(lean)], [np.sin(lean), np.cos(lean)]])
    faces = []
    for piece in pieces:
        control = np.empty((len(piece), len(y), 3))
        control[..., [0, 2]] = (piece @ turned.T)[:, None]
        control[..., 1] = y
        control[..., 2] += 0.8 * np.sin(y / 15)
        faces.append(ta.Face.from_bspline(control))
    return ta.Part.from_faces(faces)


@pytest.mark.parametrize(("part", "tool"), [
    (drawn(ridge(1.7, 1.2), 0.2), "ball:6"), (drawn(edge(1.0, 2.0), 0.0), "torus:12x1")], ids=["ridge", "edge"])
def test_next_to_nothing_stays_between_passes(part: ta.Part, tool: str) -> None:
    assert find_skins(part).joined == (tuple(face.number for face in part.faces),)
    made = ta.plan(part, tool, SCALLOP, faces="skins", workers=1)
    op = made.operations[0]
    assert made.outcome == "complete", op.orientation.reasons
    within = op.face.grid(1500, 1000)
    d = op.face.evaluate(within)
    weight = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    high = Excess(op.face, op.tool, op.path, FACTOR * SCALLOP)(within) > 0
    for zone in op.zones:
        high &= ~op.face.trimmed(zone.loops).contains(within)
    assert weight[high].sum() < 2 * OVERLOOKED * weight.sum()
    assert ta.verify(made).passed
