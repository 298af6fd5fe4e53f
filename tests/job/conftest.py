"""A small face whose plan takes a second, and that plan, made once."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.plan.plan import Plan


def sheet(height: float = 1.0) -> ta.Face:
    """A wavy patch of 24 x 16 mm."""
    x, y = np.meshgrid(np.linspace(0, 24, 6), np.linspace(0, 16, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, height * np.sin(x / 9) * np.cos(y / 8)], axis=-1))


TOOL = "torus:12x1"


@pytest.fixture(scope="session")
def small_plan() -> Plan:
    """The plan of the wavy patch with a coarse scallop."""
    return ta.plan(sheet(), ta.Tool.torus(diameter=12, corner_radius=1, stickout=50, holder=[(10, 0), (10, 40)]), 0.1)


@pytest.fixture
def folder(small_plan: Plan, tmp_path: Path) -> Path:
    """The written form of that plan."""
    from toolaxis.job.files.plan_folder import stage_folder, write_plan

    with stage_folder(tmp_path / "plan") as stage:
        write_plan(small_plan, stage.folder)
        stage.publish()
    return tmp_path / "plan"


@pytest.fixture
def sheet_file(tmp_path: Path) -> str:
    """A STEP file of a wavy sheet of 26 x 18 mm."""
    cq = pytest.importorskip("cadquery")
    x, y = np.linspace(0, 26, 5), np.linspace(0, 18, 5)
    rows = [[cq.Vector(a, b, np.sin(a / 9) * np.cos(b / 11)) for b in y] for a in x]
    face = cq.Face.makeSplineApprox(rows, tol=1e-3, minDeg=3, maxDeg=3)
    path = str(tmp_path / "sheet.step")
    cq.exporters.export(cq.Workplane(obj=face), path)
    return path
