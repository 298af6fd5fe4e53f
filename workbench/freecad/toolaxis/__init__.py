"""Tool Axis for FreeCAD: what runs when FreeCAD starts, so that it does as good as nothing.

The library stands beside this add-on in the clone, in core; where it is not there, an installed one is used.  For
scripts there are `plan`, `verify`, `recompute`, `is_stale` and `make_jobs`, loaded when they are first used.
"""

import sys
from pathlib import Path

import FreeCAD
from freecad.toolaxis.saved_names import FormerModules

ROOT = Path(__file__).resolve().parents[3]
CORE = ROOT / "core"
RESOURCES = ROOT / "resources"
PUBLIC = ("is_stale", "make_jobs", "merge", "plan", "recompute", "split", "verify")

if (CORE / "toolaxis").is_dir() and str(CORE) not in sys.path:
    sys.path.insert(0, str(CORE))

# Before all other finders: an update that only copies files leaves those of former packages where they were.
sys.meta_path.insert(0, FormerModules())

FreeCAD.__unit_test__ += ["freecad.toolaxis.unit_tests"]


def __getattr__(name):
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from freecad.toolaxis.cam import jobs
    from freecad.toolaxis.services import api

    return getattr(jobs if name == "make_jobs" else api, name)


def __dir__():
    return sorted({*globals(), *PUBLIC})
