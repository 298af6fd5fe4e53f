"""What tests of contacts share lies beside them, in `dense.py` and `width_numpy.py`."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent))
