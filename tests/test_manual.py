"""The tour through FreeCAD names what there is: pictures, commands, and what stands on the panels."""

import ast
import re
import struct
from pathlib import Path
from xml.etree import ElementTree

import pytest

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
