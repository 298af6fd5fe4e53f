"""`toolaxis post`: NC programs and CL files from a plan's folder, and both from CL data made elsewhere."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cad.machines import load_machine
from toolaxis.cli.output import print_json, say
from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import read_plan, stage_folder
from toolaxis.job.files.read_cl import read_cl
from toolaxis.job.inputs.spec import offset_from
from toolaxis.job.output.post import post_plan, verdict_of
from toolaxis.job.output.repost import repost_locations
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.apt import locations_text
from toolaxis.post.context import Options
from toolaxis.post.dialects.registry import APT
from toolaxis.report.verdict_words import PASSED


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Write the program and its setup sheet into the plan's folder.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop; the work takes a moment and is not stopped.

    Returns
    -------
    int
        0, or 1 where an operation of the plan has no axis and is not in the program.
    """
    folder = Path(given.folder)
    if folder.is_file():
        return _repost_file(given, folder)
    options = Options(given.retract, _words(given.clamp), _words(given.unclamp))
    plan = read_plan(folder)
    verdict = verdict_of(folder)
    files = post_plan(plan, given.dialect, _mounting(given, plan), options, name=folder.resolve().name,
                      verdict=verdict)
    with stage_folder(folder) as stage:
        for name, text in files.items():
            (stage.folder / name).write_text(text, encoding="utf-8")
        stage.publish()
    missing = [op.name for op in plan.operations if not op.done]
    if given.json:
        print_json({"dialect": given.dialect, "files": [str(folder / name) for name in files], "verdict": verdict,
                    "missing": missing})
    for name in files:
        say(f"toolaxis: {folder / name}")
    if verdict != PASSED:
        say(f"toolaxis: warning: verdict on the operations: {verdict}")
    if missing:
        say(f"toolaxis: not in the program, for want of an axis: {', '.join(missing)}")
    return 1 if missing else 0


def _repost_file(given: Namespace, file: Path) -> int:
    """Write CL data that were made elsewhere, an APT file or a program, beside them: as APT, or as a program."""
    offset = offset_from(given.offset) if given.offset else None
    source = given.source or given.machine
    found = read_cl(file, source or None, offset=offset if given.source in (None, given.machine) else None)
    if given.dialect == APT:
        files = {f"{file.stem}.apt": locations_text(found, file.stem)}
    elif not given.machine:
        raise InvalidInput(f"dialect {given.dialect} writes rotary angles: give --machine, the one that the program is "
                           "for")
    else:
        options = Options(given.retract, _words(given.clamp), _words(given.unclamp))
        files = repost_locations(found, given.dialect, Mounting(load_machine(given.machine), offset), options,
                                 name=file.stem, feedrate=given.feedrate, spindle=given.spindle)
    targets = []
    for name, text in files.items():
        target = file.with_name(name)
        target = target if target.resolve() != file.resolve() else file.with_name(f"{file.stem}-again{target.suffix}")
        target.write_text(text, encoding="utf-8")
        targets.append(str(target))
    if given.json:
        print_json({"dialect": given.dialect, "files": targets, "points": len(found.tip)})
    for each in targets:
        say(f"toolaxis: {each}: {len(found.tip)} points")
    return 0


def _mounting(given: Namespace, plan: Plan) -> Mounting | None:
    """The machine that was given, else the plan's own, with the part where it was said to stand."""
    offset = offset_from(given.offset) if given.offset else None
    if given.machine:
        return Mounting(load_machine(given.machine), offset)
    if plan.machine is None:
        return None
    return Mounting(plan.machine.machine, plan.machine.table_from_part if offset is None else offset)


def _words(text: str) -> tuple[str, ...]:
    return tuple(word.strip() for word in text.split(",")) if text else ()
