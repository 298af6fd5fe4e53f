"""LinuxCNC's own interpreter takes the programs, and its canonical moves are the plan's."""

import re
from pathlib import Path

import numpy as np
import pytest
from benchmarks._others import Unavailable
from benchmarks._others_linuxcnc import LinuxCnc, find_linuxcnc, interpret
from nc_plans import DATUM, a_plan, axes_at, chain, held_angles

from toolaxis.cldata.toolpath import Motion
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.dialects.registry import dialect_named
from toolaxis.post.program import program_of, program_text

MOVE = re.compile(r"STRAIGHT_(TRAVERSE|FEED)\(([^)]*)\)")
RATE = re.compile(r"SET_FEED_RATE\(([^)]*)\)")


@pytest.fixture(scope="module")
def linuxcnc(request: pytest.FixtureRequest) -> LinuxCnc:
    """The interpreter as it is installed or unpacked; fetched with --long."""
    try:
        return find_linuxcnc(fetch=request.config.getoption("--long"))
    except Unavailable as reason:
        pytest.skip(str(reason))


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
def test_canonical_moves_are_the_plan(machine_name: str, linuxcnc: LinuxCnc, tmp_path: Path) -> None:
    for seed in (1, 2):
        plan, mounting = _plan(machine_name, seed)
        dialect = dialect_named("linuxcnc")
        program = program_of(plan, mounting, dialect)
        canon = interpret(linuxcnc, program_text(program, dialect), tmp_path)
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
