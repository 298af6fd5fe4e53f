"""`toolaxis reschedule`: CL data around a blade that were made elsewhere, with new tool angles."""

from argparse import Namespace
from collections.abc import Callable
from math import degrees
from pathlib import Path

import numpy as np

from toolaxis.cad.load import load
from toolaxis.cad.machines import load_machine
from toolaxis.cli.display import show_progress
from toolaxis.cli.output import print_json, print_table, say
from toolaxis.errors import InvalidInput
from toolaxis.job.files.read_cl import read_cl
from toolaxis.job.inputs.spec import offset_from
from toolaxis.job.inputs.tool_file import load_holder, load_tool
from toolaxis.job.output.reschedule import NewAngles, reschedule
from toolaxis.machine.setup import Mounting
from toolaxis.post.apt import locations_text
from toolaxis.report.tables import table
from toolaxis.tools.tool import Tool


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Read, re-schedule, write an APT file, and print how the rotary axis turned and turns.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0
    """
    file = Path(given.file)
    target = Path(given.out) if given.out else file.with_name(f"{file.stem}-rescheduled.apt")
    if target.resolve() == file.resolve():
        raise InvalidInput(f"--out {target} is the file that is read: give another one")
    offset = offset_from(given.offset) if given.offset else None
    mounting = Mounting(load_machine(given.machine), offset) if given.machine else None
    found = read_cl(file, given.machine or None, offset=offset)
    tool, faces = _tool(given), load(given.part).faces if given.part else ()
    about = None if given.about is None else _direction(given.about)
    with show_progress(asked) as progress:
        made = reschedule(found, tool, curve=given.curve, direction=about, faces=tuple(faces), depth=given.depth,
                          mounting=mounting, progress=progress)
    target.write_text(locations_text(made.locations, file.stem, tool), encoding="utf-8")
    return _print_rescheduled(given, made, target)


def _print_rescheduled(given: Namespace, made: NewAngles, target: Path) -> int:
    rows = [(name, turning.backwards, degrees(turning.steepest), degrees(turning.total)) for name, turning in
            (("as read", made.before), ("re-scheduled", made.after))]
    if given.json:
        print_json({"file": str(target), "turns": len(made.made.layers), "held_against_part": made.clear,
                    **{name.replace(" ", "_").replace("-", "_"): {"turns_back": back, "deg_per_mm": steep, "deg": total}
                       for name, back, steep, total in rows}})
    else:
        columns = ("rotary axis", "left"), ("turns back", "right"), ("deg/mm at most", "right"), ("deg in all", "right")
        print_table(table("", columns, [(name, str(back), f"{steep:.3f}", f"{total:.1f}")
                                        for name, back, steep, total in rows]))
    say(f"toolaxis: {target}: {len(made.made.layers)} turns around the blade")
    if not made.clear:
        say("toolaxis: warning: nothing was held against the part: give --part")
    return 0


def _tool(given: Namespace) -> Tool:
    body = load_holder(given.holder) if given.holder else {}
    if given.stickout is not None:
        body["stickout"] = given.stickout
    return load_tool(given.tool, **body)


def _direction(text: str) -> np.ndarray:
    try:
        found = np.array([float(word) for word in text.split(",")])
    except ValueError:
        found = np.zeros(0)
    if found.shape != (3,) or not np.isfinite(found).all() or not found.any():
        raise InvalidInput(f"--about {text} is no direction: give three numbers, not all zero, such as 1,0,0")
    return found
