"""Found: "comes within 0.11 mm of face 88, less than the required 0.1 mm": the search's own margin was not told."""

import re

import numpy as np

import toolaxis as ta


def _flat(*rows: list[float]) -> ta.Face:
    p, a, b = np.array(rows, dtype=float)
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def test_a_refusal_for_want_of_room_adds_up() -> None:
    """Plates all around, 1.005 mm below the holder's lower face."""
    tool = ta.Tool.ball(diameter=4, flute_length=4, stickout=10, holder=[(10, 0), (10, 30)])
    plates = [_flat([x, -40, 8.995], [0, 90, 0], [30, 0, 0]) for x in (-34, 18)]
    plates += [_flat([-40, y, 8.995], [0, 30, 0], [90, 0, 0]) for y in (-34, 12)]
    floor = _flat([0, 0, 0], [14, 0, 0], [0, 8, 0])
    found = ta.best_axis(floor, tool, 0.2, "cone:0,0,1,0.5", obstacles=plates)
    text = next(why for why in found.reasons if "comes within" in why)
    told = re.search(r"within ([\d.]+) mm of face \d+ at .*; ([\d.]+) mm is required, and ([\d.]+) mm more to", text)
    distance, required, margin = map(float, told.groups())
    assert distance <= required + margin + 1e-9
