"""What screens take of a surface: the kernel against its plain twin, and places where it has none."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.strip.second_order import _fill_forms, _forms_plainly, contact_forms
from toolaxis.errors import InvalidInput
from toolaxis.path.width_correction import lean_ratios, lean_ratios_of, lean_table

UV = np.random.default_rng(7).random((200, 2))


def patch(pole: bool) -> ta.Face:
    """A wavy patch, which begins in a point with a pole."""
    net = np.random.default_rng(8).random((5, 5, 3)) * 0.4 + np.stack(
        [*np.meshgrid(np.arange(5.0), np.arange(5.0), indexing="ij"), np.zeros((5, 5))], axis=-1)
    if pole:
        net[:, 0] = net[0, 0]
    return ta.Face.from_bspline(net, flip=pole)


@pytest.mark.parametrize("feed", ["u", "v"])
@pytest.mark.parametrize("pole", [False, True])
def test_the_kernel_fills_in_what_its_plain_twin_does(feed: str, pole: bool) -> None:
    face = patch(pole)
    uv = UV * [1.0, 0.9] + [0.0, 0.1]
    for steps in (False, True):
        plain = _forms_plainly(face, uv, face.evaluate(uv), feed, steps)
        forms, left = np.empty((len(uv), 13)), np.empty(len(uv), dtype=bool)
        _fill_forms(face.evaluate(uv), -1.0 if face.flip else 1.0, feed == "u", steps, forms, left)
        assert not left.any() and np.abs(forms - plain).max() < 1e-9
        assert np.abs(contact_forms(face, uv, feed, steps) - plain).max() < 1e-9


def test_at_a_pole_the_plain_twin_takes_over() -> None:
    face, uv = patch(True), np.column_stack([UV[:, 0], np.where(UV[:, 1] > 0.5, 0.0, UV[:, 1])])
    assert np.abs(contact_forms(face, uv, "v", True) - _forms_plainly(face, uv, face.evaluate(uv), "v", True)
                  ).max() < 1e-9
    with pytest.raises(InvalidInput, match="it must be 'u', 'v' or a vector"):
        contact_forms(face, uv, "w", False)


def test_ratios_of_rows_are_those_of_their_leans() -> None:
    table, face = lean_table(ta.Tool.torus(10, 1), 0.02), patch(False)
    forms, axis = contact_forms(face, UV, "u", True), np.array([0.3, -0.2, np.sqrt(0.87)])
    expected = lean_ratios(table, forms[:, :3] @ axis, forms[:, 3:6] @ axis)
    assert np.abs(lean_ratios_of(table, forms, axis) - expected).max() < 1e-12
