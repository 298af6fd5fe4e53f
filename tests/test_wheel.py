"""A wheel holds the library, its schema and the tool library, and nothing else; it works without the clone."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
_spec = spec_from_file_location("release", ROOT / "resources" / "release" / "release.py")
assert _spec is not None and _spec.loader is not None
release = module_from_spec(_spec)
_spec.loader.exec_module(release)
CLEAN = release.clean_environment()


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
    (source / "examples").mkdir()
    shutil.copy(ROOT / "examples" / "dish.step", source / "examples" / "dish.step")
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
    assert any(name.endswith("data/share/toolaxis/examples/dish.step") for name in names)
    for file in ("page.html.j2", "batch.html.j2", "page.css", "page.js"):
        assert f"toolaxis/report/html/{file}" in names
    assert {name.split("/")[0].split("-")[0] for name in names} == {"toolaxis"}
    known = tomllib.loads((ROOT / "resources" / "release" / "contents.toml").read_text(encoding="utf-8"))
    assert release.compare_contents(release.list_contents(wheel), known["wheel"], known["largest"]) == []


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


@pytest.mark.parametrize("place", ["lib/python3.99/site-packages", "."])
def test_its_files_are_found_below_a_user_s_folder_or_any_other(wheel: Path, tmp_path: Path, place: str) -> None:
    """As `pip install --user` and `pip install --target` put them, neither of which is Python's own prefix."""
    zipfile.ZipFile(wheel).extractall(tmp_path / place)
    (data,) = (tmp_path / place).glob("toolaxis-*.data/data")
    (data / "share").rename(tmp_path / "share")
    code = ("from toolaxis.resources import find_files\n"
            "print([*find_files('examples', '.step').values(), *find_files('racks', '.toml').values()])\n")
    done = subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(tmp_path / place)})
    assert done.stdout.count(str(tmp_path / "share" / "toolaxis")) == 2


@pytest.fixture(scope="module")
def unpacked(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("unpacked")
    zipfile.ZipFile(wheel).extractall(folder)
    return folder


def share_kernels(source: Path, target: Path) -> None:
    """Copy the compiled kernels that the other package lacks, each list of them after the code that it names."""
    for suffix in ("nbc", "nbi"):
        for path in source.rglob(f"*.{suffix}"):
            place = target / path.relative_to(source)
            if place.exists() or not place.parents[1].is_dir():
                continue
            place.parent.mkdir(exist_ok=True)
            new = place.with_name(f"{place.name}-{os.getpid()}")
            shutil.copyfile(path, new)
            new.replace(place)


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A virtual environment with the wheel in it, and what it needs from this one, where the clone is not seen."""
    env = tmp_path_factory.mktemp("installed") / "env"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(env)], check=True, env=CLEAN)
    subprocess.run([sys.executable, "-m", "pip", "--python", str(env / "bin" / "python"), "install", "--quiet",
                    "--no-deps", "--no-index", "--disable-pip-version-check", str(wheel)], check=True, env=CLEAN)
    (site,) = (env / "lib").glob("python*/site-packages")
    # .pth files in the folder that is named here do not count, so the clone is not seen.
    (site / "needed.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return env


def test_the_import_warns_of_nothing_and_what_is_needed_fits(installed: Path, tmp_path: Path) -> None:
    python = installed / "bin" / "python"
    where = subprocess.run([python, "-W", "error", "-c", "import toolaxis; print(toolaxis.__file__)"], cwd=tmp_path,
                           env=CLEAN, capture_output=True, text=True, check=True).stdout
    assert where.startswith(str(installed))
    done = subprocess.run([sys.executable, "-m", "pip", "--python", str(python), "check"], cwd=tmp_path, env=CLEAN,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_demo_does_the_main_job_from_the_wheel(installed: Path, tmp_path: Path) -> None:
    """On whichever CAD kernel is installed: rack, machine and part come with the wheel, and nothing from the clone."""
    if find_spec("OCP") is None:
        pytest.skip("there is no CAD kernel")
    (package,) = (installed / "lib").glob("python*/site-packages/toolaxis")
    share_kernels(ROOT / "core" / "toolaxis", package)
    done = subprocess.run([installed / "bin" / "toolaxis", "demo", "made", "--no-pictures", "--json"], cwd=tmp_path,
                          env=CLEAN, capture_output=True, text=True)
    share_kernels(package, ROOT / "core" / "toolaxis")
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"
    told = json.loads(done.stdout)
    assert told["passed"] is True and json.loads((tmp_path / told["verdict"]).read_text())["passed"] is True
    plan = json.loads((tmp_path / told["plan"]).read_text())
    assert str(installed / "share") in plan["part"]["source"]
    assert plan["machine"]["name"] == "Mikron UCP 710" and plan["outcome"] == "complete"
    names = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert {told[name] for name in ("part", "plan", "verdict", "page")} | set(told["programs"]) <= names
    assert {f"made/plan/{name}" for name in ("program-heidenhain.h", "program-fanuc.nc", "setup-fanuc.md")} <= names
    assert [path.name for path in tmp_path.iterdir()] == ["made"]
    assert all(path in done.stderr for path in (told["part"], *told["programs"], told["page"]))


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
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "env")], check=True, env=CLEAN)
    python, command = tmp_path / "env" / "bin" / "python", tmp_path / "env" / "bin" / "toolaxis"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
                    f"{wheel}[build123d,report,mesh]"], check=True, cwd=tmp_path, env=CLEAN)
    shutil.copy(ROOT / "examples" / "saddle.step", tmp_path / "part.step")
    for words in ("inspect part.step", "plan part.step --tool torus-12x1 --scallop 0.05 --out made", "verify made",
                  "post made --dialect fanuc --machine mikron-ucp-710", "report made", "export made",
                  "export made --out made/plan.glb --colour scallop"):
        done = subprocess.run([command, *words.split()], cwd=tmp_path, env=CLEAN, capture_output=True, text=True)
        assert done.returncode == 0, f"{words}\n{done.stdout}\n{done.stderr}"
    names = {path.name for path in (tmp_path / "made").iterdir()}
    assert {"plan.json", "verdict.json", "program-fanuc.nc", "report.html", "plan.step", "plan.glb"} <= names
    where = subprocess.run([python, "-c", "import toolaxis; print(toolaxis.__file__)"], cwd=tmp_path, env=CLEAN,
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
