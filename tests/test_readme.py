"""README and manual do what they say: commands and code run; tests, files and options that they name exist."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from toolaxis.cli.main import main

ROOT = Path(__file__).parent.parent
MANUAL = ROOT / "resources" / "manual"
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
COMMAND = (MANUAL / "command.md").read_text(encoding="utf-8")
GUARANTEES = (MANUAL / "guarantees.md").read_text(encoding="utf-8")
WORDS = 900


def blocks(language: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
    return [text for name, text in found if name == language]


def test_make_knows_the_targets_and_the_demo_runs_the_command() -> None:
    (targets,) = [block for block in blocks("") if block.startswith("make")]
    for line in targets.split("\n"):
        if line:
            subprocess.run([*line.split(), "--dry-run"], cwd=ROOT, check=True, capture_output=True)
    dry = subprocess.run(["make", "-n", "demo"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    assert "toolaxis plan examples/freeform.step" in dry and "toolaxis verify out/demo" in dry


def test_the_wheel_that_is_installed_is_the_one_that_make_builds() -> None:
    (wheel,) = re.findall(r"^pip install '(dist/[^'\[]+)\[cadquery\]'$", TEXT, re.MULTILINE)
    dry = subprocess.run(["make", "-n", "wheel"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    version = re.search(r"^version = (.+)$", (ROOT / "setup.cfg").read_text(encoding="utf-8"), re.MULTILINE)
    assert version is not None and wheel == f"dist/toolaxis-{version[1]}-py3-none-any.whl" and "dist" in dry


def commands() -> list[str]:
    return [line for block in blocks("") for line in block.splitlines() if line.startswith("toolaxis ")]


def test_every_command_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                            capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    assert commands()[0] == "toolaxis demo"  # tests/test_wheel.py runs it, from the wheel
    found = commands()[1:]
    assert [line.split()[1] for line in found] == ["inspect", "plan", "verify", "post", "report"]
    for line in found:
        words = [str(ROOT / word) if word.startswith("examples/") else word for word in line.split()[1:]]
        assert main(words) == 0, f"{line}\n{capsys.readouterr()}"
    assert (tmp_path / "out" / "saddle" / "verdict.json").exists()
    assert (tmp_path / "out" / "saddle" / "program-fanuc.nc").exists()
    assert (tmp_path / "out" / "saddle" / "report.html").exists()


def test_the_python_example_runs_and_passes() -> None:
    (code,) = blocks("python")
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1].startswith("True")
    assert len([line for line in code.splitlines() if line.strip()]) <= 12


@pytest.mark.parametrize("name", sorted(set(re.findall(r"tests/[\w/]+\.py::\w+", GUARANTEES))))
def test_every_promise_has_its_test(name: str) -> None:
    path, _, function = name.partition("::")
    assert f"def {function}(" in (ROOT / path).read_text(encoding="utf-8")


def links(page: Path) -> list[Path]:
    found = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    return [page.parent / name for name in found if "://" not in name]


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(MANUAL.glob("*.md"))],
                         ids=lambda page: page.name)
def test_every_link_leads_to_a_file(page: Path) -> None:
    assert [str(path) for path in links(page) if not path.is_file()] == []


def test_the_readme_leads_to_every_page_of_the_manual() -> None:
    led_to = {path.name for path in links(ROOT / "README.md")}
    assert {page.name for page in MANUAL.glob("*.md")} <= led_to


def test_the_readme_is_read_in_five_minutes() -> None:
    assert len(TEXT.split()) <= WORDS


def helped() -> dict[str, str]:
    names = ("inspect", "plan", "verify", "post", "report", "export", "reschedule", "batch", "demo")
    return {name: subprocess.run([sys.executable, "-m", "toolaxis.cli.main", name, "--help"], capture_output=True,
                                 text=True, check=True).stdout for name in names}


def test_every_option_that_is_named_exists_and_plan_has_none_that_the_manual_omits() -> None:
    shown = helped()
    named = set(re.findall(r"--[a-z]+(?:-[a-z]+)*", TEXT + COMMAND)) - {"--help"}
    assert [option for option in sorted(named) if option not in "".join(shown.values())] == []
    options = set(re.findall(r"--[a-z]+(?:-[a-z]+)*", shown["plan"])) - {"--help", "--out", "--no-pictures"}
    assert sorted(options - named) == []
