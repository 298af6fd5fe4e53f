"""A small part with a curved face on top, and its plan."""

import numpy as np
import pytest

import toolaxis as ta

ACROSS = 12.0
RADIUS = 40.0


@pytest.fixture(scope="session")
def quick():
    """Settings with which a face of the part takes a second."""
    return {"tool": "ball:8", "scallop": 0.1, "method": "normal", "workers": 1}


@pytest.fixture(scope="session")
def divided(quick):
    """A plan of a wavy patch in two sub-surfaces, with an axis each."""
    x, y = np.meshgrid(np.linspace(0, 24, 6), np.linspace(0, 12, 6), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, -((x - 9) ** 2) / 40 - (y - 4) ** 2 / 60], axis=-1))
    cut = [face.trimmed([[[a, 0], [b, 0], [b, 1], [a, 1]]], label) for a, b, label in ((0, 0.4, "1a"), (0.4, 1, "1b"))]
    return ta.plan(ta.Part.from_faces(cut), datum=(5.0, 6.0, 7.0), **quick)
