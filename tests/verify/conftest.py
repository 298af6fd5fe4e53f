"""Cutter locations made by hand, for the judge to judge; the third judge lies beside them, in `third.py`."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parent))

CUT, LINK = 0, 3


def _place(point, normal, axis, sizes):
    """Tool tips for a cutter (radius, corner radius) that touches points; every row on its own."""
    radius, corner = sizes
    across = normal - np.sum(normal * axis, axis=-1, keepdims=True) * axis
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    across = np.where(length > 1e-9, across / np.maximum(length, 1e-9), 0.0)
    return point + corner * normal + (radius - corner) * across - corner * axis


def _plane_passes(sizes, lead, offsets, span=(-20.0, 20.0), step=0.5):
    """Zigzag passes along x over the plane z = 0; links lift along the axis by 10 mm."""
    axis = np.array([np.sin(lead), 0.0, np.cos(lead)])
    tips, kind = [], []
    for number, y in enumerate(offsets):
        x = np.arange(span[0], span[1] + 1e-9, step)
        x = x[::-1] if number % 2 else x
        tip = _place(np.column_stack([x, np.full_like(x, y), 0 * x]), np.array([0.0, 0.0, 1.0]), axis, sizes)
        lift = 10.0 * axis
        tips += [tip[:1] + lift, tip, tip[-1:] + lift]
        kind += [LINK, LINK, *[CUT] * (len(tip) - 1), LINK]
    rows = np.vstack(tips)
    return rows, np.tile(axis, (len(rows), 1)), np.array(kind, dtype=np.int8)


def _still(tip, axis):
    """A cutter that stands in one place."""
    return np.atleast_2d(tip), np.atleast_2d(axis), np.zeros(1, dtype=np.int8)


@pytest.fixture(scope="session")
def place() -> Callable:
    return _place


@pytest.fixture(scope="session")
def plane_passes() -> Callable:
    return _plane_passes


@pytest.fixture(scope="session")
def still() -> Callable:
    return _still
