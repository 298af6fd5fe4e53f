"""CL data made elsewhere as the program of another machine: tips and axes stay, with tool centre point control."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import PlanInputs
from toolaxis.post.cl_points import CutterLocations
from toolaxis.post.context import Options
from toolaxis.post.dialects.registry import dialect_named, tip_control_of
from toolaxis.post.program import setting_of
from toolaxis.post.setup_sheet import course_sheet_text
from toolaxis.post.tcp_program import course_of, courses_text

#: Scallop height that stands where none was asked for, mm; nothing that is written depends on it.
_ANY = 0.01


def repost_locations(found: CutterLocations, dialect: str, mounting: Mounting, options: Options | None = None, *,
                     name: str = "toolaxis", feedrate: float | None = None, spindle: float | None = None,
                     rapid: float = 10000.0) -> dict[str, str]:
    """Program and setup sheet of cutter locations that were read, by name of their files.

    Parameters
    ----------
    found : CutterLocations
        From `toolaxis.read_cl`.
    dialect : str
        One that has tool centre point control.
    mounting : Mounting
        The machine that the program is for; the work offset is the origin of the locations.
    options : Options, optional
    name : str
        Of the program.
    feedrate, spindle : float, optional
        mm/min and rev/min, in place of what the locations tell; needed where they tell none.
    rapid : float
        Rate of motions that are rapid, mm/min.

    Raises
    ------
    InvalidInput
        When the dialect is not known or has no tool centre point control, the machine cannot follow, or a feed rate or
        the spindle speed is told nowhere.

    Notes
    -----
    **Property**: `toolaxis.post.read_nc.read_nc` of the program is what was given, to the digits that are written;
    points stand between where rotary axes would leave the way of the tool axis.
    """
    control = tip_control_of(dialect_named(dialect))
    rates = _rates(found, feedrate)
    speed = found.spindle if spindle is None else spindle
    if spindle is None and not speed > 0:
        raise InvalidInput("the CL data tells no spindle speed: give --spindle, rev/min")
    inputs = PlanInputs(_ANY, feedrate=float(rates[np.isfinite(rates)].max(initial=1.0)), spindle=speed, rapid=rapid)
    program = setting_of(inputs, mounting, control.dialect, options, name)
    control.check(program)
    course = course_of(name, found.path, rates, mounting)
    file = f"{name}-{dialect}{control.dialect.suffix}"
    return {file: courses_text(program, control, [course]),
            f"{name}-{dialect}-setup.md": course_sheet_text(program, control, course, file)}


def _rates(found: CutterLocations, feedrate: float | None) -> NDArray[np.float64]:
    """Feed rate on the way to each point, mm/min; infinite where rapid."""
    if feedrate is not None:
        return np.where(found.rapid, np.inf, feedrate)
    untold = np.flatnonzero(~found.rapid & ~np.isfinite(found.feedrate))
    if len(untold):
        raise InvalidInput(f"the CL data tells no feed rate for the motion to point {untold[0]}: give --feedrate, "
                           "mm/min")
    return found.feedrate
