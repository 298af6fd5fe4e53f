"""A part that stands too deep in a machine's table: by how much it is to be raised, and that the program is written."""

import re
from dataclasses import replace

import numpy as np
import pytest
from tests.job.test_order import AXES, PLACE, TOOL, plan_of

import toolaxis as ta
from toolaxis.errors import PartMisplaced
from toolaxis.job.output.height_on_table import find_missing_height
from toolaxis.job.output.post import post_plan
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.setup import Mounting
from toolaxis.progress import Progress

PLAN = plan_of(AXES, bodies=True)


def mounted(z: float, x: float = PLACE[0], machine: str = "bc-table-table") -> Mounting:
    return Mounting(ta.load_machine(machine), (x, PLACE[1], z), TOOL.gauge_length)


@pytest.mark.parametrize("z", [-85.0, -30.0])
def test_a_part_inside_the_table_is_raised_onto_it(z: float) -> None:
    with pytest.raises(PartMisplaced, match="collides with the table by"):
        post_plan(PLAN, "linuxcnc", mounted(z))
    assert find_missing_height(PLAN, mounted(z)) == -z
    assert "program-linuxcnc.ngc" in post_plan(PLAN, "linuxcnc", mounted(0.0))


@pytest.mark.parametrize(("axis", "height"), [((0.9, 0.0, 0.3), 15.0), ((1.0, 0.0, -0.02), 50.0)])
def test_a_tool_that_lies_low_needs_more_and_gets_no_step_too_much(axis: tuple[float, ...], height: float) -> None:
    low = plan_of([axis], bodies=True)
    for z in (0.0, -10.0):
        assert find_missing_height(low, mounted(z)) == height - z
    assert "program-linuxcnc.ngc" in post_plan(low, "linuxcnc", mounted(height))
    with pytest.raises(PartMisplaced, match="collides with the table by"):
        post_plan(low, "linuxcnc", mounted(height - 5.0))


def test_a_part_below_the_travel_is_raised_into_it() -> None:
    bare = replace(mounted(-200.0), machine=replace(PLAN.machine.machine, bodies=()))
    with pytest.raises(PartMisplaced, match=r"Z of .* would leave its travel"):
        post_plan(PLAN, "linuxcnc", bare)
    height = find_missing_height(PLAN, bare)
    assert 0 < height < 200.0
    assert post_plan(PLAN, "linuxcnc", replace(bare, table_from_part=(*PLACE[:2], height - 200.0)))


def test_a_part_that_stands_well_is_not_raised() -> None:
    assert find_missing_height(PLAN, mounted(60.0)) == 0.0


def test_nothing_is_offered_where_no_height_helps() -> None:
    aside = mounted(-30.0, x=5000.0)
    with pytest.raises(PartMisplaced, match="would leave its travel"):
        post_plan(PLAN, "linuxcnc", aside)
    assert find_missing_height(PLAN, aside) == 0.0
    wall = MachineBody("wall", "bed", "box", np.array([[-900.0, -900, -900], [900, 900, 900]]))
    walled = replace(mounted(0.0), machine=replace(ta.load_machine("bc-table-table"), bodies=(wall, *(
        body for body in PLAN.machine.machine.bodies if body.carried == "Z"))))
    assert find_missing_height(PLAN, walled) == 0.0


def test_an_axis_that_no_place_helps_is_refused_before_the_table() -> None:
    under = plan_of([AXES[0], (0.1, 0.0, -1.0)], bodies=True)
    with pytest.raises(ta.InvalidInput, match=r"op02-face1: no position of .* reaches the axis.*plan for this") as why:
        post_plan(under, "linuxcnc", mounted(-85.0))
    assert not isinstance(why.value, PartMisplaced) and find_missing_height(under, mounted(-85.0)) == 0.0


def test_looking_for_it_can_be_stopped() -> None:
    with pytest.raises(ta.Cancelled):
        find_missing_height(PLAN, mounted(-30.0), Progress(cancelled=lambda: True))


def test_a_moving_axis_is_raised_too() -> None:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 24, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.006 * (x - 20) ** 2 - 0.004 * (y - 12) ** 2], axis=-1))
    made = ta.plan(face, TOOL, 0.2, strategy="sturz", workers=1)
    low = mounted(-70.0)
    with pytest.raises(PartMisplaced, match="collides with the table by"):
        post_plan(made, "fanuc", low)
    height = find_missing_height(made, low)
    assert height >= 70 and any(re.match("program-", name) for name in post_plan(made, "fanuc",
                                                                                mounted(-70.0 + height)))
