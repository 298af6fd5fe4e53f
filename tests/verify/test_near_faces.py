"""Which faces a cutter may come to: told by boxes that hold all of both."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.numeric.vectors import unit
from toolaxis.verify.near_faces import SweptBoxes, _net


def wavy(seed: int, rational: bool = True) -> ta.Face:
    """A bicubic patch with inner knots and weights."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 40, 9), np.linspace(0, 30, 7), indexing="ij")
    weights = rng.uniform(0.4, 2.5, x.shape) if rational else None
    return ta.Face.from_bspline(np.dstack([x, y, rng.uniform(-6, 6, x.shape)]), weights=weights)


def corners_of(face: ta.Face) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the box around the control points that count."""
    net = _net(face)
    assert net is not None
    return net.min(axis=0), net.max(axis=0)


@pytest.mark.parametrize("seed", range(6))
def test_the_hull_holds_every_point_of_a_piece(seed: int) -> None:
    face = wavy(seed)
    rng = np.random.default_rng(100 + seed)
    low, high = np.sort(rng.uniform(0, 1, (2, 2)), axis=0)
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    piece = face.trimmed((corners,))
    box = corners_of(piece)
    points = face.evaluate(low + (high - low) * rng.uniform(0, 1, (4000, 2))).point
    assert (points >= box[0] - 1e-9).all() and (points <= box[1] + 1e-9).all()
    whole = corners_of(face)
    assert np.prod(box[1] - box[0]) <= np.prod(whole[1] - whole[0]), "no larger than that of the whole face"


def test_a_small_piece_has_a_small_box() -> None:
    corners = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]])
    low, high = corners_of(wavy(3, rational=False).trimmed((corners,)))
    assert (high - low)[0] < 25 and (high - low)[1] < 25


def test_a_face_beyond_its_surface_may_be_anywhere() -> None:
    corners = np.array([[-0.1, 0.0], [0.5, 0.0], [0.5, 0.5], [-0.1, 0.5]])
    assert _net(wavy(1).trimmed((corners,))) is None


@pytest.mark.parametrize("tool", [ta.Tool.ball(6), ta.Tool.torus(12, 2), ta.Tool.tapered(8, 3, 5)],
                         ids=["ball", "torus", "tapered"])
def test_the_box_holds_the_cutter_on_every_motion(tool: ta.Tool) -> None:
    """Points of the cutter's own outline, turned about the axis, at places between locations."""
    rng = np.random.default_rng(7)
    tips = rng.uniform(-20, 20, (40, 3))
    axes = unit(rng.normal(size=(40, 3)) + np.array([0.0, 0.0, 2.0]))
    boxes = SweptBoxes(tips, axes, tool.profile)
    profile = tool.profile
    heights = np.linspace(0, profile.top, 12)
    for k in range(39):
        for share in (0.0, 0.3, 0.5, 0.8, 1.0):
            axis = unit(((1 - share) * axes[k] + share * axes[k + 1])[None])[0]
            tip = (1 - share) * tips[k] + share * tips[k + 1]
            across = unit(np.cross(axis, [0.3, 0.8, -0.5])[None])[0]
            other = np.cross(axis, across)
            turn = np.linspace(0, 2 * np.pi, 16)[:, None]
            for z, radius in zip(heights, profile.radius_at(heights), strict=True):
                ring = (tip + z * axis + radius * (np.cos(turn) * across + np.sin(turn) * other)) @ boxes.frame
                assert (ring >= boxes.low[k // 16]).all() and (ring <= boxes.high[k // 16]).all()
    reach = 2 * (profile.top + 1.5 * profile.top_radius + profile.flat_radius + 6)
    assert (boxes.high - boxes.low < 70 + reach).all(), "a way of 40 mm each way, seen aslant"


def test_boxes_stand_along_the_tool() -> None:
    """A ball end of 6 mm along a slanting line under one axis: no box is wider than the tool across its motions."""
    tips = np.linspace([0.0, 0.0, 0.0], [40.0, 0.0, 0.0], 81)
    tool = ta.Tool.ball(6)
    axis = unit(np.array([[0.0, 1.0, 1.0]]))
    boxes = SweptBoxes(tips, np.repeat(axis, 81, axis=0), tool.profile)
    sizes = np.sort(boxes.high - boxes.low, axis=1)
    assert len(sizes) == 5 and (sizes[:, 0] < 6.001).all() and (sizes[:, 1] < 14.01).all()


def test_a_face_within_some_room_counts() -> None:
    """A ball end of 10 mm that stands up: 5 mm beside its tip, and as high as its edge."""
    tool = ta.Tool.ball(10)
    box = SweptBoxes(np.array([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]] * 2), tool.profile)

    def wall(x: float) -> ta.Face:
        return ta.Face.from_bspline(np.array([[[x, -5.0, 0.0], [x, -5.0, 20.0]], [[x, 5.0, 0.0], [x, 5.0, 20.0]]]),
                                    degree=(1, 1))

    assert box.may_come_to(wall(35.9), 1.0) and not box.may_come_to(wall(36.1), 1.0)
    assert box.may_come_to(wall(-5.9), 1.0) and not box.may_come_to(wall(-6.1), 1.0)
