"""The machine of a plan as JSON: its own file's text, where the part stands on it, and the angles of operations."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.machine.kinematics import placement
from toolaxis.machine.library import machine_from_toml, machine_to_toml
from toolaxis.machine.setup import Mounting
from toolaxis.plan.operation import Operation

Array = NDArray[np.float64]

#: Angle by which rotary axes may differ and still stand at one place, whole turns aside, rad.
SAME = 1e-6


def machine_document(mounting: Mounting | None) -> dict[str, Any] | None:
    """A machine with a part on it, as `json.dump` takes it; None for none.

    Parameters
    ----------
    mounting : Mounting or None
    """
    if mounting is None:
        return None
    place = mounting.table_from_part
    return {"name": mounting.machine.name, "kind": mounting.machine.kind, "toml": machine_to_toml(mounting.machine),
            "table_from_part": None if place is None else placement(place).tolist()}


def machine_from(document: Mapping[str, Any] | None) -> Mounting | None:
    """The machine that `machine_document` wrote.

    Parameters
    ----------
    document : mapping or None

    Raises
    ------
    InvalidInput
        When its text describes no machine, or the place is no rigid motion.
    """
    if document is None:
        return None
    return Mounting(machine_from_toml(document["toml"]), document["table_from_part"])


def rotary_of(mounting: Mounting | None, op: Operation, tool_length: float | None = None) -> Array:
    """Rotary angles at which a machine holds an operation, (s, m) rad: all solutions inside ranges and travel.

    Parameters
    ----------
    mounting : Mounting or None
    op : Operation
    tool_length : float, optional
        From the spindle's gauge point to the tip, mm.

    Returns
    -------
    (s, m) array
        The one at which it is carried out first, where that is known, else that with the least turns from zero; empty
        without a machine or passes, and where the axis moves.
    """
    if mounting is None or op.path is None or op.orientation.axis is None or op.orientation.lead is not None:
        return np.empty((0, 0))
    known = Mounting(mounting.machine, mounting.table_from_part, tool_length)
    rows = known.hold_side(op.path.cl, op.orientation.axis)
    if not op.rotary or not len(rows):
        return rows
    off = np.mod(rows - np.array(op.rotary) + np.pi, 2 * np.pi) - np.pi
    return np.vstack([op.rotary, rows[np.abs(off).max(axis=1) > SAME]])
