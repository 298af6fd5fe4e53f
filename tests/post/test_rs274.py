"""LinuxCNC's own interpreter takes the programs, and its canonical moves are the plan's."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from nc_plans import DATUM, a_plan, axes_at, chain, held_angles

from toolaxis.cldata.toolpath import Motion
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.dialects.registry import dialect_named
from toolaxis.post.program import program_of, program_text

HOME = Path(__file__).resolve().parents[2] / ".venv" / "rs274"
MOVE = re.compile(r"STRAIGHT_(TRAVERSE|FEED)\(([^)]*)\)")
RATE = re.compile(r"SET_FEED_RATE\(([^)]*)\)")


def _unpacked(folder: Path) -> str:
    """Fetch Debian's packages with the interpreter and unpack them; the reason where that does not work."""
    if not (shutil.which("apt-get") and shutil.which("dpkg")):
        return "there is no apt-get here"
    needs = subprocess.run(["apt-cache", "depends", "linuxcnc-uspace"], capture_output=True, text=True, check=False)
    names = re.findall(r"Depends: (libboost-python\S*|libmodbus\S*|libtirpc3\S*)", needs.stdout)
    folder.mkdir(parents=True, exist_ok=True)
    got = subprocess.run(["apt-get", "download", "linuxcnc-uspace", *names], cwd=folder, capture_output=True, text=True,
                         check=False)
    if got.returncode:
        return f"apt-get does not fetch linuxcnc-uspace: {got.stderr.strip()[-200:]}"
    for package in folder.glob("*.deb"):
        subprocess.run(["dpkg", "-x", package.name, "."], cwd=folder, check=True)
        package.unlink()
    return ""


@pytest.fixture(scope="module")
def interpreter(request: pytest.FixtureRequest) -> tuple[str, dict[str, str]]:
    """The program rs274 and the environment that it needs."""
    found = shutil.which("rs274")
    if found:
        return found, dict(os.environ)
    own = HOME / "usr" / "bin" / "rs274"
    if not own.is_file():
        if not request.config.getoption("--long"):
            pytest.skip("LinuxCNC's rs274 is not installed (make test-all fetches it where apt-get works)")
        reason = _unpacked(HOME)
        if reason or not own.is_file():
            pytest.skip(reason or "the package holds no rs274")
    libraries = [HOME / "usr" / "lib", *(HOME / "usr" / "lib").glob("*-linux-gnu")]
    return str(own), {**os.environ, "LD_LIBRARY_PATH": ":".join(map(str, libraries))}


def _canon(interpreter: tuple[str, dict[str, str]], text: str, folder: Path) -> str:
    (folder / "tool.tbl").write_text("T1 P1 Z0 D12\n")
    (folder / "program.ngc").write_text(text)
    made = subprocess.run([interpreter[0], "-g", "-t", "tool.tbl", "program.ngc"], cwd=folder, env=interpreter[1],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    if "error while loading shared libraries" in made.stderr:
        pytest.skip(made.stderr.strip())
    assert made.returncode == 0 and "PROGRAM_END" in made.stdout, made.stderr + made.stdout[-500:]
    return made.stdout


def _moves(canon: str) -> tuple[np.ndarray, list[bool], list[float]]:
    rows, rapid, rates, rate = [], [], [], np.nan
    for line in canon.splitlines():
        feed, move = RATE.search(line), MOVE.search(line)
        rate = float(feed[1]) if feed else rate
        if move:
            rows.append([float(word) for word in move[2].split(",")])
            rapid.append(move[1] == "TRAVERSE")
            rates.append(np.inf if rapid[-1] else rate)
    return np.array(rows), rapid, rates


def _plan(machine_name: str, seed: int) -> tuple[Plan, Mounting]:
    rng, machine = np.random.default_rng(seed), load_machine(machine_name)
    return a_plan(axes_at(machine, held_angles(machine, rng, 9), np.eye(3)), rng), Mounting(machine)


@pytest.mark.parametrize("machine_name", ["mikron-ucp-710", "bc-table-table", "ab-trunnion", "three-axes-fixture"])
def test_canonical_moves_are_the_plan(machine_name: str, interpreter: tuple[str, dict[str, str]],
                                      tmp_path: Path) -> None:
    for seed in (1, 2):
        plan, mounting = _plan(machine_name, seed)
        dialect = dialect_named("linuxcnc")
        program = program_of(plan, mounting, dialect)
        canon = _canon(interpreter, program_text(program, dialect), tmp_path)
        rows, rapid, rates = _moves(canon)
        at = 0
        for op in plan.operations:
            assert op.path is not None
            wanted, names = op.path.cl - DATUM, [axis.name for axis in mounting.machine.rotary]
            at = _found(rows, at, wanted, names, mounting)
            for k, kind in enumerate(op.path.kind[1:], 1):
                if kind != Motion.LINK:
                    assert not rapid[at + k] and rates[at + k] == pytest.approx(plan.inputs.feedrate, abs=1e-3)
            at += len(wanted)
        used = [int(word) for word in re.findall(r"SET_G5X_OFFSET\((\d)", canon)]
        assert set(used) == {1 + station.orientation for station in program.stations} | {1}


def _found(rows: np.ndarray, at: int, wanted: np.ndarray, names: list[str], mounting: Mounting) -> int:
    """Where an operation's tips stand in a row among the canonical moves, from a place on."""
    by_hand = any(axis.by_hand for axis in mounting.machine.rotary)
    for begin in range(at, min(at + 8, len(rows) - len(wanted) + 1)):
        some = rows[begin:begin + len(wanted)]
        angles = {name: float(some[0]["ABC".index(name) + 3]) for name in names}
        if by_hand:  # the machine does not know them: any solution may have been written
            if _any_turn(some[:, :3], wanted):
                return begin
        elif np.abs(some[:, :3] - wanted @ chain(mounting.machine, angles)).max() <= 6e-5:
            return begin
    raise AssertionError(f"no row of moves from {at} on is the operation's path")


def _any_turn(found: np.ndarray, wanted: np.ndarray) -> bool:
    """Whether some rotation about the datum carries one set of points into the other."""
    u, _, vt = np.linalg.svd(wanted.T @ found)
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return bool(np.abs(wanted @ turn - found).max() <= 1e-4)
