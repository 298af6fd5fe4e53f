"""Compiling hot kernels with numba where it is installed and works.

Each kernel stands beside a plain numpy twin.  The twin is the oracle in tests, and it is what runs where numba is
missing or broken; then one notice is given.
"""

import os
import warnings
from collections.abc import Callable
from typing import Any, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _load() -> Any:
    if os.environ.get("TOOLAXIS_NUMBA", "1") == "0":
        return None
    try:
        import numba
    except Exception as reason:  # numba raises ImportError, SystemError or AttributeError on a numpy it does not know
        warnings.warn(f"numba cannot be used ({reason}): slower numpy code runs instead", RuntimeWarning, stacklevel=2)
        return None
    return numba


_numba = _load()
available: bool = _numba is not None


def compiled(function: _Function) -> _Function:
    """Compile a kernel, or hand it back unchanged where numba cannot be used.

    Compiled code is kept on disk, releases the interpreter lock and divides as IEEE 754 does.

    Parameters
    ----------
    function : callable
        A function on arrays and numbers that numba can compile.
    """
    if _numba is None:
        return function
    result: _Function = _numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    return result
