"""Collect what the FreeCAD add-on says, and bring the translations up to date: python resources/translations/collect.py

Keeps what is translated, adds what is new as unfinished, and drops what is gone.  `lrelease toolaxis_de.ts` (of Qt, or
pyside6-lrelease) makes of it what FreeCAD loads.
"""

import ast
import sys
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "core"))

from toolaxis.strategies.registry import strategies  # noqa: E402
from toolaxis.tools.registry import cutters  # noqa: E402

ADDON, LAYOUTS = ROOT / "workbench" / "freecad" / "toolaxis", ROOT / "resources" / "ui"
_MARKS = ("translate", "QT_TRANSLATE_NOOP")


def texts():
    """All texts with their contexts, (context, text) pairs, sorted."""
    found = set()
    for path in ADDON.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and _name(node.func) in _MARKS and len(node.args) >= 2:
                found |= {(context, text) for context in _literals(node.args[0]) for text in _literals(node.args[1])}
            elif isinstance(node, ast.Call) and _name(node.func) == "Property" and len(node.args) >= 4:
                found |= {("App::Property", text) for text in _literals(node.args[3]) if not _is_hidden(node)}
    for path in LAYOUTS.glob("*.ui"):
        root = ElementTree.parse(path).getroot()
        context = root.findtext("class")
        found |= {(context, node.text) for node in root.iter("string")
                  if node.get("notr") != "true" and (node.text or "").strip()}
    for one in strategies().values():  # they are offered as the library names them
        found |= {("ToolAxisPlan", one.title), ("ToolAxis", one.note)} | {("ToolAxis", text)
                                                                         for text in one.pictures.values()}
    found |= {("ToolAxisPlan", one.title) for one in cutters().values()}
    return sorted(pair for pair in found if pair[1])


def _name(function):
    return getattr(function, "attr", None) or getattr(function, "id", None)


def _is_hidden(call):
    """Whether the property that a call describes is one that FreeCAD's editor does not show."""
    given = call.args[5:6] + [one.value for one in call.keywords if one.arg == "hidden"]
    return any(getattr(value, "value", None) is True for value in given)


def _literals(node):
    """The texts that an argument can be; none where that is known only later."""
    if isinstance(node, ast.IfExp):
        return _literals(node.body) + _literals(node.orelse)
    return [node.value] if isinstance(node, ast.Constant) and isinstance(node.value, str) else []


def translated(path):
    """What a .ts file translates, by (context, text); unfinished ones are left out."""
    if not path.exists():
        return {}
    found = {}
    for context in ElementTree.parse(path).getroot().iter("context"):
        for message in context.iter("message"):
            translation = message.find("translation")
            if translation is not None and translation.get("type") is None and translation.text:
                found[context.findtext("name"), message.findtext("source")] = translation.text
    return found


def write(path, language, known):
    """Write a .ts file with all texts; how many of them are not translated."""
    root = ElementTree.Element("TS", version="2.1", language=language, sourcelanguage="en")
    contexts, missing = {}, 0
    for context, text in texts():
        if context not in contexts:
            contexts[context] = ElementTree.SubElement(root, "context")
            ElementTree.SubElement(contexts[context], "name").text = context
        message = ElementTree.SubElement(contexts[context], "message")
        ElementTree.SubElement(message, "source").text = text
        translation = ElementTree.SubElement(message, "translation")
        if (context, text) in known:
            translation.text = known[context, text]
        else:
            translation.set("type", "unfinished")
            missing += 1
    ElementTree.indent(root, " ")
    body = ElementTree.tostring(root, encoding="unicode")
    path.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n{body}\n', encoding="utf-8")
    return missing


if __name__ == "__main__":
    for file in sorted(Path(__file__).parent.glob("*.ts")):
        left = write(file, file.stem.rpartition("_")[2], translated(file))
        sys.stdout.write(f"{file.name}: {len(texts())} texts, {left} not translated\n")
