"""Contact frame: handedness, lead and tilt, and their inverse."""

import numpy as np
import pytest

from toolaxis.contact.frame import (
    axis_from_lead_tilt,
    axis_from_lean,
    contact_frame,
    frame_from_normal,
    lead_tilt_from_axis,
)
from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face

FLAT = [[[0, 0, 0], [0, 30, 0]], [[20, 0, 0], [20, 30, 0]]]


def wavy(flip=False):
    rng = np.random.default_rng(4)
    xy = np.stack(np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 50, 5), indexing="ij"), -1)
    return Face.from_bspline(np.concatenate([xy, rng.normal(size=(5, 5, 1)) * 4], -1), flip=flip)


@pytest.mark.parametrize("feed, flip, x, y, z", [
    ("u", False, [1, 0, 0], [0, 1, 0], [0, 0, 1]), ("v", False, [0, 1, 0], [-1, 0, 0], [0, 0, 1]),
    ("u", True, [1, 0, 0], [0, -1, 0], [0, 0, -1]), ([3.0, 3.0, 7.0], False, [2**-0.5, 2**-0.5, 0],
                                                     [-(2**-0.5), 2**-0.5, 0], [0, 0, 1])])
def test_frame_of_a_plane(feed, flip, x, y, z):
    frame = contact_frame(Face.from_bspline(FLAT, degree=(1, 1), flip=flip), [[0.3, 0.4]], feed)
    assert np.allclose([frame.feed[0], frame.left[0], frame.normal[0]], [x, y, z], atol=1e-15)


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("feed", ["u", "v", (1.0, -2.0, 0.5)])
def test_frames_are_right_handed_and_left_is_left(feed, flip):
    face, uv = wavy(flip), np.random.default_rng(1).uniform(0, 1, (50, 2))
    frame = contact_frame(face, uv, feed)
    triad = np.stack(frame, axis=1)
    assert np.abs(triad @ triad.transpose(0, 2, 1) - np.eye(3)).max() < 1e-14
    assert np.allclose(np.linalg.det(triad), 1.0, atol=1e-14)
    assert np.allclose(np.cross(frame.normal, frame.feed), frame.left, atol=1e-15)


def test_lead_leans_towards_the_feed_and_tilt_to_the_left():
    frame = frame_from_normal([[0, 0, 1]], [1, 0, 0])
    assert np.allclose(axis_from_lead_tilt(frame, np.radians(30), 0.0), [[0.5, 0, 0.75**0.5]], atol=1e-15)
    assert np.allclose(axis_from_lead_tilt(frame, 0.0, np.radians(30)), [[0, 0.5, 0.75**0.5]], atol=1e-15)
    both = axis_from_lead_tilt(frame, np.radians(30), np.radians(60))
    assert np.allclose(both, [[0.5, 0.75, 0.75**0.5 / 2]], atol=1e-15)


def test_lead_and_tilt_come_back():
    rng = np.random.default_rng(2)
    frame = contact_frame(wavy(), rng.uniform(0, 1, (200, 2)), "v")
    lead, tilt = rng.uniform(-1.5, 1.5, 200), rng.uniform(-3.1, 3.1, 200)
    axis = axis_from_lead_tilt(frame, lead, tilt)
    assert np.abs(np.linalg.norm(axis, axis=1) - 1).max() < 1e-15
    back = lead_tilt_from_axis(frame, axis)
    assert np.abs(back[0] - lead).max() < 1e-12 and np.abs(back[1] - tilt).max() < 1e-12


def test_lean_is_the_angle_to_the_normal():
    frame = contact_frame(wavy(), [[0.2, 0.7]], "u")
    for way in np.linspace(0, 6, 7):
        axis = axis_from_lean(frame, 0.3, way)
        assert np.isclose(axis[0] @ frame.normal[0], np.cos(0.3), atol=1e-15)
        assert np.isclose(np.arctan2(axis[0] @ frame.left[0], axis[0] @ frame.feed[0]) % (2 * np.pi), way, atol=1e-12)
    assert np.allclose(axis_from_lean(frame, 0.3, 0.0), axis_from_lead_tilt(frame, 0.3, 0.0), atol=1e-15)


@pytest.mark.parametrize("feed, words", [([0, 0, 1], "tangent plane"), ("w", "'u', 'v' or a vector"),
                                         ([0, 0, np.nan], "finite")])
def test_a_feed_without_direction_is_refused(feed, words):
    with pytest.raises(InvalidInput, match=words):
        contact_frame(Face.from_bspline(FLAT, degree=(1, 1)), [[0.3, 0.4]], feed)
