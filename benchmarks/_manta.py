"""Passes of a ball over the Manta surface of grandguillaume2021."""

import json
from pathlib import Path

import numpy as np

from toolaxis.search.kinematic_setup import PassSegment
from toolaxis.shape.face import Face

_POINTS = Path(__file__).parents[1] / "examples" / "manta.json"
#: Of the ball, mm.
_RADIUS = 8.0


def manta_passes(count: int, points: int = 200) -> tuple[PassSegment, ...]:
    """Centres of the ball along y, there and back, evenly over the surface."""
    face = Face.from_bspline(np.array(json.loads(_POINTS.read_text())["points"]), degree=(3, 3))
    found = []
    for k in range(count):
        v = np.linspace(0, 1, points)[:: 1 if k % 2 == 0 else -1]
        uv = np.column_stack([np.full(points, (k + 0.5) / count), v])
        normals = face.normal(uv)
        found.append(PassSegment(face.evaluate(uv).point + _RADIUS * normals, normals))
    return tuple(found)
