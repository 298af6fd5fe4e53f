"""From a plan's folder to a program and its setup sheet, or to CL files."""

from pathlib import Path

from toolaxis.errors import InvalidInput
from toolaxis.job.folder import read_json
from toolaxis.machine.mounting import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.apt import apt_text
from toolaxis.post.dialects.known import APT, dialect_named
from toolaxis.post.gcode import Options, program_of, program_text
from toolaxis.post.sheet import sheet_text


def posted(plan: Plan, dialect: str, mounting: Mounting | None = None, options: Options | None = None,
           *, name: str = "toolaxis", verdict: str = "not judged yet") -> dict[str, str]:
    """The files of a plan in a dialect, by name.

    Parameters
    ----------
    plan : Plan
    dialect : str
        A name of `post.dialects.known`.
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
        When the dialect is not known, needs a machine, or cannot express the plan.
    """
    if dialect == APT:
        return {f"{op.name}.apt": apt_text(op.path, plan.tool, op.name, plan.inputs.feedrate, plan.inputs.spindle)
                for op in plan.operations if op.path is not None}
    found = dialect_named(dialect)
    if mounting is None:
        raise InvalidInput(f"dialect {dialect} writes rotary angles and the plan names no machine: give --machine")
    program = program_of(plan, mounting, found, options, name)
    file = f"program-{dialect}{found.suffix}"
    return {file: program_text(program, found), f"setup-{dialect}.md": sheet_text(program, found, file, verdict)}


def verdict_of(folder: Path) -> str:
    """What verdict.json in a plan's folder says, in a word or two.

    Parameters
    ----------
    folder : Path
    """
    path = folder / "verdict.json"
    if not path.is_file():
        return "not judged yet: run toolaxis verify"
    found = read_json(path)
    return "passed" if isinstance(found, dict) and found.get("passed") is True else "FAILED"
