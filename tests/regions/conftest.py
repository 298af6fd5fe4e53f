"""Tools and parts for screening."""

from types import SimpleNamespace

import numpy as np
import pytest

from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

HOLDER = [(9.0, 0.0), (9.0, 40.0), (24.0, 40.0), (24.0, 80.0)]


def rack() -> list[Tool]:
    """Eight tools of all kinds with their holders."""
    body = {"stickout": 45.0, "holder": HOLDER}
    slim = {"stickout": 30.0, "flute_length": 4.0, "shank": [(0.9, 4.0), (0.9, 12.0), (3.0, 16.0), (3.0, 30.0)],
            "holder": HOLDER}
    return [Tool.ball(2, **slim), Tool.ball(4, **body), Tool.ball(8, **body), Tool.torus(6, 0.5, **body),
            Tool.torus(10, 1, **body), Tool.torus(16, 2, **body), Tool.flat(8, **body), Tool.tapered(4, 2, 4, **body)]


def plate(corners: list[list[float]], **more: object) -> Face:
    """A flat face from the corners at (0, 0), (0, 1), (1, 0) and (1, 1), its normal Su x Sv."""
    return Face.from_bspline(np.array(corners, dtype=float).reshape(2, 2, 3), (1, 1), **more)


def pocket(depth: float = 18.0) -> Part:
    """A wavy floor of 50 x 36 mm inside four walls, and the land around them."""
    x, y = np.meshgrid(np.linspace(0, 50, 9), np.linspace(0, 36, 7), indexing="ij")
    floor = Face.from_bspline(np.stack([x, y, 2 * np.sin(x / 9) * np.cos(y / 11)], axis=-1))
    low, top = -6.0, depth
    walls = [plate([[0, 0, low], [0, 0, top], [0, 36, low], [0, 36, top]]),
             plate([[50, 0, low], [50, 36, low], [50, 0, top], [50, 36, top]]),
             plate([[0, 0, low], [50, 0, low], [0, 0, top], [50, 0, top]]),
             plate([[0, 36, low], [0, 36, top], [50, 36, low], [50, 36, top]])]
    land = plate([[-30, -30, top], [-30, 66, top], [80, -30, top], [80, 66, top]])
    hole = np.array([[30 / 110, 30 / 96], [30 / 110, 66 / 96], [80 / 110, 66 / 96], [80 / 110, 30 / 96]])
    frame = Face(land.surface, (np.array([[0.0, 0.0], [1, 0], [1, 1], [0, 1]]), hole))
    return Part.from_faces([floor, *walls, frame])


@pytest.fixture(scope="session")
def scenes() -> SimpleNamespace:
    """What the tests of this folder build."""
    return SimpleNamespace(rack=rack, plate=plate, pocket=pocket)
