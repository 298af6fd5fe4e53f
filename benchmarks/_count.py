"""Count the floating-point operations of kernels by running their Python source on numbers that count.

Runs as a program of its own, without numba: what the kernels do with arrays and numbers is then plain Python, and each
sum, product, root and division of a counted number is seen.  Comparisons, signs and table look-ups are not counted.
"""

import json
import math
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

TALLY: Counter[str] = Counter()
KINDS = ("sums", "products", "roots", "divisions")


class Counted(float):
    """A number whose arithmetic is counted."""

    __slots__ = ()

    def __neg__(self) -> "Counted":
        return Counted(float.__neg__(self))

    def __abs__(self) -> "Counted":
        return Counted(float.__abs__(self))

    def __pow__(self, power: int) -> "Counted":
        TALLY["products"] += int(power) - 1
        return Counted(float(self) ** power)


def _counting(name: str, kind: str) -> Any:
    plain = getattr(float, name)

    def work(self: Counted, other: Any) -> Counted:
        TALLY[kind] += 1
        return Counted(plain(self, float(other)))

    return work


for _name, _kind in (("add", "sums"), ("sub", "sums"), ("mul", "products"), ("truediv", "divisions")):
    for _side in ("", "r"):
        setattr(Counted, f"__{_side}{_name}__", _counting(f"__{_side}{_name}__", _kind))


def root(x: float) -> Counted:
    """A counted square root."""
    TALLY["roots"] += 1
    return Counted(math.sqrt(x))


class Numpy:
    """numpy with roots that count and empty arrays for counted numbers."""

    sqrt = staticmethod(root)

    def __getattr__(self, name: str) -> Any:
        return getattr(np, name)

    @staticmethod
    def empty(shape: Any, dtype: Any = float) -> np.ndarray:
        return counted(np.zeros(shape)) if dtype is float else np.empty(shape, dtype)


def counted(values: Any) -> Any:
    """Arrays and tuples with counted numbers; whole numbers stay."""
    if isinstance(values, tuple):
        parts = [counted(value) for value in values]
        return type(values)(*parts) if hasattr(values, "_fields") else tuple(parts)
    if isinstance(values, np.ndarray) and values.dtype == float:
        return np.frompyfunc(Counted, 1, 1)(values)
    return Counted(values) if isinstance(values, float) else values


def watch() -> None:
    """Let every kernel's module count."""
    for name, module in list(sys.modules.items()):
        if name.startswith(("toolaxis.contact", "toolaxis.numeric", "benchmarks._section")):
            for own, other in (("np", Numpy()), ("sqrt", root)):
                if hasattr(module, own):
                    setattr(module, own, other)


def operations() -> dict[str, dict[str, Any]]:
    """What the jobs of `strip_rates` take, counted in a process of its own, and their answers."""
    run = subprocess.run([sys.executable, "-m", "benchmarks._count"], cwd=Path(__file__).parents[1], text=True,
                         env={**os.environ, "TOOLAXIS_NUMBA": "0"}, capture_output=True, check=True)
    found: dict[str, dict[str, Any]] = json.loads(run.stdout)
    return found


def main() -> None:
    """Print the counts of every job, as JSON."""
    from benchmarks.strip_rates import jobs

    found, todo = {}, jobs()
    watch()
    for name, (kernel, arguments, out) in todo.items():
        TALLY.clear()
        room = counted(out)
        kernel(*counted(arguments), room)
        found[name] = {"tally": [TALLY[kind] for kind in KINDS], "answer": room.astype(float).ravel().tolist()}
    print(json.dumps(found))


if __name__ == "__main__":
    main()
