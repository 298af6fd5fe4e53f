"""Real parts for the adapters, and the kernel's own answers about them."""

import importlib.util
import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
#: Of one family of parts that were made for tests of readers; two others of it are read in a third of the time.
SLOW = ("ctc02", "tm_featuretype")
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
        files = [pytest.param(p, id=p.stem, marks=pytest.mark.long if p.stem in SLOW else ()) for p in parts]
        metafunc.parametrize("shared_part", files or missing, scope="module")


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
    from toolaxis.cad.step.worker import read_shape

    return read_shape(str(shared_part))[0]


@pytest.fixture(scope="module")
def kernel_record(kernel_shape):
    """The part as our plain records."""
    from toolaxis.cad.ocp.reader import shape_record

    return shape_record(kernel_shape)


SERVER = """
import json, os, signal, sys, time
import toolaxis.cad.ocp.reader, toolaxis.cad.step.worker as transfer
for line in sys.stdin:
    given = json.loads(line)
    child = os.fork()
    if child == 0:
        silence = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(silence, stream)
        os._exit(transfer.main(given["arguments"]))
    end, found = time.monotonic() + given["limit"], 0
    while not found and time.monotonic() < end:
        found, status = os.waitpid(child, os.WNOHANG)
        time.sleep(0.005)
    if not found:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    print(json.dumps(os.waitstatus_to_exitcode(status) if found else "hangs"), flush=True)
"""


@pytest.fixture(scope="session")
def kernel_server():
    """A process that has loaded the kernel and forks one for each file: as apart as in use, and quicker."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "core"), "TOOLAXIS_NUMBA": "0"}
    with subprocess.Popen([sys.executable, "-c", SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                          env=environment) as server:
        yield server
        server.stdin.close()


@pytest.fixture
def quick_kernel(kernel_server, monkeypatch):
    """Let that process read STEP files; what hangs the kernel for half a minute fails the test."""

    def run(arguments, file, limit):
        kernel_server.stdin.write(json.dumps({"arguments": arguments, "limit": 30.0}) + "\n")
        kernel_server.stdin.flush()
        code = json.loads(kernel_server.stdout.readline())
        assert code != "hangs", f"{file} hangs the kernel"
        return subprocess.CompletedProcess(arguments, code, b"", b"")

    monkeypatch.setattr("toolaxis.cad.step.read._run", run)
