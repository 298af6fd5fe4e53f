"""Whether a machine can follow cutter locations: every point by inverse kinematics, in one of its solutions."""

from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.machine.kinematics import forward, inverse
from toolaxis.machine.machine import Machine

Array = NDArray[np.float64]

#: By how much joints may miss their limits, mm and rad, and locations be missed when the joints are turned back, mm.
_ROUNDING = 1e-6


def machine_faults(machine: Machine, tips: Array, axes: Array, place: Array | None,
                   tool_length: float | None) -> list[str]:
    """What keeps a machine from following cutter locations with its rotary axes in one solution.

    Parameters
    ----------
    machine : Machine
    tips, axes : (n, 3) array
        mm, part's frame.
    place : (4, 4) or (3,) array, optional
        Where the part stands on the table.
    tool_length : float, optional
        From the gauge point to the tip, mm; without it or the place the travel of the linear axes is not judged.

    Returns
    -------
    list of str
        Sentences; empty where every location can be taken.
    """
    travel = place is not None and tool_length is not None
    found = inverse(machine, tips, axes, tool_length or 0.0, place)
    if not found.reached.all():
        k = int(np.argmin(found.reached))
        return [f"{machine.name} has no position for the axis {np.round(axes[k], 4).tolist()} of point {k + 1}"]
    sentences = []
    for branch in range(found.joints.shape[1]):
        joints = found.joints[:, branch]
        back = forward(machine, joints, tool_length or 0.0, place)
        wrong = max(float(np.abs(back[0] - tips).max()), float(np.abs(back[1] - axes).max()))
        if wrong > _ROUNDING * max(1.0, float(np.abs(tips).max())):
            sentences.append(f"{machine.name} misses a cutter location by {wrong:.2g} mm")
            continue
        worst = _worst(machine, joints, travel)
        if worst is None:
            return []
        sentences.append(worst)
    return sentences[:1]


def _worst(machine: Machine, joints: Array, travel: bool) -> str | None:
    """The limit that is missed most in one solution, in words."""
    for i, turn in enumerate(machine.rotary):
        off = np.maximum(turn.low - joints[:, 3 + i], joints[:, 3 + i] - turn.high)
        if off.max() > _ROUNDING:
            k = int(np.argmax(off))
            return (f"{turn.name} of {machine.name} would stand {degrees(float(off[k])):.3f} deg beyond its range at "
                    f"point {k + 1}")
    for i, axis in enumerate(machine.linear if travel else ()):
        off = np.maximum(axis.low - joints[:, i], joints[:, i] - axis.high)
        if off.max() > _ROUNDING:
            k = int(np.argmax(off))
            return f"{axis.name} of {machine.name} would leave its travel by {float(off[k]):.3f} mm at point {k + 1}"
    return None
