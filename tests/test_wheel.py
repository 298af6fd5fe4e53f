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
    for name in ("tools", "racks", "machines"):
        shutil.copytree(ROOT / "resources" / name, source / "resources" / name)
    subprocess.run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir",
                    str(folder), str(source)], check=True, capture_output=True)
    (found,) = folder.glob("toolaxis-*.whl")
    return found


def test_what_is_in_it(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert "toolaxis/plan/plan.schema.json" in names and "toolaxis/py.typed" in names
    assert "toolaxis/messages/german.toml" in names
    assert any(name.endswith("data/share/toolaxis/tools/torus-12x1.toml") for name in names)
    assert any(name.endswith("data/share/toolaxis/racks/general-rack.toml") for name in names)
    assert any(name.endswith("data/share/toolaxis/machines/mikron-ucp-710.toml") for name in names)
    for file in ("page.html.j2", "batch.html.j2", "page.css", "page.js"):
        assert f"toolaxis/report/html/{file}" in names
    assert {name.split("/")[0].split("-")[0] for name in names} == {"toolaxis"}


def test_the_tool_library_works_from_where_a_wheel_puts_it(wheel: Path, tmp_path: Path) -> None:
    zipfile.ZipFile(wheel).extractall(tmp_path)
    (data,) = tmp_path.glob("toolaxis-*.data/data")
    code = ("import sys\n"
            f"sys.prefix = {str(data)!r}\n"
            "import toolaxis\n"
            f"assert toolaxis.__file__.startswith({str(tmp_path)!r}), toolaxis.__file__\n"
            "from toolaxis.job.inputs.tool_file import library, load_tool\n"
            "assert len(library()) >= 6 and load_tool('torus-12x1').stickout == 60\n"
            "from toolaxis.job.inputs.tool_library import load_tools\n"
            "assert load_tools()[2].title == 'Bull nose D12 R1, ER20, 60 out'\n"
            "from toolaxis.machine import library\n"
            "assert len(library.library()) >= 7 and library.load_machine('mikron-ucp-710').kind == 'table-table'\n"
            "from toolaxis.plan.schema import schema\n"
            "assert schema()['title'] == 'toolaxis plan'\n")
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path,
                   env={**os.environ, "PYTHONPATH": str(tmp_path)})


@pytest.fixture(scope="module")
def unpacked(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("unpacked")
    zipfile.ZipFile(wheel).extractall(folder)
    return folder


SCRIPT = """\
import toolaxis as ta

tool = ta.Tool.torus(diameter=12, corner_radius=1, stickout=60)
face = ta.Face.from_bspline([[[x, y, 0.01 * x * y] for y in range(4)] for x in range(4)])
plan = ta.plan(face, tool, scallop=0.05)
axis = plan.operations[0].orientation.axis
verdict = ta.verify(plan)
reveal_type(plan)
reveal_type(verdict.passed)
ta.plan(face, tool, scallop="small")
"""


def test_mypy_finds_the_types_in_a_script_that_uses_the_wheel(unpacked: Path, tmp_path: Path) -> None:
    """Ten lines: what they give is known, and what is wrong in them is found."""
    pytest.importorskip("mypy")
    (tmp_path / "script.py").write_text(SCRIPT)
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", os.devnull, "--follow-imports=silent",
                           "--ignore-missing-imports", "--cache-dir", str(tmp_path / "cache"), "script.py"],
                          cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(unpacked)})
    said = done.stdout.splitlines()
    assert any('Revealed type is "toolaxis.plan.plan.Plan"' in text for text in said), done.stdout
    assert any("script.py:9" in text and '"bool"' in text.replace("builtins.", "") for text in said), done.stdout
    assert [text for text in said if "error" in text and "script.py" in text] == [
        'script.py:10: error: Argument "scallop" to "plan" has incompatible type "str"; expected "float"  [arg-type]']


@pytest.mark.long  # it downloads and installs all that the wheel needs: minutes, and hundreds of MB
def test_the_main_job_runs_from_the_wheel_in_a_clean_environment(wheel: Path, tmp_path: Path) -> None:
    """What an installed toolaxis plans, judges, posts, reports and exports, away from the clone."""
    ours = ("PYTHON", "TOOLAXIS", "VIRTUAL")
    clean = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "env")], check=True, env=clean)
    python, command = tmp_path / "env" / "bin" / "python", tmp_path / "env" / "bin" / "toolaxis"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
                    f"{wheel}[build123d,report,mesh]"], check=True, cwd=tmp_path, env=clean)
    shutil.copy(ROOT / "examples" / "saddle.step", tmp_path / "part.step")
    for words in ("inspect part.step", "plan part.step --tool torus-12x1 --scallop 0.05 --out made", "verify made",
                  "post made --dialect fanuc --machine mikron-ucp-710", "report made", "export made",
                  "export made --out made/plan.glb --colour scallop"):
        done = subprocess.run([command, *words.split()], cwd=tmp_path, env=clean, capture_output=True, text=True)
        assert done.returncode == 0, f"{words}\n{done.stdout}\n{done.stderr}"
    names = {path.name for path in (tmp_path / "made").iterdir()}
    assert {"plan.json", "verdict.json", "program-fanuc.nc", "report.html", "plan.step", "plan.glb"} <= names
    where = subprocess.run([python, "-c", "import toolaxis; print(toolaxis.__file__)"], cwd=tmp_path, env=clean,
                           capture_output=True, text=True, check=True).stdout
    assert where.startswith(str(tmp_path))


def test_the_source_distribution_builds_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    """All that a wheel holds is in the archive of sources too."""
    source = wheel.parent / "source"
    code = "import setuptools.build_meta as made, sys; print(made.build_sdist(sys.argv[1]))"
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=True, capture_output=True, cwd=source)
    (archive,) = tmp_path.glob("toolaxis-*.tar.gz")
    subprocess.run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir",
                    str(tmp_path), str(archive)], check=True, capture_output=True)
    (again,) = tmp_path.glob("toolaxis-*.whl")
    assert sorted(zipfile.ZipFile(again).namelist()) == sorted(zipfile.ZipFile(wheel).namelist())
