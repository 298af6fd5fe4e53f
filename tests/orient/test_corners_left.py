"""Small places that no pass cuts: they go to another tool only where one comes anyway, and only if small."""

import numpy as np
import pytest

from toolaxis.path.mending import FurtherPasses
from toolaxis.plan.zone import Zone
from toolaxis.search import candidate_check

AREA = 1000.0
LOOP = (np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]),)


def left(*zones: Zone) -> FurtherPasses:
    """What passes leave; the passes themselves do not count."""
    return FurtherPasses(None, None, zones)  # type: ignore[arg-type]


@pytest.mark.parametrize(("wall", "corner", "undercut"), [
    (5.0, 2.0, 0.0),  # a smaller tool comes to the wall: it takes the corner too
    (0.0, 2.0, 2.0),  # no other tool comes
    (5.0, 10.1, 10.1),  # more than a hundredth of the face
], ids=["beside a wall", "alone", "too large"])
def test_a_corner_goes_to_the_tool_that_comes_anyway(wall: float, corner: float, undercut: float) -> None:
    zones = (Zone(LOOP, corner, at_wall=False),) + ((Zone(LOOP, wall),) if wall else ())
    found = candidate_check._leave_corners(left(*zones), AREA, anywhere=False)
    assert found.undercut == undercut and found.left == wall + corner, "nothing of what stays is lost"


@pytest.mark.parametrize(("corner", "undercut"), [(2.0, 0.0), (10.1, 10.1)], ids=["small", "too large"])
def test_a_corner_goes_to_the_next_tool_of_a_rack(corner: float, undercut: float) -> None:
    """A sub-surface of 18 mm^2 was lost as 0.05 mm^2 of it stayed high under each of two dozen axes."""
    found = candidate_check._leave_corners(left(Zone(LOOP, corner, at_wall=False)), AREA, anywhere=True)
    assert found.undercut == undercut and found.left == corner
