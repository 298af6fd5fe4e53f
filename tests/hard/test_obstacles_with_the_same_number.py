"""Found: face 1 of a clamp given as a part was taken for the machined face 1: its collision was not seen."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput


def _flat(*rows: list[float]) -> ta.Face:
    p, a, b = np.array(rows, dtype=float)
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def test_a_clamp_is_kept_clear_of_whatever_its_faces_are_numbered() -> None:
    floor, tool = _flat([0, 0, 0], [20, 0, 0], [0, 20, 0]), ta.Tool.ball(diameter=6, stickout=30)
    clamp = ta.load(_flat([11, 0, -1], [0, 0, 5], [0, 20, 0]))
    contact = ([[0.5, 0.5]], [0, 0, 1])
    alone = ta.clearance(floor, tool, *contact, clamp.faces)
    assert alone[0] == pytest.approx(-2, abs=0.2)
    assert ta.clearance(floor, tool, *contact, clamp) == pytest.approx(alone)
    assert ta.clearance(floor, tool, *contact, clamp.faces[0]) == pytest.approx(alone)


def test_a_piece_of_a_face_still_knows_its_part() -> None:
    part, tool = ta.load(_flat([0, 0, 0], [20, 0, 0], [0, 20, 0])), ta.Tool.ball(diameter=6)
    piece = part.faces[0].trimmed(([[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]],), "1a")
    assert ta.clearance(piece, tool, [[0.5, 0.5]], [0, 0, 1], part)[0] > 1


def test_no_obstacles_are_none_and_a_path_is_refused() -> None:
    floor, tool = _flat([0, 0, 0], [20, 0, 0], [0, 20, 0]), ta.Tool.ball(diameter=6)
    assert ta.clearance(floor, tool, [[0.5, 0.5]], [0, 0, 1], None)[0] > 1
    with pytest.raises(InvalidInput, match="sequence of faces"):
        ta.clearance(floor, tool, [[0.5, 0.5]], [0, 0, 1], "clamp.step")
