"""What a plan's blades say of operations after these got other numbers."""

import numpy as np

from toolaxis.plan.blades import BladeClearance, Blades, Gap


def test_copies_searched_operations_and_rooms_follow_their_operations() -> None:
    gap = Gap(1.0, np.zeros((2, 3)))
    blades = Blades(np.zeros(3), np.array([0.0, 0, 1]), (), (), gap, {2: 1, 4: 1}, (3,),
                    (BladeClearance("hub", "cutter", 1.0, 3, 7), BladeClearance("hub", "holder", 20.0)))
    found = blades.renumbered({1: 4, 2: 3, 3: 1, 4: 2})
    assert found.copies == {3: 4, 2: 4} and found.searched == (1,)
    assert [(one.operation, one.face) for one in found.room] == [(1, 7), (0, 0)]
