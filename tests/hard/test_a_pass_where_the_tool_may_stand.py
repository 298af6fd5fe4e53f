"""Found: the only pass of a steep face was put beyond what the tool could reach, was cut out whole, and the empty path
counted as found until its proof broke off with an IndexError."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.path.iso_parametric import layout

SCALLOP = 0.02
TOOL = ta.Tool.ball(8)


def steep(lean: float) -> ta.Face:
    """A wall of 20 x 2 mm that leans a little: u runs along it, v up."""
    x, z = np.meshgrid(np.linspace(0, 20, 5), np.linspace(0, 2, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, lean * z, z], axis=-1))


@pytest.mark.parametrize("low, high", [(0.45, 1.0), (0.0, 0.5), (0.6, 0.7)])
def test_the_only_pass_lies_where_the_tool_may_stand(low: float, high: float) -> None:
    """The shank of the ball covers all of the wall above a contact: a strip that is many times as wide on that side."""
    for axis in ([0, 0, 1.0], [0, 0, -1.0]):
        placed = layout(steep(0.002 * axis[2]), TOOL, axis, SCALLOP, "u",
                        reach=lambda uv: (uv[:, 1] >= low) & (uv[:, 1] <= high))
        assert len(placed.steps) == 1 and low <= placed.steps[0] <= high
        assert len(placed.pieces) == 1


def test_an_axis_that_leaves_no_pass_is_refused_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = np.meshgrid(np.linspace(0, 12, 4), np.linspace(0, 8, 4), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.1 * np.sin(x / 4)], axis=-1))
    monkeypatch.setattr(Feasibility, "reach", lambda self, uv, axis: np.zeros(len(uv), dtype=bool))
    found = ta.best_axis(face, TOOL, 0.3, machine="cone:0,0,1,5")
    assert found.axis is None and found.outcome == "not_found"
    assert "no pass is left on face 1" in found.reasons[0] and "--regions" in found.reasons[0]
