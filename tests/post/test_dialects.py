"""One contract for every dialect: its program, read back as a control would, is the plan."""

import re
from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest
from nc_plans import DATUM, a_plan, axes_at, chain, held_angles
from nc_readers import Read, read_heidenhain, read_iso, read_siemens
from scipy.spatial.transform import Rotation

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.machine.library import load_machine
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.context import Options
from toolaxis.post.dialects.registry import dialects
from toolaxis.post.program import Dialect, program_of, program_text
from toolaxis.post.setup_sheet import sheet_text

DIALECTS = dialects()
MACHINES = ("mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "nutating-head", "head-head-portal", "ab-trunnion",
            "three-axes-fixture")
PLANES = [(name, machine) for name in DIALECTS for machine in MACHINES]


def _mounting(machine: Machine, rng: np.random.Generator) -> Mounting:
    """The part turned and moved on the table; travel is not judged."""
    where = np.eye(4)
    where[:3, :3] = Rotation.random(random_state=int(rng.integers(2**31))).as_matrix()
    where[:3, 3] = rng.uniform(-100, 100, 3)
    return Mounting(machine, where)


def _serves(dialect: Dialect, machine: Machine) -> bool:
    by_hand = any(axis.by_hand for axis in machine.rotary)
    if dialect.name == "linuxcnc-twp":
        return machine.kind == "head-head"
    if dialect.name in ("linuxcnc", "iso", "haas-g254"):
        return machine.kind == "table-table" and (not by_hand or dialect.name != "haas-g254")
    return not by_hand


def _read(text: str, dialect: Dialect, machine: Machine) -> list[Read]:
    def table(angles: dict[str, float]) -> np.ndarray:
        return chain(machine, {axis.name: 0.0 for axis in machine.rotary} | angles, head=False)

    if dialect.name == "siemens":
        return read_siemens(text, table)
    if dialect.name == "heidenhain":
        return read_heidenhain(text, table)
    return read_iso(text, table, dialect.name in ("linuxcnc", "iso"))


def _judge(plan: Plan, mounting: Mounting, dialect: Dialect, found: list[Read]) -> None:
    """Compare what was read with the plan: points, angles, plane and rates."""
    machine, half = mounting.machine, 0.5 * 10.0 ** -dialect.digits
    turn = np.asarray(mounting.table_from_part)[:3, :3]
    assert len(found) == len(plan.operations)
    for op, read in zip(plan.operations, found, strict=True):
        assert op.path is not None and op.frame is not None and read.plane is not None
        wanted = (op.path.cl - DATUM) @ turn.T
        assert np.abs(np.array(read.points) - wanted @ read.plane).max() <= half + 1e-9, op.name
        steps = max(max(axis.increment for axis in machine.rotary), radians(10.0 ** -dialect.angle_digits))
        axis = turn @ op.path.axis[0]
        held = chain(machine, read.angles) @ np.asarray(machine.spindle)
        assert np.linalg.norm(held - axis) <= 0.75 * steps + 1e-9
        _judge_plane(op.frame.x @ turn.T, held, read, dialect, machine)
        for one in machine.rotary:
            assert one.low - 1e-9 <= radians(read.angles[one.name]) <= one.high + 1e-9
            on_step = radians(read.angles[one.name]) / one.increment
            assert abs(on_step - round(on_step)) < 1e-4
        _judge_rates(plan, op.path.kind, read, wanted @ axis)
    if len(dialect.offsets) > 1:
        places = [tuple(round(value % 360.0, 4) % 360.0 for _, value in sorted(read.angles.items())) for read in found]
        pairs = {(read.offset, place) for read, place in zip(found, places, strict=True)}
        assert len(pairs) == len({read.offset for read in found}) == len(set(places)), "one offset for each position"


def _judge_plane(x: np.ndarray, held: np.ndarray, read: Read, dialect: Dialect, machine: Machine) -> None:
    assert read.plane is not None
    if dialect.turns:
        x = x - (x @ held) * held
        exact = np.stack([x / np.linalg.norm(x), np.cross(held, x / np.linalg.norm(x)), held], axis=1)
    else:
        exact = chain(machine, read.angles, head=False)
    half_turns = 1.5 * radians(10.0 ** -dialect.angle_digits) if dialect.turns else 0.0
    assert Rotation.from_matrix(exact.T @ read.plane).magnitude() <= half_turns + 1e-9


def _judge_rates(plan: Plan, kinds: np.ndarray, read: Read, heights: np.ndarray) -> None:
    steps = np.diff(np.array(read.points), axis=0)
    for k, kind in enumerate(kinds[1:], 1):
        if kind != Motion.LINK:
            assert read.rate[k] == plan.inputs.feedrate and not read.rapid[k]
            continue
        safe = np.linalg.norm(steps[k - 1][:2]) < 3e-3 or min(heights[k - 1:k + 1]) > heights.max() - 1e-4
        assert read.rate[k] in (np.inf, plan.inputs.rapid)
        assert not read.rapid[k] or safe
        assert read.rapid[k] == safe or read.rate[k] == plan.inputs.rapid


def _round_trip(name: str, machine_name: str, seed: int, count: int) -> None:
    dialect, machine, rng = DIALECTS[name], load_machine(machine_name), np.random.default_rng(seed)
    at_once = min(20, len(dialect.offsets)) if len(dialect.offsets) > 1 else 20
    for begin in range(0, count, at_once):
        mounting = _mounting(machine, rng)
        angles = held_angles(machine, rng, min(at_once, count - begin), level=not dialect.along_axis)
        plan = a_plan(axes_at(machine, angles, np.asarray(mounting.table_from_part)[:3, :3]), rng)
        program = program_of(plan, mounting, dialect)
        _judge(plan, mounting, dialect, _read(program_text(program, dialect), dialect, machine))


@pytest.mark.parametrize("name, machine", PLANES)
def test_what_is_written_is_the_plan_or_is_refused(name: str, machine: str) -> None:
    if _serves(DIALECTS[name], load_machine(machine)):
        _round_trip(name, machine, 1, 12)
        return
    rng = np.random.default_rng(1)
    loaded = load_machine(machine)
    plan = a_plan(axes_at(loaded, held_angles(loaded, rng, 1), np.eye(3)), rng)
    with pytest.raises(InvalidInput, match=r"use (another )?--dialect"):
        program_of(plan, Mounting(loaded), DIALECTS[name])


@pytest.mark.long
@pytest.mark.parametrize("name, machine", PLANES)
def test_a_thousand_planes(name: str, machine: str) -> None:
    if not _serves(DIALECTS[name], load_machine(machine)):
        pytest.skip("this dialect does not serve this machine")
    _round_trip(name, machine, 2, 1000)


def _one(machine: str, axis: list[float], dialect: str, offset: bool = False, **inputs: float) -> str:
    rng = np.random.default_rng(4)
    plan = a_plan(np.array(axis) / np.linalg.norm(axis), rng, **inputs)
    mounting = Mounting(load_machine(machine), [900, 0, 100] if offset else None, 150.0)
    return program_text(program_of(plan, mounting, DIALECTS[dialect]), DIALECTS[dialect])


def test_signs_by_hand() -> None:
    """A tool that leans 30 deg towards -y of the part stands at A +30 of a table that turns the part by -30 deg."""
    axis = [0.0, -np.sin(radians(30)), np.cos(radians(30))]
    assert "G0 C0.000 A30.000" in _one("mikron-ucp-710", axis, "fanuc")
    text = _one("mikron-ucp-710", axis, "linuxcnc")
    first = next(line for line in text.splitlines() if line.startswith("G0 X"))
    path = a_plan(np.array(axis), np.random.default_rng(4)).operations[0].path
    assert path is not None
    x, y, z = path.cl[0] - DATUM
    turned = [x, y * np.cos(radians(30)) + z * np.sin(radians(30))]
    assert first == f"G0 X{turned[0]:.5f} Y{turned[1]:.5f}"


def test_spatial_angles_of_the_manual() -> None:
    """SPA+45 SPC+90 of the TNC 620 manual: C first, then A about the turned X, so that the tool leans towards +x."""
    text = _one("mikron-ucp-710", [np.sin(radians(45)), 0.0, np.cos(radians(45))], "heidenhain")
    a, b, c = (float(re.search(rf"SP{name}([-+]\S+)", text)[1]) for name in "ABC")  # type: ignore[index]
    held = Rotation.from_euler("ZYX", [c, b, a], degrees=True).as_matrix()[:, 2]
    assert np.allclose(held, [np.sqrt(0.5), 0, np.sqrt(0.5)], atol=2e-6)


def test_siemens_takes_the_solution_on_the_right_side() -> None:
    """Both solutions of the table are inside +-20 deg of A; the one with less turning has A +12 here, the higher."""
    axis = [0.0, -np.sin(radians(12)), np.cos(radians(12))]
    assert ",1,0,0)" in _one("mikron-ucp-710", axis, "siemens").split("AXES")[1].splitlines()[1]
    axis = [0.0, np.sin(radians(12)), np.cos(radians(12))]
    assert ",-1,0,0)" in _one("mikron-ucp-710", axis, "siemens").split("AXES")[1].splitlines()[1]


def test_the_next_solution_is_the_nearer_one() -> None:
    """C at 170 and then at -170 deg is a turn of 20 deg for a table without end."""
    rng, machine = np.random.default_rng(5), load_machine("mikron-ucp-710")
    angles = np.radians([[170.0, 40.0], [-170.0, 40.0]])
    plan = a_plan(axes_at(machine, angles, np.eye(3)), rng)
    program = program_of(plan, Mounting(machine), DIALECTS["fanuc"])
    turns = [degrees(station.angles[0]) for station in program.stations]
    assert abs(turns[1] - turns[0]) == pytest.approx(20.0, abs=1e-6)


def test_axes_without_end_roll_over_but_on_linuxcnc() -> None:
    rng, machine = np.random.default_rng(5), load_machine("mikron-ucp-710")
    angles = np.radians([[120.0, 40.0], [-150.0, 40.0], [-30.0, 40.0], [120.0, 40.0]])
    plan = a_plan(axes_at(machine, angles, np.eye(3)), rng)
    for name, wanted in (("iso", [120.0, 210.0, 330.0, 120.0]), ("linuxcnc", [120.0, 210.0, 330.0, 480.0])):
        program = program_of(plan, Mounting(machine), DIALECTS[name])
        found = re.findall(r"^G0 C(\S+) A40\.", program_text(program, DIALECTS[name]), re.MULTILINE)
        assert [float(value) for value in found] == wanted
        assert [station.orientation for station in program.stations] == [0, 1, 2, 0]


def test_linuxcnc_s_sheet_tells_how_tables_must_turn() -> None:
    """Only where the program turns a table: not for a fixture that is set by hand, nor for other dialects."""
    told = "Growing angles of C and A must turn the tool right-handed"
    for machine, name, wanted in (("mikron-ucp-710", "linuxcnc", True), ("mikron-ucp-710", "iso", False),
                                  ("three-axes-fixture", "linuxcnc", False)):
        dialect = DIALECTS[name]
        plan = a_plan(np.array([0.0, 0.0, 1.0]), np.random.default_rng(4))
        program = program_of(plan, Mounting(load_machine(machine)), dialect)
        assert (told in sheet_text(program, dialect, "program.ngc")) == wanted


def test_three_axes_take_what_stands_upright() -> None:
    machine = load_machine("three-axes-fixture")
    upright = Machine("three axes", machine.linear)
    plan = a_plan(np.array([0.0, 0.0, 1.0]), np.random.default_rng(1))
    text = program_text(program_of(plan, Mounting(upright), DIALECTS["iso"]), DIALECTS["iso"])
    (read,) = read_iso(text, lambda angles: np.eye(3), True)
    path = plan.operations[0].path
    assert path is not None and np.abs(np.array(read.points) - (path.cl - DATUM)).max() <= 0.5e-3 + 1e-9
    with pytest.raises(InvalidInput, match="no position of three axes reaches"):
        program_of(a_plan(np.array([0.0, 0.6, 0.8]), np.random.default_rng(1)), Mounting(upright), DIALECTS["iso"])
    with pytest.raises(InvalidInput, match="needs 2 rotary axes"):
        program_of(plan, Mounting(upright), DIALECTS["fanuc"])

def test_angles_that_are_already_chosen_are_kept_or_refused() -> None:
    """The other solution of the table, C turned by 180 deg and A on the other side."""
    rng, machine = np.random.default_rng(5), load_machine("mikron-ucp-710")
    plan = a_plan(axes_at(machine, np.radians([[30.0, 20.0]]), np.eye(3)), rng)
    for turns in ([210.0, -20.0], [-150.0, -20.0]):
        program = program_of(plan, Mounting(machine), DIALECTS["fanuc"], Options(angles={1: np.radians(turns)}))
        assert np.allclose(np.degrees(program.stations[0].angles), turns, atol=1e-9)
    for turns, said in (([31.0, 20.0], "deg from the one"), ([210.0, -35.0], "axis A does not hold"),
                        ([30.0004, 20.0], "axis C does not hold"), ([30.0], "2 finite ones")):
        with pytest.raises(InvalidInput, match=said):
            program_of(plan, Mounting(machine), DIALECTS["fanuc"], Options(angles={1: np.radians(turns)}))


def test_the_solution_that_the_machine_holds_is_taken_though_it_is_further() -> None:
    """A 45 degree head in whole degrees: one solution is on the steps, the other mostly is not."""
    rng, known = np.random.default_rng(8), load_machine("nutating-head")
    (table,), (head,) = ([replace(axis, increment=radians(1.0)) for axis in some] for some in (known.table, known.head))
    machine = replace(known, table=(table,), head=(head,))
    for row in np.round(rng.uniform(-100, 100, (20, 2))):
        plan = a_plan(axes_at(machine, np.radians(row)[None], np.eye(3)), rng)
        (station,) = program_of(plan, Mounting(machine), DIALECTS["siemens"]).stations
        assert station.lean < 1e-6


def test_same_angles_share_a_work_offset() -> None:
    rng, machine = np.random.default_rng(6), load_machine("mikron-ucp-710")
    angles = np.radians([[10.0, 20.0], [30.0, 20.0], [10.0, 20.0]])
    plan = a_plan(axes_at(machine, angles, np.eye(3)), rng)
    text = program_text(program_of(plan, Mounting(machine), DIALECTS["iso"]), DIALECTS["iso"])
    assert [line for line in text.splitlines() if line in ("G54", "G55", "G56")] == ["G54", "G54", "G55", "G54"]


@pytest.mark.parametrize("dialect, machine, axis, said", [
    ("fanuc", "mikron-ucp-710", [0, -0.5, -1], "deg beyond the rotary ranges"),
    ("fanuc", "three-axes-fixture", [0, 0, 1], "set by hand: use --dialect"),
    ("haas-g254", "dmg-dmu-60t", [0, 0, 1], "serves machines of the kind table or table-table"),
    ("linuxcnc-twp", "nutating-head", [0, 0, 1], "serves machines of the kind head-head"),
    ("linuxcnc", "three-axes-fixture", [0, 0.2003, 1], "make the plan with --machine"),
])
def test_what_cannot_be_expressed_is_refused(dialect: str, machine: str, axis: list[float], said: str) -> None:
    with pytest.raises(InvalidInput, match=said) as caught:
        _one(machine, axis, dialect)
    assert str(caught.value).count(". ") == 0


def test_travel_is_refused_where_the_place_is_known() -> None:
    with pytest.raises(InvalidInput, match="would leave its travel"):
        _one("mikron-ucp-710", [0, -1, 0.2], "fanuc", offset=True)


def test_more_orientations_than_offsets() -> None:
    rng, machine = np.random.default_rng(7), load_machine("mikron-ucp-710")
    angles = np.radians([[10.0 * k, 20.0] for k in range(7)])
    plan = a_plan(axes_at(machine, angles, np.eye(3)), rng)
    with pytest.raises(InvalidInput, match="7 orientations need as many work offsets"):
        program_of(plan, Mounting(machine), DIALECTS["iso"])
    program_of(plan, Mounting(machine), DIALECTS["linuxcnc"])


def test_a_spindle_that_points_up_is_retracted_along_its_axis_or_refused() -> None:
    axis = [np.sin(radians(100)), 0.0, np.cos(radians(100))]
    with pytest.raises(InvalidInput, match=r"points up by 10\.0 deg"):
        _one("head-head-portal", axis, "fanuc")
    assert "L M140 MB MAX" in _one("head-head-portal", axis, "heidenhain")


@pytest.mark.parametrize("name", ["feedrate", "rapid"])
def test_a_feed_of_zero_is_refused(name: str) -> None:
    with pytest.raises(InvalidInput, match=f"{name} is 0"):
        _one("mikron-ucp-710", [0, 0, 1], "fanuc", **{name: 0.0})
