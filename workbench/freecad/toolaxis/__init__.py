"""Tool Axis for FreeCAD: what runs when FreeCAD starts, so that it does as good as nothing.

The library stands beside this add-on in the clone, in core; where it is not there, an installed one is used.  For
scripts there are `plan`, `verify`, `recompute`, `is_stale` and `make_jobs`, loaded when they are first used.
"""

import sys
from pathlib import Path

import FreeCAD

ROOT = Path(__file__).resolve().parents[3]
CORE = ROOT / "core"
RESOURCES = ROOT / "resources"
PUBLIC = ("is_stale", "make_jobs", "merge", "plan", "recompute", "split", "verify")

if (CORE / "toolaxis").is_dir() and str(CORE) not in sys.path:
    sys.path.insert(0, str(CORE))

FreeCAD.__unit_test__ += ["freecad.toolaxis.unit_tests"]


def __getattr__(name):
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import bridge, cam_jobs

    return getattr(cam_jobs if name == "make_jobs" else bridge, name)


def __dir__():
    return sorted({*globals(), *PUBLIC})
