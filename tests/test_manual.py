"""The manual does what it says: commands and code run; the tour through FreeCAD names what there is."""

import ast
import re
import shutil
import struct
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from toolaxis.cli.main import main

ROOT = Path(__file__).parent.parent
MANUAL = ROOT / "resources" / "manual"
TEXT = (MANUAL / "freecad.md").read_text(encoding="utf-8")
PICTURES = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", TEXT)
ADDON = ROOT / "workbench" / "freecad" / "toolaxis"
#: Menu entries and words on panels that are FreeCAD's own, or of a list that is filled later.
OTHERS = {"OK"}


def menu() -> set[str]:
    """All texts of the menu, from the commands' sources."""
    found = set()
    for path in (ADDON / "gui" / "commands").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "QT_TRANSLATE_NOOP":
                found.add(ast.literal_eval(node.args[1]))
    return found


def words() -> set[str]:
    """What stands on the panels, from their layouts."""
    return {(node.text or "").strip() for path in (ROOT / "resources" / "ui").glob("*.ui")
            for node in ElementTree.parse(path).getroot().iter("string")}


def test_the_tour_has_a_picture_for_each_step_that_shows_something() -> None:
    steps = re.findall(r"^## (\d+)\. ", TEXT, re.MULTILINE)
    assert steps == [str(k) for k in range(1, 11)] and len(PICTURES) == 12


@pytest.mark.parametrize("name", PICTURES)
def test_pictures_are_there_and_small(name: str) -> None:
    data = (MANUAL / name).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", data[16:24])
    assert 1100 <= width <= 1300 and 600 <= height <= 900 and len(data) < 150_000


def test_no_picture_of_the_tour_is_left_over() -> None:
    assert {f"figures/{path.name}" for path in (MANUAL / "figures").glob("freecad-*.png")} == set(PICTURES)


def test_every_command_that_is_named_is_in_the_menu() -> None:
    named = {entry.rpartition(" > ")[2] for entry in re.findall(r"\*Tool Axis > ([^*]+)\*", TEXT)}
    assert len(named) >= 8 and named <= menu(), named - menu()


def test_every_word_of_a_panel_that_is_named_stands_there() -> None:
    named = set(re.findall(r"\*\*([^*]+)\*\*", TEXT))
    assert len(named) >= 10 and named <= words() | OTHERS, named - words()


def blocks(page: str, language: str) -> list[str]:
    text = (MANUAL / page).read_text(encoding="utf-8")
    return [code for name, code in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
            if name == language]


def test_the_first_part_is_machined_as_the_page_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its commands one after the other, each of which ends with exit code 0, beside the part that the demo writes."""
    pytest.importorskip("OCP")
    commands = [line.split()[1:] for block in blocks("first-part.md", "") for line in block.splitlines()]
    assert commands[0] == ["demo", "first"]  # tests/test_wheel.py runs it, from the wheel
    assert [words[0] for words in commands[1:]] == ["inspect", "plan", "verify", "post", "report"]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "first").mkdir()
    shutil.copy(ROOT / "examples" / "dish.step", tmp_path / "first" / "dish.step")
    for words in commands[1:]:
        assert main([*words, "--no-pictures"] if words[0] in ("plan", "verify") else words) == 0, words
    named = set(re.findall(r"`(mine/[\w./-]+)`", (MANUAL / "first-part.md").read_text(encoding="utf-8")))
    assert named and all((tmp_path / name).is_file() for name in named)
    assert (tmp_path / "mine" / "report.html").is_file()


def test_the_code_of_the_page_on_python_runs() -> None:
    code = blocks("python.md", "python")
    assert len(code) == 3
    done = subprocess.run([sys.executable, "-W", "error", "-c", "\n".join(code)], cwd=ROOT, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr


def test_the_targets_and_extras_of_the_page_on_installing_are_there() -> None:
    text = (MANUAL / "install.md").read_text(encoding="utf-8")
    for target in sorted(set(re.findall(r"^make (\w+)$|`make (\w+)`", text, re.MULTILINE))):
        subprocess.run(["make", "-n", *filter(None, target)], cwd=ROOT, check=True, capture_output=True)
    extras = (ROOT / "setup.cfg").read_text(encoding="utf-8").split("[options.extras_require]")[1]
    for name in re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", text, re.MULTILINE))):
        assert re.search(rf"^{name} =", extras, re.MULTILINE), name
    version = re.search(r"^version = (.+)$", (ROOT / "setup.cfg").read_text(encoding="utf-8"), re.MULTILINE)
    assert version is not None and f"toolaxis-{version[1]}-py3-none-any.whl" in text
