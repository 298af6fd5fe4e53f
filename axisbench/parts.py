"""The whole parts of the benchmark, made with CadQuery and written as STEP: the same bytes every time.

Parts are small, so that a plan with a rack takes about a minute.  Lengths are mm.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import cadquery as cq
import numpy as np
from examples.block import block, settled, write_step


def _parabola(half: float) -> np.ndarray:
    """Bezier coefficients of t^2 over [-half, half]."""
    return np.array([half**2, -(half**2), half**2])


def _solid(points: np.ndarray, degree: tuple[int, int]) -> Any:
    """A block below a B-spline top, down to z = 0."""
    return cq.Workplane(obj=cq.Shape.cast(block(points, degree, 0.0)))


def build_mould() -> Any:
    """A saddle mould: a saddle over a block, 60 x 44 mm."""
    x, y = np.meshgrid([-30.0, 0.0, 30.0], [-22.0, 0.0, 22.0], indexing="ij")
    height = 20 + _parabola(30)[:, None] / 150 - _parabola(22)[None, :] / 120
    return _solid(np.stack([x, y, height], axis=-1), (2, 2))


def build_tray() -> Any:
    """A hollow tray with a twist, 56 x 40 mm."""
    x, y = np.meshgrid([-28.0, 0.0, 28.0], [-20.0, 0.0, 20.0], indexing="ij")
    height = 14 + _parabola(28)[:, None] / 170 + _parabola(20)[None, :] / 130 - x * y / 260
    return _solid(np.stack([x, y, height], axis=-1), (2, 2))


def build_cover() -> Any:
    """A bulged cover, 60 x 50 mm, with a round boss that leans on nothing: a wall of 90 degrees around its foot."""
    x, y = np.meshgrid([-30.0, -10.0, 10.0, 30.0], [-25.0, -8.0, 8.0, 25.0], indexing="ij")
    points = np.stack([x, y, 20 - x * x / 150 - y * y / 220], axis=-1)
    return _solid(points, (3, 3)).union(cq.Workplane().workplane(offset=5).circle(8).extrude(23))


def build_pocket() -> Any:
    """A block with a pocket, 44 x 30 x 10 mm, of which corners and foot are rounded."""
    body = cq.Workplane().box(60, 46, 24).translate((0, 0, 12))
    hollow = cq.Workplane().workplane(offset=14).rect(44, 30).extrude(20)
    return body.cut(hollow.edges("|Z").fillet(9).edges("<Z").fillet(4))


def build_dome() -> Any:
    """A dome of radius 26 mm on a plate, cut off by it at 60 degrees of latitude, without a fillet."""
    plate = cq.Workplane().box(50, 50, 12).translate((0, 0, 6))
    above = cq.Workplane().workplane(offset=12).rect(100, 100).extrude(60)
    ball = cq.Workplane().sphere(26).translate((0, 0, -2))
    return plate.union(ball.intersect(above))


def build_channel() -> Any:
    """A quarter of a round channel of radius 8 mm, bent at 34 mm, in a block."""
    body = cq.Workplane().box(60, 60, 20).translate((0, 0, 10))
    ring = cq.Workplane("XZ").moveTo(34, 20).circle(8).revolve(360, (0, 0, 0), (0, 1, 0))
    return body.cut(ring.translate((-30, -30, 0)))


def build_bottle() -> Any:
    """Half a bottle as a cavity in a block, 40 x 70 mm."""
    body = cq.Workplane().box(44, 70, 22).translate((0, 0, -11))
    outline = cq.Workplane("XY").moveTo(0, -30).lineTo(13, -30).threePointArc((15, -5), (9, 14)).lineTo(9, 35)
    return body.cut(outline.lineTo(0, 35).close().revolve(360, (0, 0, 0), (0, 1, 0)))


def build_blade() -> Any:
    """A twisted blade that stands alone on a platform: sections 30 mm apart, turned by 15 degrees."""
    foot = cq.Workplane().box(48, 34, 10).translate((0, 0, 5))
    skin = cq.Workplane().workplane(offset=10).spline(_section(15.0, 0.0), periodic=True).close()
    skin = skin.workplane(offset=24).spline(_section(12.0, 15.0), periodic=True).close().loft(combine=True)
    return foot.union(skin)


def _section(half_chord: float, twist: float) -> list[tuple[float, float]]:
    """Points of an oval section with a camber, turned by degrees."""
    turn, angle = np.linspace(0, 2 * np.pi, 24, endpoint=False), np.radians(twist)
    x = half_chord * np.cos(turn)
    y = 0.3 * half_chord * np.sin(turn) + 0.1 * half_chord * np.sin(turn) ** 2
    return [(float(a * np.cos(angle) - b * np.sin(angle)), float(a * np.sin(angle) + b * np.cos(angle)))
            for a, b in zip(x, y, strict=True)]


#: The parts by name, in the order of the tables.
PARTS: dict[str, Callable[[], Any]] = {
    "mould": build_mould, "tray": build_tray, "cover": build_cover, "pocket": build_pocket, "dome": build_dome,
    "channel": build_channel, "bottle": build_bottle, "blade": build_blade}


def write_part(name: str, shape: Any, folder: Path) -> Path:
    """Write a part as STEP; its path.

    Parameters
    ----------
    name : str
    shape : Workplane
    folder : Path
    """
    return write_step(name, settled(shape.val().wrapped), folder)
