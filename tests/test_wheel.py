"""A wheel holds the library, its schema and the tool library, and nothing else; it works without the clone."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("setuptools", minversion="70.1", reason="building a wheel needs setuptools 70.1 or newer")
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    for name in ("setup.cfg", "pyproject.toml", "README.md", "LICENSE"):
        source.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, source / name)
    shutil.copytree(ROOT / "core" / "toolaxis", source / "core" / "toolaxis",
                    ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("tools", "machines"):
        shutil.copytree(ROOT / "resources" / name, source / "resources" / name)
    subprocess.run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir",
                    str(folder), str(source)], check=True, capture_output=True)
    (found,) = folder.glob("toolaxis-*.whl")
    return found


def test_what_is_in_it(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert "toolaxis/plan/plan.schema.json" in names and "toolaxis/py.typed" in names
    assert any(name.endswith("data/share/toolaxis/tools/torus-12x1.toml") for name in names)
    assert {name.split("/")[0].split("-")[0] for name in names} == {"toolaxis"}


def test_the_tool_library_works_from_where_a_wheel_puts_it(wheel: Path, tmp_path: Path) -> None:
    zipfile.ZipFile(wheel).extractall(tmp_path)
    (data,) = tmp_path.glob("toolaxis-*.data/data")
    code = ("import sys\n"
            f"sys.prefix = {str(data)!r}\n"
            "import toolaxis\n"
            f"assert toolaxis.__file__.startswith({str(tmp_path)!r}), toolaxis.__file__\n"
            "from toolaxis.job.toolfile import library, load_tool\n"
            "assert len(library()) >= 6 and load_tool('torus-12x1').stickout == 60\n"
            "from toolaxis.machine import catalogue\n"
            "assert len(catalogue.library()) >= 7 and catalogue.load_machine('mikron-ucp-710').kind == 'table-table'\n"
            "from toolaxis.plan.schema import schema\n"
            "assert schema()['title'] == 'toolaxis plan'\n")
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path,
                   env={**os.environ, "PYTHONPATH": str(tmp_path)})
