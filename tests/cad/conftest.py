"""Real parts for the adapters, and the kernel's own answers about them."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


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
