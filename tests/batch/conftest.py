"""Small jobs of a batch, and what their folders hold."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.hand import descendants


def dome(height: float) -> ta.Face:
    """A convex patch of 12 x 8 mm."""
    x, y = np.meshgrid(np.linspace(0, 12, 6), np.linspace(0, 8, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, -height * ((x - 6) ** 2 + (y - 4) ** 2) / 60], axis=-1))


@pytest.fixture(scope="session")
def domes() -> Callable[[int], list[dict[str, Any]]]:
    """So many different jobs of a batch that each take less than a second."""
    def made(count: int) -> list[dict[str, Any]]:
        return [{"name": f"dome-{k:03}", "part": dome(1 + 0.01 * k), "tool": "ball:8", "scallop": 0.2,
                 "method": "normal"} for k in range(count)]

    return made


@pytest.fixture
def contents() -> Callable[[Path], dict[str, bytes]]:
    """All files in the folders of a batch's jobs, by their place."""
    return lambda folder: {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.glob("*/*"))}


@pytest.fixture
def started() -> Callable[[], list[int]]:
    """Processes that this one has started since the test began: others, such as another test's tracker, stay."""
    before = set(descendants(os.getpid()))
    return lambda: [number for number in descendants(os.getpid()) if number not in before]
