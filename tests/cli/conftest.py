"""A small STEP sheet for the command."""

from pathlib import Path

import numpy as np
import pytest


@pytest.fixture(scope="session")
def sheet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A STEP file with three wavy faces of 24 x 18 mm."""
    cadquery = pytest.importorskip("cadquery")
    path = tmp_path_factory.mktemp("step") / "sheets.step"
    x, y = np.linspace(0, 24, 5), np.linspace(0, 18, 5)
    faces = []
    for k in range(3):
        rows = [[cadquery.Vector(a + 60 * k, b, (1 + 0.3 * k) * np.sin(a / 9) * np.cos(b / 11)) for b in y] for a in x]
        faces.append(cadquery.Face.makeSplineApprox(rows, tol=1e-3, minDeg=3, maxDeg=3))
    cadquery.exporters.export(cadquery.Workplane(obj=cadquery.Compound.makeCompound(faces)), str(path))
    return path
