"""What the whole command takes the first time, while kernels are compiled, and the second time."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import toolaxis

ROOT = Path(__file__).resolve().parent.parent
RUN = "import sys; from toolaxis.cli.main import main; sys.exit(main(sys.argv[1:]))"


def spent(arguments: list[str], cache: str) -> tuple[float, float]:
    """Wall and processor time of one run of the command in a process of its own, s."""
    path = os.pathsep.join([str(Path(toolaxis.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    before, start = os.times(), time.perf_counter()
    subprocess.run([sys.executable, "-c", RUN, *arguments], check=True, capture_output=True,
                   env={**os.environ, "NUMBA_CACHE_DIR": cache, "PYTHONPATH": path})
    after = os.times()
    own = after.children_user + after.children_system - before.children_user - before.children_system
    return time.perf_counter() - start, own


def main() -> None:
    """Print the table."""
    print("toolaxis plan examples/freeform.step --tool torus:12x1 --scallop 0.02, in a new process each")
    print(f"{'':34}{'wall s':>8}{'processor s':>12}")
    with tempfile.TemporaryDirectory() as folder:
        plan = ["plan", str(ROOT / "examples" / "freeform.step"), "--tool", "torus:12x1", "--scallop", "0.02"]
        work = [("cold: nothing compiled yet", [*plan, "--out", f"{folder}/first"]),
                ("warm: the second run", [*plan, "--out", f"{folder}/second"]),
                ("warm: the third run", [*plan, "--out", f"{folder}/third"]), ("--help", ["--help"])]
        for name, arguments in work:
            wall, own = spent(arguments, f"{folder}/cache")
            print(f"{name:34}{wall:8.2f}{own:12.2f}", flush=True)


if __name__ == "__main__":
    main()
