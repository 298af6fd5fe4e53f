"""Found: `place` took an axis of another length than 1, or of none, as it came, and gave a wrong tip without a word."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput

_TOOL = ta.Tool.torus(diameter=12, corner_radius=2)
_UV = np.array([[0.3, 0.4], [0.6, 0.7], [0.5, 0.5]])


def _face() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 60, 5), np.linspace(0, 50, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0.01 * (x - 30) * (y - 25)], axis=-1))


def test_the_length_of_an_axis_does_not_matter() -> None:
    face, axis = _face(), np.array([0.2, 0.1, 1.0])
    unit = axis / np.linalg.norm(axis)
    shift = np.eye(4)
    shift[1, 3] = 60
    obstacle = [face.transformed(shift)]
    for ask in (lambda t: ta.place(face, _TOOL, _UV, t), lambda t: ta.strip_width(face, _TOOL, _UV, t, 0.05),
                lambda t: ta.gouge(face, _TOOL, _UV, t), lambda t: ta.clearance(face, _TOOL, _UV, t, obstacle)):
        for other in (axis, 7 * axis, [3 * axis, axis, 0.1 * axis]):
            assert ask(other) == pytest.approx(ask(unit), abs=1e-9)


@pytest.mark.parametrize("axis", [[0, 0, 0], [0, np.nan, 1], [0, 1], "z", [[0, 0, 1], [0, 1, 1]], [0, 0, 1e-300]])
def test_what_is_no_axis_is_refused(axis: object) -> None:
    face = _face()
    for ask in (lambda: ta.place(face, _TOOL, _UV, axis), lambda: ta.strip_width(face, _TOOL, _UV, axis, 0.05),
                lambda: ta.gouge(face, _TOOL, _UV, axis), lambda: ta.clearance(face, _TOOL, _UV, axis, None)):
        with pytest.raises(InvalidInput):
            ask()


@pytest.mark.parametrize("uv", [[[0.1, 0.2, 0.3]], [[np.nan, 0.5]], "uv"])
def test_what_are_no_parameters_is_refused(uv: object) -> None:
    with pytest.raises(InvalidInput, match="uv"):
        ta.place(_face(), _TOOL, uv, [0, 0, 1])
