"""The clone as an add-on: what FreeCAD loads when it starts, and what package.xml promises."""

import os
import subprocess
import sys
import unittest
from pathlib import Path

import FreeCAD
import pytest

import toolaxis

ROOT = Path(__file__).resolve().parents[2]
HEAVY = ("numpy", "scipy", "numba", "matplotlib", "toolaxis.shape", "toolaxis.cad.load", "OCP", "pytest")


def started(code, *arguments, **environment):
    """Words that a new Python with FreeCAD says."""
    if "python" not in Path(sys.executable).name:
        pytest.skip(f"{Path(sys.executable).name} holds Python in itself: a process of its own needs a plain one")
    script = f"import os, sys\nimport FreeCAD\n{code}\nsys.__stdout__.flush()\nos._exit(0)"
    outside = {name: value for name, value in os.environ.items() if name != "TOOLAXIS_INNER"}
    run = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, text=True, timeout=600,
                         check=True, stdin=subprocess.DEVNULL, env={**outside, **environment})
    return run.stdout.split()


TELL = "sys.__stdout__.write(' '.join(sys.modules) + ' END ')"


@pytest.fixture(scope="module")
def plain():
    """Modules of a FreeCAD that has just started, the add-on among them where it is installed."""
    return set(started(TELL))


def heavy(modules):
    return [name for name in modules for package in HEAVY if name == package or name.startswith(package + ".")]


def test_the_start_of_freecad_loads_nothing_heavy(plain):
    assert "END" in plain
    if "freecad.toolaxis" not in plain:
        pytest.skip("the clone is not installed as an add-on here")
    assert not heavy(plain)


def test_the_bootstrap_finds_the_library_and_loads_nothing_else():
    modules = started(f"import freecad.toolaxis\nimport toolaxis\nassert toolaxis.__version__\n{TELL}")
    assert "toolaxis" in modules
    assert not heavy(modules)


def test_the_workbench_is_there_when_the_window_is_and_loads_nothing_heavy():
    code = ("import FreeCADGui\nbefore = set(sys.modules)\nFreeCADGui.showMainWindow()\n"
            "assert 'ToolAxisWorkbench' in FreeCADGui.listWorkbenches()\n"
            "import freecad.toolaxis.init_gui\n"
            "sys.__stdout__.write(' '.join(m for m in set(sys.modules) - before if 'toolaxis' in m) + ' END')")
    modules = started(code)
    assert modules[-1] == "END"
    assert not [name for name in modules if name.startswith("toolaxis.")]


def test_an_installed_library_serves_where_the_clone_has_none(tmp_path):
    """The add-on's folder alone, with core somewhere else on the path."""
    copy = tmp_path / "Mod" / "workbench" / "freecad" / "toolaxis"
    copy.mkdir(parents=True)
    for path in (ROOT / "workbench" / "freecad" / "toolaxis").glob("*.py"):
        (copy / path.name).write_text(path.read_text())
    code = ("import freecad\nfor name in [name for name in sys.modules if name.startswith('freecad.toolaxis')]:\n"
            "    del sys.modules[name]\nfreecad.__path__.insert(0, sys.argv[1])\n"
            "sys.path[:] = [p for p in sys.path if not p.endswith('/core')] + [sys.argv[2]]\n"
            "import freecad.toolaxis as addon, toolaxis\n"
            "sys.__stdout__.write(f'{addon.__file__} {toolaxis.__file__}')")
    addon, library = started(code, str(copy.parent), str(ROOT / "core"))
    assert addon == str(copy / "__init__.py")
    assert library == str(ROOT / "core" / "toolaxis" / "__init__.py")


def test_scripts_find_the_functions_on_documents():
    import freecad.toolaxis as addon

    assert {"plan", "verify", "recompute", "is_stale"} <= set(dir(addon))
    assert all(callable(getattr(addon, name)) for name in addon.PUBLIC)
    with pytest.raises(AttributeError, match="has no attribute 'plann'"):
        addon.plann  # noqa: B018


def test_without_numba_the_numbers_are_the_same():
    code = ("import Part, freecad.toolaxis, toolaxis as ta\nfrom toolaxis.numeric import jit\n"
            "face, tool = ta.load(Part.read(sys.argv[1])).face(1), ta.Tool.torus(12, 1)\n"
            "widths = ta.strip_width(face, tool, face.grid(2, 2), [0.1, 0.1, 1], 0.02)\n"
            "sys.__stdout__.write(f'{jit.available} ' + ' '.join(map(repr, widths.ravel().tolist())))")
    answers = [started(code, str(ROOT / "examples" / "saddle.step"), TOOLAXIS_NUMBA=numba) for numba in ("0", "1")]
    assert answers[0][0] == "False"
    plain, compiled = (list(map(float, answer[1:])) for answer in answers)
    assert len(plain) == 8
    assert plain == pytest.approx(compiled, rel=1e-9)


@pytest.fixture(scope="module")
def package():
    return FreeCAD.Metadata(str(ROOT / "package.xml"))


def test_package_xml_says_what_the_addon_manager_asks(package):
    assert package.Name == "Tool Axis"
    assert package.Version == toolaxis.__version__
    assert [entry["name"] for entry in package.License] == ["LGPL-2.1-or-later"]
    assert {entry["type"] for entry in package.Urls} >= {"repository", "readme"}
    assert package.Maintainer
    assert package.FreeCADMin == "1.0.0" or package.FreeCADMin.startswith("1.0")
    assert (ROOT / package.Icon).is_file()
    needed = {entry["package"]: str(entry["type"]) for entry in package.Depend}
    assert set(needed) == {"numpy", "scipy", "numba"}
    assert all("python" in kind for kind in needed.values())


def test_the_workbench_of_package_xml_is_the_one_that_is_there(package):
    workbench = package.Content["workbench"][0]
    assert workbench.Classname == "ToolAxisWorkbench"
    assert (ROOT / workbench.Subdirectory / "freecad" / "toolaxis" / "init_gui.py").is_file()
    assert (ROOT / workbench.Subdirectory / workbench.Icon).resolve().is_file()
    assert 3 <= len(workbench.Tag) <= 7
    assert workbench.Tag == [tag.lower() for tag in workbench.Tag]


def test_freecads_own_test_runner_finds_our_files():
    import freecad.toolaxis  # noqa: F401

    assert "freecad.toolaxis.unit_tests" in FreeCAD.__unit_test__
    found = unittest.defaultTestLoader.loadTestsFromName("freecad.toolaxis.unit_tests")
    files = {path.stem for path in (ROOT / "tests" / "workbench").glob("test_*.py")}
    assert {case._testMethodName for suite in found for case in suite} >= files


def test_a_file_runs_in_freecads_own_test_runner():
    code = ("import unittest\nfrom freecad.toolaxis import unit_tests\n"
            "suite = unittest.defaultTestLoader.loadTestsFromName('TestToolAxis.test_document_parts', unit_tests)\n"
            "result = unittest.TextTestRunner(stream=sys.__stderr__).run(suite)\n"
            "sys.__stdout__.write(f'RAN {result.testsRun} {result.wasSuccessful()}')")
    assert " ".join(started(code)[-3:]) == "RAN 1 True"
