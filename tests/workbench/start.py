"""Given to a FreeCAD that is installed: runs pytest in it with the arguments in TOOLAXIS_ARGUMENTS, and leaves."""

import json
import os
import sys
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
status = 1
try:
    sys.path.insert(0, str(ROOT / "workbench"))
    os.chdir(ROOT)
    try:
        import pytest
    except ImportError:
        told = {"pytest": ["skipped", f"pytest is not installed in FreeCAD's Python {sys.version.split()[0]}"]}
        sys.__stdout__.write(f"\nTOOLAXIS-INNER {json.dumps(told)}\n")
        status = 0
    else:
        status = int(pytest.main(json.loads(os.environ["TOOLAXIS_ARGUMENTS"])))
except BaseException:
    traceback.print_exc(file=sys.__stderr__)
sys.__stdout__.flush()
os._exit(status)
