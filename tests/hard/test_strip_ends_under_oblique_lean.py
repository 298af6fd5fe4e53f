"""Passes ended too early where the axis leans across the feed: corners kept more than the scallop height."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.verify.material_removal import removal
from toolaxis.verify.rays import face_rays


@pytest.mark.parametrize("lean_deg, turn_deg", [(0.6, 30.0), (4.0, 28.0), (10.0, -60.0), (30.0, 100.0)])
@pytest.mark.parametrize("feed", ["u", "v"])
def test_every_point_of_a_plane_is_cut_up_to_its_corners(lean_deg, turn_deg, feed):
    face = ta.Face.from_bspline([[[0, 0, 0], [0, 16, 0]], [[24, 0, 0], [24, 16, 0]]], degree=(1, 1))
    tool, scallop = ta.Tool.torus(diameter=12, corner_radius=1), 0.1
    lean, turn = np.radians([lean_deg, turn_deg])
    axis = np.array([np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)])
    path = ta.passes(face, tool, axis, scallop, feed)
    rays = face_rays(face, 0.4)
    left = removal((path.cl, path.axis, path.kind), tool.profile, (rays.point, rays.normal), height=1.0)
    assert left.remaining.max() <= 1.02 * scallop
    assert left.gouge.max() <= 0.002
