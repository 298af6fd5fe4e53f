"""Contacts from tips: what `place` was given, inside the face and beyond it, with a fixed and with a moving axis."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.contact_from_cl import contacts_of
from toolaxis.contact.placement import place

TOOLS = [ta.Tool.ball(diameter=8), ta.Tool.torus(diameter=12, corner_radius=1), ta.Tool.flat(diameter=10),
         ta.Tool.tapered(diameter=6, corner_radius=2, half_angle_deg=4)]


@pytest.fixture(scope="module")
def wavy():
    x, y = np.meshgrid(np.linspace(0, 60, 8), np.linspace(0, 40, 7), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 4 * np.sin(x / 14) * np.cos(y / 11)], axis=-1))


def axes(count, moving):
    if not moving:
        return np.array([0.3, 0.1, 1.0])
    share = np.linspace(0, 1, count)
    return np.stack([0.3 + 0.3 * share, 0.3 * np.sin(3 * share), np.ones(count)], axis=1)


@pytest.mark.parametrize("moving", [False, True], ids=["fixed", "moving"])
@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.name)
def test_it_undoes_place_on_the_face_and_where_its_surface_goes_on(wavy, tool, moving):
    uv = np.random.default_rng(7).uniform(-0.08, 1.08, (400, 2))
    axis = axes(len(uv), moving)
    found = contacts_of(wavy, tool, place(wavy, tool, uv, axis, 0.2), axis, 0.2)
    assert found.off.max() < 1e-8
    apart = np.linalg.norm(wavy.evaluate(found.uv).point - wavy.evaluate(uv).point, axis=1)
    assert apart.max() < 1e-6
    assert contacts_of(wavy, tool, np.zeros((0, 3)), np.array([0, 0, 1.0])).uv.shape == (0, 2)


def test_how_far_off_a_tip_is_that_was_placed_nowhere_on_the_face_is_told(wavy):
    tool, axis = TOOLS[0], np.array([0, 0, 1.0])
    tip = place(wavy, tool, [[0.5, 0.5]], axis) + 3.0 * wavy.normal([[0.5, 0.5]])
    found = contacts_of(wavy, tool, tip, axis)
    assert found.off == pytest.approx([3.0], abs=1e-6)
    assert found.uv == pytest.approx(np.array([[0.5, 0.5]]), abs=1e-4)
