"""What every test may use: the long marker, a limit of time, and the folder of parts made by others."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
# s; the slowest tests take a quarter of it on two noisy cores: what takes longer waits for what never comes
LIMIT, LONG_LIMIT = 900, 5400


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--long", action="store_true", help="run the long versions of seeded tests too")


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
