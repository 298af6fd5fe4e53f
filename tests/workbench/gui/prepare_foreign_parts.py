"""Run outside FreeCAD before test_foreign_parts.py: ``python prepare_foreign_parts.py FOLDER [--long]``.

It leaves in FOLDER copies of the parts by others that those tests open, from the folder that TOOLAXIS_SHARED names,
where they are there: FreeCAD may run where it sees no folder but the project's.
"""

import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PARTS = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("kj66_impeller", "linkrods"):
        if (PARTS / f"{name}.step").exists():
            shutil.copy(PARTS / f"{name}.step", folder)
