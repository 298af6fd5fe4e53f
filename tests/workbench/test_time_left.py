"""How long a computation may still take, from reports with times that are made up."""

import pytest
from freecad.toolaxis.services.time_left import TimeLeft, clock


def test_nothing_is_said_of_what_is_soon_done():
    left = TimeLeft(100.0)
    assert left.words("looking for blades", 0.5, 104.0) == ""
    assert left.words("looking for blades", -1.0, 107.0) == "7 s so far"


def test_a_step_tells_what_is_left_of_it():
    left = TimeLeft(0.0)
    left.words("axes at the lattice", 0.0, 10.0)
    assert left.words("axes at the lattice", 0.05, 12.0) == "12 s so far"
    assert left.words("axes at the lattice", 0.25, 20.0) == "20 s so far, about 30 s left of this step"


@pytest.mark.parametrize("count", [2, 9])
def test_pieces_that_take_the_same_are_told_rightly(count):
    """Each takes 20 s; nothing is told as long as none is done."""
    left = TimeLeft(-30.0)
    for second in range(20 * count):
        words = left.words(f"face 4a ({second // 20 + 1} of {count}): axes", -1.0, float(second))
        if second < 20:
            assert words == f"{clock(second + 30)} so far"
            continue
        rest = words.removeprefix(f"{clock(second + 30)} so far, about ").removesuffix(" left")
        minutes, _, seconds = rest.split()[0].rpartition(":")
        told = 60 * int(minutes or 0) + int(seconds)
        assert abs(told - max(20 * count - second, 5)) <= 2.5


def test_another_number_of_pieces_begins_anew():
    left = TimeLeft(0.0)
    for second in range(20):
        left.words(f"face 4a ({1 + second // 10} of 2): axes", -1.0, float(second))
    assert left.words("proof (1 of 16)", -1.0, 20.0) == "20 s so far"


def test_pieces_of_one_tool_are_not_all_the_work():
    """Found: what was left of the pieces of one tool was told as what was left of all tools."""
    left = TimeLeft(-30.0)
    for second in range(40):
        words = left.words(f"Ball D2: reach: face 4.2a ({second // 20 + 1} of 3): axes", -1.0, float(second))
    assert words == "1:09 min so far, about 20 s left of this step"


def test_what_follows_on_pieces_is_not_told_by_them():
    """Found: "about 10 s left", from the last pieces of a tool, all through the proof that followed."""
    left = TimeLeft(-30.0)
    for second in range(40):
        left.words(f"face 4a ({second // 20 + 1} of 3): axes", -1.0, float(second))
    for second in range(40, 60):
        words = left.words("proof of what is out of reach", 0.0, float(second))
        assert words == f"{clock(second + 30)} so far"


def test_minutes_have_seconds():
    assert [clock(seconds) for seconds in (0.4, 59, 60, 125.6)] == ["0 s", "59 s", "1:00 min", "2:06 min"]
