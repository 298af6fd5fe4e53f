"""Tool Axis for FreeCAD: what runs when FreeCAD starts, so that it does as good as nothing.

The library stands beside this add-on in the clone, in core; where it is not there, an installed one is used.
"""

import sys
from pathlib import Path

import FreeCAD

ROOT = Path(__file__).resolve().parents[3]
CORE = ROOT / "core"
RESOURCES = ROOT / "resources"

if (CORE / "toolaxis").is_dir() and str(CORE) not in sys.path:
    sys.path.insert(0, str(CORE))

FreeCAD.__unit_test__ += ["freecad.toolaxis.unit_tests"]
