"""Real parts for the adapters, and the kernel's own answers about them."""

import importlib.util
import os
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
collect_ignore = [] if find_spec("OCP") else ["test_surfaces.py", "test_kernel_agreement.py"]


def shared_files():
    """STEP files that are not part of the project, by name; empty where there are none."""
    folder = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
    return sorted(path for path in folder.glob("*.st*p"))


def pytest_generate_tests(metafunc):
    if "shared_part" in metafunc.fixturenames:
        parts = shared_files()
        reason = "no shared parts: set TOOLAXIS_SHARED to the folder that has parts/*.step"
        missing = [pytest.param(None, marks=pytest.mark.skip(reason=reason), id="absent")]
        metafunc.parametrize("shared_part", [pytest.param(p, id=p.stem) for p in parts] or missing, scope="module")


@pytest.fixture(scope="session")
def contract():
    """The checks that every adapter has to pass, shared with the FreeCAD tests."""
    spec = importlib.util.spec_from_file_location("contract", Path(__file__).with_name("contract.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def write_step():
    """Write a kernel shape to a STEP file in mm."""
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

    def write(shape, path):
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))
        return path

    return write


@pytest.fixture(scope="session")
def block_shape():
    """A block 40 x 30 x 20 mm standing on z = 0 with a through hole of radius 5, by the bare kernel."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.TopAbs import TopAbs_SOLID
    from OCP.TopExp import TopExp_Explorer

    block = BRepPrimAPI_MakeBox(gp_Pnt(-20, -15, 0), 40.0, 30.0, 20.0).Shape()
    hole = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -5), gp_Dir(0, 0, 1)), 5.0, 30.0).Shape()
    return TopExp_Explorer(BRepAlgoAPI_Cut(block, hole).Shape(), TopAbs_SOLID).Current()


@pytest.fixture(scope="module")
def kernel_shape(shared_part):
    """The part as the kernel itself reads it."""
    from toolaxis.cad.transfer import read_shape

    return read_shape(str(shared_part))[0]


@pytest.fixture(scope="module")
def kernel_record(kernel_shape):
    """The part as our plain records."""
    from toolaxis.cad.ocp import shape_record

    return shape_record(kernel_shape)
