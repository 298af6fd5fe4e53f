"""Run outside FreeCAD before test_blades_whole.py: ``python prepare_blades_whole.py FOLDER [--long]``.

It leaves in FOLDER a copy of the part by others that those tests open, from the folder that TOOLAXIS_SHARED names,
where it is there: FreeCAD may run where it sees no folder but the project's.
"""

import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PART = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts" / "kj66_impeller.step"

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    if PART.exists():
        shutil.copy(PART, folder)
