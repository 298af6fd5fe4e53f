"""Translations: no text of the add-on is missing in German, and what FreeCAD loads is what was translated."""

import importlib.util
import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "resources" / "translations"
FIELD = re.compile(r"\{[^}]*\}")


@pytest.fixture(scope="module")
def collect():
    spec = importlib.util.spec_from_file_location("collect", FOLDER / "collect.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def german(collect):
    return collect.translated(FOLDER / "toolaxis_de.ts")


def test_all_kinds_of_texts_are_collected(collect):
    found = dict.fromkeys(collect.texts())
    for wanted in (("ToolAxis", "Removing material"), ("ToolAxis_MakeJobs", "Make CAM Jobs"),
                   ("ToolAxisPlan", "Compute"), ("ToolAxisPreferences", "New plans"), ("ToolAxis_Examples", "Saddle"),
                   ("Workbench", "Examples")):
        assert wanted in found, wanted


def test_no_text_is_missing_in_german(collect, german):
    missing = [pair for pair in collect.texts() if pair not in german]
    assert not missing, f"python resources/translations/collect.py, then translate and run lrelease: {missing}"


def test_a_translation_has_the_fields_of_its_text(german):
    for (context, text), translation in german.items():
        assert sorted(FIELD.findall(text)) == sorted(FIELD.findall(translation)), (context, text)
        assert text.endswith("...") == translation.endswith("..."), text


def test_what_freecad_loads_is_what_was_translated(german):
    from PySide import QtCore

    translator = QtCore.QTranslator()
    assert translator.load(str(FOLDER / "toolaxis_de.qm"))
    for (context, text), translation in german.items():
        assert translator.translate(context, text) == translation, (context, text)


def test_collecting_again_keeps_what_is_translated(collect, german, tmp_path):
    assert collect.write(tmp_path / "toolaxis_de.ts", "de", german) == 0
    assert collect.translated(tmp_path / "toolaxis_de.ts") == german
    first = next(iter(german))
    left = {pair: text for pair, text in german.items() if pair != first}
    assert collect.write(tmp_path / "toolaxis_de.ts", "de", left) == 1
    assert collect.translated(tmp_path / "toolaxis_de.ts") == left
