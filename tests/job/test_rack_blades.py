"""A part with blades and a rack of tools: one blade is planned with all of them, the others are copies of it."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.plan.plan import Plan

from .test_turned_operations import COUNT, wheel  # type: ignore[import-not-found]

#: The small one is so slow that the large one begins, whatever a tool change takes.
TOOLS = [ta.Tool.ball(8, stickout=40, holder=[(12, 0), (12, 30)]), ta.Tool.ball(2, feedrate=50.0, spindle=12000.0)]


@pytest.fixture(scope="module")
def made() -> Plan:
    """Four blades that stand close above a floor, which keeps the large ball away from their feet."""
    corners = np.array([[[x, y, -6.5] for y in (-40.0, 40.0)] for x in (-40.0, 40.0)])
    floor = replace(ta.Face.from_bspline(corners, degree=(1, 1)), kind="plane")
    return ta.plan(wheel("", floor), TOOLS, 0.3, workers=1)


def test_every_blade_gets_the_operations_of_the_first_with_their_tools(made: Plan) -> None:
    assert made.blades is not None and len(made.blades.blades) == COUNT
    by_blade = {k: [op for op in made.operations if made.blades.blade_of(op.face.number) == k + 1]
                for k in range(COUNT)}
    tools = [sorted(op.tool.name for op in own) for own in by_blade.values()]
    assert tools[0] and all(one == tools[0] for one in tools)
    assert set(made.blades.copies.values()) <= {op.number for op in by_blade[0]}
    assert {"ball:8", "ball:2"} == set(tools[0]), "the small one finishes what the large one leaves"
    assert [op.number for op in made.operations] == list(range(1, len(made.operations) + 1))
    assert [op.tool.name for op in made.operations] == sorted((op.tool.name for op in made.operations), reverse=True)


def test_rests_are_those_of_operations_on_the_same_blade(made: Plan) -> None:
    assert made.blades is not None
    rests = [op for op in made.operations if op.rest_of]
    assert len(rests) >= COUNT
    by_number = {op.number: op for op in made.operations}
    for op in rests:
        for one in op.rest_of:
            assert by_number[one].face.number == op.face.number and by_number[one].tool.radius > op.tool.radius


def test_areas_of_all_blades_are_alike_and_add_up(made: Plan) -> None:
    assert made.blades is not None
    areas = [blade.area for blade in made.blades.blades]
    assert areas == pytest.approx([areas[0]] * COUNT, rel=1e-6)
    assert sum(areas) == pytest.approx(made.account.area, rel=1e-6)
    account = made.account
    assert account.unreachable > 1e-3 * account.area and made.outcome == "incomplete", "no ball reaches the corner"
    left = sum(blade.left for blade in made.blades.blades)
    assert left == pytest.approx(account.open + account.unreachable, abs=1e-6 * sum(areas))
    assert account.open < 0.1 * left, "what is proven on the first blade holds on its copies"


def test_the_judge_passes_all_of_it(made: Plan) -> None:
    assert all(op.passed for op in ta.verify(made).operations)
