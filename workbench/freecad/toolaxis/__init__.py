"""Tool Axis for FreeCAD: what runs when FreeCAD starts, so that it does as good as nothing.

The library stands beside this add-on in the clone, in core; where it is not there, an installed one is used.  For
scripts and macros there are the names in `PUBLIC`, loaded when they are first used.
"""

import sys

import FreeCAD
from freecad.toolaxis.paths import ROOT
from freecad.toolaxis.saved_names import FormerModules

CORE = ROOT / "core"
PUBLIC = ("Wish", "export", "is_stale", "make_jobs", "merge", "plan", "recompute", "split", "verify")

if (CORE / "toolaxis").is_dir() and str(CORE) not in sys.path:
    sys.path.insert(0, str(CORE))

# Before all other finders: an update that only copies files leaves those of former packages where they were.
sys.meta_path.insert(0, FormerModules())

FreeCAD.__unit_test__ += ["freecad.toolaxis.unit_tests"]


def __getattr__(name):
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from freecad.toolaxis.cam import jobs
    from freecad.toolaxis.services import api, export

    home = {"make_jobs": jobs, "export": export, "Wish": export}.get(name, api)
    return getattr(home, name)


def __dir__():
    return sorted({*globals(), *PUBLIC})
