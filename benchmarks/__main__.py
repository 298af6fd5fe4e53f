"""`make bench`: run every benchmark of this folder, or those that are named, and print their tables.

Each module has a `main()` that prints.  A module that cannot run says why, and the others go on.  With ``--short``
those that have a `short()` run that instead, on fewer faces.  A benchmark with a `run_with()` takes words of its own
where it is the first that is named: ``python -m benchmarks real_parts FOLDER --sample 5``.
"""

import importlib
import os
import platform
import sys
import time
import traceback
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = ("numpy", "scipy", "numba", "cadquery", "build123d", "opencamlib", "shapely")


def _versions() -> str:
    found = []
    for name in PACKAGES:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} not installed")
    return ", ".join(found)


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def _names() -> list[str]:
    return sorted(path.stem for path in Path(__file__).parent.glob("*.py") if not path.stem.startswith("_"))


def main(chosen: list[str]) -> int:
    """Run the benchmarks and return 1 where one failed."""
    if len(chosen) > 1 and chosen[0] in _names() and not set(chosen) <= {*_names(), "--short"}:
        module = importlib.import_module(f"benchmarks.{chosen[0]}")
        if hasattr(module, "run_with"):
            return int(module.run_with(chosen[1:]))
    brief = "--short" in chosen
    chosen = [name for name in chosen if name != "--short"]
    names = _names()
    unknown = sorted(set(chosen) - set(names))
    if unknown:
        print(f"no benchmark is called {unknown[0]}: there are {', '.join(names)}", file=sys.stderr)
        return 2
    print(f"Python {platform.python_version()}, {platform.platform()}, {os.cpu_count()} x {_processor()}")
    print(_versions(), flush=True)
    failed = []
    for name in chosen or names:
        print(f"\n=== {name} ===", flush=True)
        began = time.perf_counter()
        try:
            module = importlib.import_module(f"benchmarks.{name}")
            (getattr(module, "short", module.main) if brief else module.main)()
        except Exception:
            failed.append(name)
            traceback.print_exc()
        print(f"--- {name}: {time.perf_counter() - began:.1f} s", flush=True)
    if failed:
        print(f"\nfailed: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
