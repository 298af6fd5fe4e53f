"""What every test may use: the long marker, a limit of time, and the folder of parts made by others.

All processes of one run share a folder, SHARED, which goes with the run: what takes seconds and comes out the same each
time, as what the CAD kernel reads in a STEP file, or the plan of a part in FreeCAD, is made once and lies in it.
"""

import hashlib
import os
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SHARED = "TOOLAXIS_TESTS_SHARED"
# s; the slowest tests take a quarter of it on two noisy cores: what takes longer waits for what never comes
LIMIT, LONG_LIMIT = 900, 5400
# Before anything loads numpy, here and in all processes that tests start: threads of BLAS that spin while they wait for
# each other take the processor from the tests beside, and made a few small systems of equations cost half a minute.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--long", action="store_true", help="run the long versions of seeded tests too")


def pytest_configure(config: pytest.Config) -> None:
    if SHARED not in os.environ and "TOOLAXIS_INNER" not in os.environ:
        folder = ROOT / "out" / f"tests-{os.getpid()}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        os.environ[SHARED] = str(folder)
        config.add_cleanup(lambda: shutil.rmtree(os.environ.pop(SHARED), ignore_errors=True))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    long, limited = config.getoption("--long"), config.pluginmanager.hasplugin("timeout")
    for item in items:
        if "long" in item.keywords and not long:
            item.add_marker(pytest.mark.skip(reason="long: run with --long (make test-all)"))
        if limited and isinstance(item, pytest.Function):  # what runs in FreeCAD has limits of its own
            item.add_marker(pytest.mark.timeout(LONG_LIMIT if "long" in item.keywords else LIMIT))


@pytest.fixture(scope="session")
def shared_parts() -> Path:
    """Folder of real STEP parts made by others; tests that need it skip where it is absent."""
    folder = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
    if not folder.is_dir():
        pytest.skip(f"the parts made by others are not at {folder} (set TOOLAXIS_SHARED)")
    return folder


@pytest.fixture(scope="session", autouse=True)
def _step_files_are_read_once() -> None:
    """Keep what the CAD kernel made of a STEP file: its process loads the kernel for a second or two each time.

    The tests of reading itself, in tests/cad and where another command reads, let it read every time.
    """
    if SHARED not in os.environ or find_spec("OCP") is None:
        return
    from toolaxis.cad.step import read

    usual, command, folder = read._run, read.COMMAND, Path(os.environ[SHARED]) / "step"
    folder.mkdir(exist_ok=True)

    def run(arguments: list[str], file: Path, limit: float) -> "subprocess.CompletedProcess[bytes]":
        if os.environ.get("PYTEST_CURRENT_TEST", "").startswith("tests/cad/") or command != read.COMMAND:
            return usual(arguments, file, limit)
        source, target, order = map(Path, arguments)
        told = hashlib.sha256(source.read_bytes() + order.read_bytes()).hexdigest()
        kept = folder / told
        if kept.exists():
            shutil.copyfile(kept, target)
            return subprocess.CompletedProcess(arguments, 0, b"", b"")
        done = usual(arguments, file, limit)
        if done.returncode == 0 and target.exists():
            new = folder / f"{told}-{os.getpid()}"
            shutil.copyfile(target, new)
            new.replace(kept)
        return done

    read._run = run
