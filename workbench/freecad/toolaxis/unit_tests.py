"""The add-on's tests for FreeCAD's own test runner: one case for each file of tests/workbench, run by pytest.

The files stay plain pytest files; those of the GUI run where FreeCAD has its window.
"""

import unittest
from importlib.util import find_spec
from pathlib import Path

import FreeCAD

CLONE = Path(__file__).resolve().parents[3]
FOLDER = CLONE / "tests" / "workbench"


def _case(path: Path):
    """A test method that runs one file of tests in this process."""
    def run(self):
        if find_spec("pytest") is None:
            self.skipTest("pytest is not installed in FreeCAD's Python: pip install pytest")
        import pytest

        status = pytest.main([str(path), "--rootdir", str(CLONE), "-c", str(CLONE / "setup.cfg"),
                              "-p", "no:cacheprovider", "-q"])
        self.assertIn(status, (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED), f"{path.name} failed")

    return run


class TestToolAxis(unittest.TestCase):
    """Every file of tests/workbench."""


for _path in sorted([*FOLDER.glob("test_*.py"), *(FOLDER.glob("gui/test_*.py") if FreeCAD.GuiUp else ())]):
    setattr(TestToolAxis, _path.stem, _case(_path))
