"""From a plan's folder to a program and its setup sheet, or to CL files."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from toolaxis.errors import InvalidInput, PartMisplaced
from toolaxis.job.files.plan_folder import read_json
from toolaxis.job.planning.sequencing import sequence_operations
from toolaxis.machine.kinematics import placement
from toolaxis.machine.library import machine_to_toml
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.apt import operation_text
from toolaxis.post.context import Options
from toolaxis.post.dialects.registry import APT, dialect_named, tip_control_of
from toolaxis.post.indexed_positions import check_reach
from toolaxis.post.program import bare_program, program_of, program_text
from toolaxis.post.setup_sheet import moving_sheet_text, sheet_text
from toolaxis.post.tcp_program import moves, moving_text
from toolaxis.report.verdict_words import FAILED, name_verdict


def post_plan(plan: Plan, dialect: str, mounting: Mounting | None = None, options: Options | None = None,
              *, name: str = "toolaxis", verdict: str = "not verified yet") -> dict[str, str]:
    """The files of a plan in a dialect, by name.

    Parameters
    ----------
    plan : Plan
    dialect : str
        A name of `toolaxis.post.dialects.registry.dialects`, or apt.
    mounting : Mounting, optional
        The machine and where the part stands on it; needed by all dialects but apt.
    options : Options, optional
    name : str
        Of the program.
    verdict : str
        For the setup sheet.

    Returns
    -------
    dict of str to str
        Program and setup sheet; for apt one CL file per operation.

    Raises
    ------
    InvalidInput
        When the dialect is not known, needs a machine, or cannot express the plan; `PartMisplaced` where another
        place on the table may help, `AxisOutOfReach` where none does.
    """
    if dialect == APT:
        return {f"{op.name}.apt": operation_text(op, plan.inputs) for op in plan.operations if op.path is not None}
    found = dialect_named(dialect)
    if mounting is None:
        raise InvalidInput(f"dialect {dialect} writes rotary angles and the plan names no machine: give --machine")
    if len(plan.tools) == 1:
        plan, = plan.by_tool()  # at its feed and speed
        mounting = replace(mounting, tool_length=plan.tools[0].gauge_length or mounting.tool_length)
    chosen = Options() if options is None else options
    for op in plan.operations:
        if op.done and op.orientation.lead is None and op.number not in chosen.angles:
            check_reach(op, mounting)  # refused first, and at once: no other place on the table helps
    arranged_for = _choose_angles(plan, mounting)
    for op, stood in zip(plan.operations, arranged_for.operations, strict=True):
        if op.done and not stood.done:
            why = stood.orientation.reasons[0].removeprefix("infeasible: ")
            raise PartMisplaced(f"{op.name}: {why}; move the part on the table, or plan for this machine")
    if arranged_for.in_the_way:
        raise PartMisplaced(f"the machine collides between operations: {arranged_for.in_the_way[0]}; move the "
                            "part on the table, or plan again")
    angles = {op.number: op.rotary for op in arranged_for.operations if op.rotary}
    if moves(plan):
        control, file = tip_control_of(found), f"program-{dialect}{found.suffix}"
        text = moving_text(plan, mounting, control, options, name)
        sheet = moving_sheet_text(bare_program(plan, mounting, found, options, name), control, file, verdict)
        return {file: text, f"setup-{dialect}.md": sheet}
    program = program_of(arranged_for, mounting, found, replace(chosen, angles={**angles, **chosen.angles}), name)
    file = f"program-{dialect}{found.suffix}"
    sheet = sheet_text(program, found, file, verdict)
    return {file: program_text(program, found), f"setup-{dialect}.md": sheet}


def _choose_angles(plan: Plan, mounting: Mounting) -> Plan:
    """The plan at the rotary angles that it was made with on its own machine, else at the best ones in its order."""
    own = plan.machine
    same = own is not None and machine_to_toml(own.machine) == machine_to_toml(mounting.machine) and np.array_equal(
        placement(own.table_from_part), placement(mounting.table_from_part))
    if same and all(op.rotary or op.orientation.lead is not None for op in plan.operations if op.done):
        return plan
    made = [sequence_operations(replace(one, machine=mounting)) for one in plan.by_tool()]
    return replace(plan, operations=tuple(op for one in made for op in one.operations), machine=mounting,
                   in_the_way=tuple(why for one in made for why in one.in_the_way))


def verdict_of(folder: Path) -> str:
    """What verdict.json in a plan's folder says of the operations that were made, in a word or two.

    Parameters
    ----------
    folder : Path
    """
    path = folder / "verdict.json"
    if not path.is_file():
        return name_verdict(None)
    found = read_json(path)
    return name_verdict(found) if isinstance(found, dict) else FAILED
