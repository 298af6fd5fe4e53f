"""Found: plain misuse ended in errors of numpy, or went on: a face number of 1.5, loops off the surface, no area."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput

_NET = np.array([[[x, y, 0.02 * x * y] for y in (0, 5, 10, 15)] for x in (0, 6, 12, 18)], dtype=float)
_RING = np.array([[0.2, 0.2], [0.4, 0.2], [0.4, 0.4], [0.2, 0.4]])


@pytest.mark.parametrize("given, says", [
    ({"degree": 3}, "degrees are 3"),
    ({"knots": [0, 0, 0, 0, 1, 1, 1, 1]}, "knots are"),
    ({"trims": [10 * _RING]}, "leaves the surface at"),
    ({"trims": [_RING, _RING + 0.3]}, "no hole"),
    ({"points": np.where(_NET > 14, np.nan, _NET)}, r"control point \[0, 3\]"),
    ({"points": [[1, 2], [3]]}, "no array"),
])
def test_from_bspline_refuses_in_one_sentence(given, says):
    with pytest.raises(InvalidInput, match=says):
        ta.Face.from_bspline(**{"points": _NET, **given})


@pytest.mark.parametrize("given, says", [
    ({"faces": [1.5]}, "face 1.5"), ({"faces": 2}, "face 2 does not exist"), ({"faces": iter(())}, "empty"),
    ({"faces": [ta.Face]}, "whole numbers"), ({"tool": 12}, "tools are 12"),
    ({"tolerance": "fine"}, "machining tolerance is 'fine'"), ({"tolerance": 1.0}, "machining tolerance is 1.0 mm"),
])
def test_plan_refuses_in_one_sentence(given, says):
    with pytest.raises(InvalidInput, match=says):
        ta.plan(**{"part": ta.Face.from_bspline(_NET), "tool": "ball:6", "scallop": 0.1, **given})


def test_a_face_without_area_has_no_axis_and_says_why():
    made = ta.plan(ta.Face.from_bspline(np.zeros((4, 4, 3))), "ball:6", 0.1)
    assert made.outcome == "incomplete"
    assert "no area" in made.operations[0].orientation.reasons[0]


def test_verify_takes_plans():
    with pytest.raises(InvalidInput, match="not a str"):
        ta.verify("out/demo")
