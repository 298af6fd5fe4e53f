"""The jobs of a batch: read from TOML or given as mappings, checked all before the first one begins."""

import hashlib
import json
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import isfinite, radians
from os import PathLike
from pathlib import Path
from typing import Any

from toolaxis import __version__
from toolaxis.batch.task import BatchTask, PartBytes
from toolaxis.cad.load import load
from toolaxis.errors import InvalidInput, ToolAxisError
from toolaxis.job.inputs.rack_inputs import RackInputs, check_rack_inputs
from toolaxis.job.inputs.spec import Spec, numbers_to_avoid, parse_allowances
from toolaxis.job.inputs.tool_library import GENERAL_RACK, load_library
from toolaxis.job.planning.earlier_setups import check_after
from toolaxis.machine.library import load_machine, machine_to_toml
from toolaxis.machine.limits import parse_limits
from toolaxis.machine.machine import Machine
from toolaxis.partition.partition import check_count
from toolaxis.plan.document import tool_document
from toolaxis.plan.part_document import part_document
from toolaxis.plan.plan import PlanInputs
from toolaxis.shape.work_origin import format_margins, parse_margins
from toolaxis.strategies.inputs import check_strategy
from toolaxis.strategies.strategy import INDEXED, Asked
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

_INPUTS = {"scallop": float, "allowance": float, "stock": float, "greatest_step_over": float,
           "method": str, "objective": str, "direction": str,
           "limits": str, "feedrate": float, "spindle": float, "rapid": float, "tolerance": "tolerance", "limit": float,
           "passes": str, "avoid": "avoided", "held": str, "allowance_on": "allowances", "lead": float,
           "origin": str, "stock_box": "margins"}
#: What is written among the tolerances of a plan.
_OF_TOLERANCE = {"least_lean": float, "clearances": "clearances"}
_ASKED = {"faces": str, "holder": str, "stickout": float, "regions": "count", "orientations": "count", "offset": str}
_OWN = {"compare": bool, "verify": bool, "pictures": bool, "minutes": float, "timeout": float, "memory": float,
        "strategy": str, "roughness": float}
#: What has to be above zero where it is given.
_ABOVE_ZERO = ("minutes", "timeout", "memory")
#: What tools have of their own, or goes by how many there are, unless a job says it.
_OF_TOOL = ("objective", "feedrate", "spindle")
#: What a job may say, besides its part, tool, obstacles and machine, which need not be words.
KEYS = ("name", "part", "tool", "tools", "machine", "obstacles", "after", *_INPUTS, *_OF_TOLERANCE, *_ASKED, *_OWN)
_NAME = re.compile(r"[\w+-][\w.+ -]*", re.ASCII)


@dataclass(frozen=True, eq=False)
class CheckedJob:
    """A job that was checked.

    Attributes
    ----------
    name : str
        Also that of its folder.
    spec : Spec
        Paths are those that were given, from the job file's folder.
    tools : tuple of Tool
        One, or a rack.
    machine : Machine or None
    bodies : tuple
        The part, then the obstacles: paths, or what `toolaxis.load` made of objects.
    own : dict
        compare, strategy, roughness (micrometres, or None), verify, pictures, minutes, timeout and memory; objective,
        feedrate and spindle where they are given, else None: tools of a rack have rates of their own.
    key : str
        SHA-256 of all that the plan depends on: the same for the same plan, another one for another.
    after : dict of str to str
        Jobs for the setups before this one, the first one first, with their keys.
    """

    name: str
    spec: Spec
    tools: tuple[Tool, ...]
    machine: Machine | None
    bodies: tuple[Any, ...]
    own: dict[str, Any]
    key: str
    after: dict[str, str]

    def task(self) -> BatchTask:
        """What a process needs to carry it out.

        Raises
        ------
        InvalidInput
            When a file cannot be read any more, or is another one than when the batch began.
        """
        part, *obstacles = (_source(body) for body in self.bodies)
        if _key(self.spec, self.tools, self.machine, self.own, (part, *obstacles), self.after) != self.key:
            raise InvalidInput(f"{part.name}: a file of the job was changed while the batch ran: run it again")
        inputs = self.spec.inputs
        options = {**{name: getattr(inputs, name) for name in _INPUTS if name != "scallop"},
                   "scallop": inputs.scallop, "faces": self.spec.numbers, "regions": self.spec.regions,
                   "orientations": self.spec.orientations, "offset": self.spec.place, "compare": self.own["compare"],
                   "strategy": self.own["strategy"], "roughness": _in_mm(self.own["roughness"]),
                   **{name: self.own[name] for name in _OF_TOOL}}
        return BatchTask(self.name, self.key, part, tuple(obstacles), self.tools, self.machine, options,
                         self.own["verify"], self.own["pictures"], self.own["minutes"], self.own["timeout"],
                         self.own["memory"], __version__)


def read_jobs(jobs: str | PathLike[str] | Iterable[Mapping[str, Any]]) -> tuple[CheckedJob, ...]:
    """The jobs of a batch, all checked.

    Parameters
    ----------
    jobs : path or iterable of mappings
        A TOML file with [[jobs]] and, if need be, [defaults] for all of them; or the jobs themselves, whose part may be
        anything that `toolaxis.load` takes and whose tool may be a Tool, or several.  Paths in a file are meant from
        its folder.  A job without a tool has the general rack.

    Returns
    -------
    tuple of CheckedJob

    Raises
    ------
    InvalidInput
        When the file cannot be read, a key is not known, a value is wrong, or two jobs have one name.
    """
    if isinstance(jobs, str | PathLike):
        rows, folder = _table(Path(jobs)), Path(jobs).parent
    else:
        rows, folder = [dict(row) for row in jobs], Path()
    if not rows:
        raise InvalidInput("the batch has no jobs: give at least one, under [[jobs]]")
    made: list[CheckedJob] = []
    for number, row in enumerate(rows, 1):
        made.append(_check_job(row, number, folder, {one.name: one.key for one in made}))
    first: dict[str, int] = {}
    for number, one in enumerate(made, 1):
        other = first.setdefault(one.name.casefold(), number)
        if other != number:
            raise InvalidInput(f"jobs {other} and {number} are both called {one.name!r}: give each a name of its own")
    return tuple(made)


def _table(path: Path) -> list[dict[str, Any]]:
    """The rows of a job file, each with the defaults."""
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise InvalidInput(f"job file {path} does not exist") from None
    except (OSError, UnicodeDecodeError) as reason:
        raise InvalidInput(f"job file {path} cannot be read: {reason}") from reason
    except tomllib.TOMLDecodeError as reason:
        raise InvalidInput(f"job file {path.name} is not valid TOML: {reason}") from reason
    unknown = sorted(set(found) - {"defaults", "jobs"})
    if unknown:
        raise InvalidInput(f"job file {path.name} has an unknown {unknown[0]!r}: write [defaults] and [[jobs]]")
    defaults, rows = found.get("defaults", {}), found.get("jobs", [])
    if not isinstance(defaults, dict) or not isinstance(rows, list) or not all(isinstance(r, dict) for r in rows):
        raise InvalidInput(f"job file {path.name}: [defaults] is one table, and each job a table [[jobs]]")
    for name in ("name", *sorted(set(defaults) - set(KEYS))):
        if name in defaults:
            raise InvalidInput(f"job file {path.name}: [defaults] has {name!r}, which "
                               + ("is each job's own" if name == "name" else f"no job has: use {', '.join(KEYS)}"))
    return [{**defaults, **row} for row in rows]


def _check_job(row: dict[str, Any], number: int, folder: Path, before: Mapping[str, str]) -> CheckedJob:
    """A job that is right; `before` has the keys of those that stand before it, by their names."""
    said = row.get("name")
    try:
        return _check_row(row, folder, before)
    except ToolAxisError as reason:
        raise InvalidInput(f"job {number}{f' ({said})' if isinstance(said, str) else ''}: {reason}") from reason


def _check_row(row: dict[str, Any], folder: Path, before: Mapping[str, str]) -> CheckedJob:
    unknown = sorted(set(row) - set(KEYS))
    if unknown:
        raise InvalidInput(f"unknown {unknown[0]!r}: use {', '.join(KEYS)}")
    for name in ("part", "scallop"):
        if name not in row:
            raise InvalidInput(f"there is no {name!r}: each job needs a part and a scallop")
    obstacles = row.get("obstacles", ())
    bodies = tuple(_body(body, folder) for body in
                   (row["part"], *(obstacles if isinstance(obstacles, list | tuple) else (obstacles,))))
    kinds = {**_INPUTS, **_OF_TOLERANCE, **_ASKED, **_OWN}
    values = {name: _value(name, row[name], kind) for name, kind in kinds.items() if name in row}
    if "least_lean" in values:
        tolerance = values.get("tolerance", Tolerance())
        values["tolerance"] = replace(tolerance, least_lean=radians(values["least_lean"]))
    if "clearances" in values:
        values["tolerance"] = values.get("tolerance", Tolerance()).with_clearances(values["clearances"])
    if values.get("limits"):
        parse_limits(values["limits"])
    if "holder" in values:
        values["holder"] = _file_beside(values["holder"], folder)
    machine = row.get("machine") or None
    machine = load_machine(_file_beside(machine, folder)) if isinstance(machine, str) else machine
    named = _sources(row, folder)
    words = " ".join(one.name if isinstance(one, Tool) else one for one in named)
    spec = Spec(_title(bodies[0]), words or GENERAL_RACK,
                PlanInputs(**{name: values[name] for name in _INPUTS if name in values}),
                obstacles=tuple(map(_title, bodies[1:])), machine="" if machine is None else machine.name,
                **{name: values[name] for name in _ASKED if name in values})
    tools = _tools(named, "tools" in row, spec)
    _check_rest(spec, machine)
    own: dict[str, Any] = {"compare": False, "verify": False, "pictures": False, "minutes": None, "timeout": None,
           "memory": None, "strategy": INDEXED, "roughness": None,
           **{name: values[name] for name in _OWN if name in values}, **{name: values.get(name) for name in _OF_TOOL}}
    chosen = check_strategy(own["strategy"], Asked(
        tools[0], machine, spec.inputs.method, spec.inputs.objective, _in_mm(own["roughness"]), spec.orientations,
        passes=spec.inputs.passes, least_lean=spec.inputs.tolerance.least_lean,
        greatest_step_over=spec.inputs.greatest_step_over, lead=spec.inputs.lead))
    if len(tools) > 1:
        check_rack_inputs(RackInputs(spec.inputs.method, chosen.moves, spec.regions,
                                     spec.orientations is not None, compare=own["compare"]))
    after = _earlier_jobs(row, before)
    if after:
        check_after(chosen, named=bool(spec.faces))
    key = _key(spec, tools, machine, own, tuple(map(_source, bodies)), after)
    return CheckedJob(_name(row, bodies[0]), spec, tools, machine, bodies, own, key, after)


def _earlier_jobs(row: Mapping[str, Any], before: Mapping[str, str]) -> dict[str, str]:
    """The jobs after which a job goes on, with their keys."""
    given = row.get("after", [])
    names = given if isinstance(given, list | tuple) else [given]
    for name in names:
        if not isinstance(name, str) or name not in before:
            raise InvalidInput(f"after is {name!r}: give the name of a job that stands before this one, or a list of "
                               "such names")
    return {name: before[name] for name in names}


def _sources(row: Mapping[str, Any], folder: Path) -> list[Any]:
    """What a job names of tools and libraries, files from its folder; nothing where it names none."""
    found: list[Any] = []
    for name in ("tool", "tools"):
        given = row.get(name, [])
        for one in given if isinstance(given, list | tuple) else [given]:
            if not isinstance(one, Tool | str):
                raise InvalidInput(f"{name} is {one!r}: give a text, a Tool, or a list of them")
            found.append(one if isinstance(one, Tool) else _beside(one, folder))
    if not found and any(name in row for name in ("tool", "tools")):
        raise InvalidInput("the rack is empty: name at least one tool, library or folder")
    return found


def _in_mm(roughness: float | None) -> float | None:
    """Ra as it is planned with, from micrometres."""
    return None if roughness is None else roughness / 1000


def _check_rest(spec: Spec, machine: Machine | None) -> None:
    _ = spec.numbers, spec.place
    check_count(spec.regions)
    check_count(spec.orientations, "orientations")
    if machine is not None and not isinstance(machine, Machine):
        raise InvalidInput(f"machine is a {type(machine).__name__}: give a Machine, its name or its file")
    if machine is None and spec.place is not None:
        raise InvalidInput("a place of the part on the table is given without a machine: name the machine too")


def _tools(named: Sequence[Any], of_library: bool, spec: Spec) -> tuple[Tool, ...]:
    """The tools that a job names; the general rack where it names none."""
    if spec.holder or spec.stickout is not None:
        if of_library or len(named) != 1:
            raise InvalidInput("a holder or stick-out is given beside several tools: let each have its own, and leave "
                               "them out")
        if isinstance(named[0], Tool):
            raise InvalidInput("the tool is a Tool, which has its own holder and stick-out: leave them out")
        return (spec.resolved_tool(),)
    found = load_library(list(named) or None).tools
    if len(found) == 1:
        spec.inputs.check_tool(found[0])
    else:
        spec.inputs.check_lean(found)
    return found


def _body(given: Any, folder: Path) -> Any:
    """A path, from the job file's folder, or the part that an object makes."""
    if not isinstance(given, str | PathLike):
        return load(given)
    path = folder / given
    if not path.is_file():
        raise InvalidInput(f"part {str(path)!r} does not exist" if str(given) else "the path of the part is empty")
    return path


def _title(body: Any) -> str:
    return str(body) if isinstance(body, Path) else str(body.source)


def _beside(text: str, folder: Path) -> str:
    """A file or folder beside the job file where there is one of that name, else the text as it is."""
    path = folder / text
    return str(path) if text and path.exists() else text


def _file_beside(text: str, folder: Path) -> str:
    """A file beside the job file where there is one of that name, else the text as it is."""
    path = folder / text
    return str(path) if path.is_file() else text


def _name(row: Mapping[str, Any], body: Any) -> str:
    name = row.get("name")
    if name is None:
        if not isinstance(body, Path):
            raise InvalidInput("there is no 'name': a job whose part is no file needs one")
        name = body.stem
    if not isinstance(name, str) or not _NAME.fullmatch(name) or len(name) > 100 or name.endswith(" "):
        raise InvalidInput(f"name {name!r} makes no folder: use at most 100 letters, digits and . + - _, not with a "
                           "dot first")
    return name


def _value(name: str, value: Any, kind: Any) -> Any:
    """A value of the kind that its key asks for; lists of numbers become the short forms of the command."""
    if kind is float:
        number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
        if not number or (name in _ABOVE_ZERO and value <= 0):
            above = " above zero" if name in _ABOVE_ZERO else ""
            raise InvalidInput(f"{name} is {value!r}: give a finite number{above}")
        return float(value)
    if kind in ("count", "clearances"):  # looked at where they are taken
        return value
    if kind == "avoided":
        return numbers_to_avoid(value)
    if kind == "allowances":
        return parse_allowances(value)
    if kind == "margins":
        return format_margins(parse_margins(value))
    if kind == "tolerance":
        return Tolerance.of(value)
    if kind is str and name in ("faces", "offset", "holder") and not isinstance(value, str | bool):
        return _short(name, value)
    if not isinstance(value, kind):
        raise InvalidInput(f"{name} is {value!r}: give {'true or false' if kind is bool else 'a text'}")
    return value


def _short(name: str, value: Any) -> str:
    rows = value if isinstance(value, list | tuple) else [value]
    inner, outer = {"faces": ("+", ","), "offset": (",", ","), "holder": (",", ";")}[name]
    return outer.join(inner.join(map(str, row)) if isinstance(row, list | tuple) else str(row) for row in rows)


def _source(body: Any) -> PartBytes:
    """A body as bytes."""
    if isinstance(body, Path):
        try:
            content = body.read_bytes()
        except OSError as reason:
            raise InvalidInput(f"part {str(body)!r} cannot be read ({reason.strerror})") from reason
        return PartBytes(str(body), content, hashlib.sha256(content).hexdigest())
    content = json.dumps(part_document(body), allow_nan=False).encode()
    return PartBytes(body.source, content, hashlib.sha256(content).hexdigest(), document=True)


def _key(spec: Spec, tools: Sequence[Tool], machine: Machine | None, own: Mapping[str, Any],
         sources: tuple[PartBytes, ...], after: Mapping[str, str]) -> str:
    asked = {**{name: getattr(spec, name) for name in ("faces", "regions", "orientations", "offset")},
             "inputs": asdict(spec.inputs), "tools": [tool_document(tool) for tool in tools],
             **{name: own[name] for name in _OF_TOOL},
             "machine": "" if machine is None else machine_to_toml(machine),
             "sources": [source.sha256 for source in sources], "version": __version__,
             **{name: own[name] for name in ("compare", "verify", "pictures", "strategy")},
             **{name: own[name] for name in ("roughness", "minutes") if own[name] is not None},
             **({"after": list(after.values())} if after else {})}
    return hashlib.sha256(json.dumps(asked, sort_keys=True).encode()).hexdigest()
