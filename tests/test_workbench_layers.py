"""The layers of the FreeCAD add-on: its import contracts find what breaks them, and no import hides in a function."""

import ast
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

WORKBENCH = Path(__file__).resolve().parents[1] / "workbench"
NAME = "freecad.toolaxis"
#: What takes its time when it is first imported: a module that brings it may be imported in a function.
SLOW = {"numpy", "scipy", "pivy"}
#: What FreeCAD runs when it starts: these import in functions what is needed later.
START = {NAME, f"{NAME}.init_gui"}


def linted(workbench):
    """What import-linter says of an add-on, and its status."""
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    run = subprocess.run(command, cwd=workbench, capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL)
    return run.stdout + run.stderr, run.returncode


@pytest.fixture
def planted(tmp_path):
    """A copy of the add-on to write into: takes a module and the lines that are added to it."""
    copy = tmp_path / "workbench"
    shutil.copytree(WORKBENCH, copy, ignore=shutil.ignore_patterns("__pycache__", ".import_linter_cache"))

    def plant(module, lines):
        path = copy / "freecad" / "toolaxis" / module
        path.write_text(f"{path.read_text(encoding='utf-8')}\n\n{lines}\n", encoding="utf-8")
        return copy

    return plant


@pytest.mark.parametrize("module, lines, contract", [
    ("document/staleness.py", "from freecad.toolaxis.services import api", "points down"),
    ("services/api.py", "def _f():\n    from freecad.toolaxis.gui.plan.panel import PlanPanel", "points down"),
    ("document/kinds.py", "from freecad.toolaxis import plan", "points down"),
    ("gui/verify/panel.py", "from freecad.toolaxis.gui.machine import scene", "The same within the window"),
    ("document/children.py", "def _f():\n    from freecad.toolaxis.document import plan_group", "in a circle"),
    ("document/transaction.py", "import FreeCADGui", "need no window")])
def test_a_planted_import_breaks_a_contract(planted, module, lines, contract):
    told, status = linted(planted(module, lines))
    assert status == 1
    assert [line for line in told.splitlines() if " BROKEN" in line and contract in line], told


class Imports(ast.NodeVisitor):
    """What a module imports: when it is imported itself, and in functions."""

    def __init__(self, known):
        self.known, self.depth = known, 0
        self.at_once, self.in_functions = set(), set()

    def visit_FunctionDef(self, node):
        self.depth += 1
        self.generic_visit(node)
        self.depth -= 1

    def visit_Import(self, node):
        self._add(*(alias.name for alias in node.names))

    def visit_ImportFrom(self, node):
        assert not node.level, f"{ast.unparse(node)}: write the full name of the module"
        inner = [f"{node.module}.{alias.name}" for alias in node.names]
        self._add(*(name if name in self.known else node.module for name in inner))

    def _add(self, *names):
        (self.in_functions if self.depth else self.at_once).update(names)


def hidden(workbench):
    """Imports of the add-on's own modules in functions, though they bring nothing slow, in sentences."""
    paths = {".".join(part for part in path.relative_to(workbench).with_suffix("").parts if part != "__init__"): path
             for path in workbench.rglob("*.py")}
    found = {name: Imports(paths) for name in paths}
    for name, path in paths.items():
        found[name].visit(ast.parse(path.read_text(encoding="utf-8")))

    def slow(name):
        seen, left = set(), [name]
        while left:
            one = left.pop()
            if one not in seen:
                seen.add(one)
                left += found[one].at_once & set(paths)
        return {other.partition(".")[0] for one in seen for other in found[one].at_once} & SLOW

    return [f"{name} imports {other} in a function" for name in paths if name not in START
            for other in found[name].in_functions & set(paths) if not slow(other) - slow(name)]


def test_imports_in_functions_put_off_what_is_slow():
    assert not hidden(WORKBENCH)


def test_an_import_that_hides_in_a_function_is_found(planted):
    copy = planted("services/api.py", "def _f():\n    from freecad.toolaxis.services.macros import record")
    assert hidden(copy) == ["freecad.toolaxis.services.api imports freecad.toolaxis.services.macros in a function"]
