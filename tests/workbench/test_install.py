"""The clone as an add-on: what FreeCAD loads when it starts, and what package.xml promises."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAVY = ("numpy", "scipy", "numba", "matplotlib", "toolaxis.shape", "toolaxis.cad.loading", "OCP", "PySide")


def loaded(code):
    """Modules of a new Python after some lines with FreeCAD."""
    script = f"import sys\nimport FreeCAD\nbefore = set(sys.modules)\n{code}\nsys.__stdout__.write(' '.join(" \
             "set(sys.modules) - before) + ' END')\nsys.__stdout__.flush()\nimport os\nos._exit(0)"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=True,
                         stdin=subprocess.DEVNULL)
    return set(run.stdout.split())


def test_the_bootstrap_finds_the_library_and_loads_nothing_else():
    modules = loaded("import freecad.toolaxis\nimport toolaxis\nassert toolaxis.__version__")
    assert "END" in modules
    assert "toolaxis" in modules
    assert not [name for name in modules for heavy in HEAVY if name == heavy or name.startswith(heavy + ".")]
