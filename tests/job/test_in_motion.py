"""Operations with a moving axis on a machine with bodies: planning, the judge and posting agree."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.feed.continuous_ik import following
from toolaxis.job.output.post import post_plan
from toolaxis.job.planning.sequencing import sequence_operations
from toolaxis.job.planning.timing import add_times
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.search.face_problem import task
from toolaxis.strategies.common.passes import beyond
from toolaxis.tolerances import Tolerance
from toolaxis.verify.machine_motion import MachineModel

TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10.0, 0.0), (10.0, 40.0)])
PLACE = (-20.0, 10.0, 60.0)
SPINDLE = MachineBody("nose", "Z", "cylinder", np.array([[0.0, 0, 0], [0, 0, 200]]), 50.0)


def with_bodies(plan: Plan, *bodies: MachineBody) -> Plan:
    return replace(plan, machine=Mounting(replace(plan.machine.machine, bodies=bodies), PLACE))


@pytest.fixture(scope="module")
def plan() -> Plan:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 24, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.006 * (x - 20) ** 2 - 0.004 * (y - 12) ** 2], axis=-1))
    made = ta.plan(face, TOOL, 0.1, strategy="sturz", workers=1, tolerance=Tolerance(gouge=0.002, chord=0.001))
    return add_times(replace(made, machine=Mounting(ta.load_machine("bc-table-table"), PLACE)))


def post_beside(plan: Plan, gap: float) -> MachineBody:
    """A post on the bed, at its least distance a gap from the nose that goes along above it."""
    path, mounting = plan.operations[0].path, plan.machine
    along = following(mounting.machine, path, mounting.table_from_part, TOOL.gauge_length)
    k = int(np.argmax(along.linear[:, 0]))
    beside = along.linear[k] + [50.0 + gap, 0, 0]
    return MachineBody("post", "bed", "box", beside + np.array([[0.0, -20, 20], [30, 20, 500]]))


def test_a_path_is_proven_among_the_machine_s_bodies_and_the_judge_says_the_same(plan: Plan) -> None:
    assert plan.timed and plan.outcome == "complete" and plan.in_the_way == ()
    assert "collision with the machine itself" not in plan.not_checked
    for gap, free in ((3.0, True), (0.7, False)):
        built = with_bodies(plan, MachineBody("table", "C", "cylinder", np.array([[0.0, 0, -40], [0, 0, 0]]), 100.0),
                            SPINDLE, post_beside(plan, gap))
        made = sequence_operations(built)
        assert made.operations[0].done is free and (made.outcome == "complete") is free
        if not free:
            verdict = ta.verify(built, spacing=2.0)
            assert verdict.operations[0].clearance["machine"].distance == pytest.approx(gap, abs=0.5)
            assert not verdict.passed and any("the nose" in why and "the post" in why for why in verdict.reasons)
            why = made.operations[0].orientation.reasons[0]
            assert why.startswith("infeasible: the nose ") and "post" in why and "of the path" in why
            with pytest.raises(ta.InvalidInput, match=r"op01-face1: the nose .* the post.*; move the part"):
                post_plan(plan, "fanuc", replace(built.machine, tool_length=TOOL.gauge_length))


def test_the_search_itself_looks_at_bodies(plan: Plan) -> None:
    op = plan.operations[0]
    for gap, free in ((3.0, True), (0.7, False)):
        limits = replace(with_bodies(plan, SPINDLE, post_beside(plan, gap)).machine, tool_length=TOOL.gauge_length)
        found = beyond(task(op.face, TOOL, 0.1, limits), op.path)
        assert (found is None) is free
        assert found is None or "the post" in found.words


def test_the_judge_turns_the_axes_near_the_pole_as_programs_do(plan: Plan) -> None:
    """Passes beside the pole of C, which turns by half a turn between neighbouring points."""
    path, mounting = plan.operations[0].path, plan.machine
    along = following(mounting.machine, path, mounting.table_from_part, TOOL.gauge_length)
    place = np.eye(4)
    place[:3, 3] = PLACE
    rig = MachineModel(mounting.machine, place, TOOL.gauge_length, TOOL.profile, TOOL.outlines, ())
    joints, arrival = rig.joints(path.cl, path.axis, plan.operations[0].time.rotary)
    points = np.arange(len(path.cl))
    last, there = (np.searchsorted(some, points, side="right") - 1 for some in (along.arrival, arrival))
    assert np.abs(np.diff(along.rotary[last], axis=0)).max() > 2.0
    assert joints[there, 3:] == pytest.approx(along.rotary[last], abs=1e-6)


def test_what_is_in_the_way_down_to_the_path_is_told_once(plan: Plan) -> None:
    """A roof that the head's upper end meets when Z is up, however often the plan is arranged."""
    machine = plan.machine.machine
    top = float(machine.linear[2].high)
    roof = MachineBody("roof", "bed", "box", np.array([[-900.0, -900, top + 150], [900, 900, top + 160]]))
    table = MachineBody("table", "C", "box", np.array([[-50.0, -50, -30], [50, 50, 0]]))
    made = sequence_operations(with_bodies(plan, roof, SPINDLE, table))
    assert made.operations[0].done and made.outcome == "incomplete" and len(made.in_the_way) == 2
    assert "on the approach" in made.in_the_way[0] and made.in_the_way[1].startswith("at the end: on the retract")
    assert sequence_operations(made).in_the_way == made.in_the_way
