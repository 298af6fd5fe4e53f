"""Operations of a document out as files: what the commands plan, post and report write, whole or not at all."""

import json
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from itertools import count
from math import inf
from pathlib import Path
from typing import NamedTuple

from freecad.toolaxis.document.blade_links import turned_copies
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.kinds import operations_in, plan_of
from freecad.toolaxis.document.machine import angles_kept, nearest
from freecad.toolaxis.document.machine_angles import in_order
from freecad.toolaxis.document.machine_limits import PREFIX, mounting
from freecad.toolaxis.document.plan_group import why_stale as why_plan_stale
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.document.read_shapes import ShapesRead
from freecad.toolaxis.document.stale_label import plain_label
from freecad.toolaxis.document.staleness import why_stale
from freecad.toolaxis.services.arguments import operation_of, progress_of
from freecad.toolaxis.services.background import one_line

#: What operations of one folder have in common, and how it is called in messages.
_SHARED = {"scallop": "scallop heights", "tolerance": "machining tolerances", "allowance": "allowances",
           "limits": "limits of the axis",
           "strategy": "strategies", "roughness": "roughness limits", "objective": "objectives",
           "direction": "directions", "passes": "kinds of passes", "stock": "heights of stock",
           "least_lean": "least leans", "greatest_step_over": "greatest step-overs",
           "allowance_on": "allowances on faces", "lead": "radii of lead-in and lead-out",
           "avoid_faces": "faces to avoid", "held": "clamped sides", "origin": "origins", "stock_box": "stocks"}
_JUDGED = {"passed": "passed", "failed": "FAILED"}


@dataclass(frozen=True)
class Wish:
    """What is written besides plan.json and the CL files.

    Attributes
    ----------
    dialect : str
        Of the program; empty for none.
    machine : str
        Name or file of the machine that the program is for; empty for none.
    offset : (3,) sequence of float, optional
        Where the origin of the document stands on the machine's table, mm.
    report : bool
        Whether the page is written.
    """

    dialect: str = ""
    machine: str = ""
    offset: tuple | None = None
    report: bool = False


class WriteOutcome(NamedTuple):
    """What came of writing.

    names : of the files, none where the machine cannot carry out the plan;  refusal : why not, English;  height : by
    how much the part is to be raised on its table, mm, 0 where that does not help.
    """

    names: list
    refusal: str = ""
    height: float = 0.0


def missing_for_report():
    """Names of the packages that the page needs and this Python does not have."""
    return [name for name in ("jinja2", "plotly") if find_spec(name) is None]


def export(operations, folder, wish=None, progress=None):
    """Write operations into a folder as the command does.

    Parameters
    ----------
    operations : App.DocumentObject or sequence of them
    folder : str or Path
        Files of an earlier plan in it are replaced, others stay.
    wish : Wish, optional
    progress : toolaxis.progress.Progress, optional

    Returns
    -------
    list of str
        Names of the files.

    Raises
    ------
    ToolAxisError
        In one sentence; the folder is then as it was.
    """
    several = operations if isinstance(operations, list | tuple) else [operations]
    return task([operation_of(one) for one in several], folder, wish)(progress_of(progress))


def task(operations, folder, wish=None):
    """The writing of operations, as a computation apart from the document.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
    folder : str or Path
    wish : Wish, optional

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress` and returns the names of the files; for any thread.

    Raises
    ------
    InvalidInput
        When an operation is stale or has no part any more, or operations do not go together.
    """
    gather, verdict = plan_task(operations), _verdict(operations)
    wish = Wish() if wish is None else wish

    def compute(progress):
        return _write(gather(progress), Path(folder), wish, (verdict, progress))

    return compute


def with_remedy(compute):
    """The writing of operations that looks for what helps where the machine cannot carry them out.

    Parameters
    ----------
    compute : callable
        Of `task`.

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress` and returns a `WriteOutcome`.
    """

    def compute_or_look(progress):
        from toolaxis.errors import AxisOutOfReach, PartMisplaced

        try:
            return WriteOutcome(compute(progress))
        except PartMisplaced as reason:
            return WriteOutcome([], one_line(reason), reason.missing_height(progress))
        except AxisOutOfReach as reason:
            return WriteOutcome([], one_line(reason))

    return compute_or_look


def plan_task(operations):
    """The plan that stands in a document, as a computation apart from it.

    Parameters
    ----------
    operations : sequence of App.DocumentObject

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress` and returns a `toolaxis.plan.plan.Plan`; for any thread.

    Raises
    ------
    InvalidInput
        When an operation is stale or has no part any more, or operations do not go together.
    """
    inputs = [_inputs(operation) for operation in operations]
    together = _together(operations, inputs)
    source, rows = ShapesRead.of(together), []
    offsets = _offsets(together)
    tools, places = _tools_of(inputs)
    for operation, one, place in zip(operations, inputs, places, strict=True):
        standing = OperationRecord.of(operation) if operation.Motions else _unplanned_record(operation)
        before = offsets[one.faces[0][0].Name]
        first = replace(standing, details=_number_details(standing.details, before))
        rows.append(_PlannedRow(first, tools[place], angles_kept(operation), json.loads(operation.Details)))
        for link in turned_copies(operation) if standing.path is not None else ():
            copy = standing.turned(link.Placement, int(link.Face.removeprefix("Face")))
            copy = replace(copy, details=_number_details(copy.details, before))
            rows.append(_PlannedRow(copy, tools[place], (), {}))
    job = replace(together.job(), origin=source.origin)
    words = _in_no_operation(operations)
    aside = _areas_in_no_operation(words)

    def compute(progress):
        from toolaxis.plan.plan import Plan

        part, bodies = source.prepared(job, progress)
        part = _join_again(part, words.get("joined", ()))
        for row in rows:
            part = row.standing.joined(part)
        if job.stock > 0:
            part = part.with_stock(job.stock, {face for row in rows for face in row.standing.stock_faces(part)})
        made = [row.standing.operation(k, part, row.tool) for k, row in enumerate(rows, 1)]
        made = _with_rests(made, rows)
        mounted = mounting(together.limits, tools[0]) if together.limits.startswith(PREFIX) else None
        if mounted is not None:
            made = _operations_with_angles(made, mounted, [row.angles for row in rows])
        return Plan(part, tools, job, tuple(made), bodies, _datum(made, source), _outcome(made, tools, aside),
                    machine=mounted, **aside)

    return compute


@dataclass(frozen=True)
class _PlannedRow:
    """What stands in a document of one operation, or of its turned copy.

    standing : OperationRecord, its faces counted through all parts;  tool : toolaxis.tools.tool.Tool;  angles : rotary
    angles that the document tells;  kept : dict, details as the document has them, empty for a copy.
    """

    standing: OperationRecord
    tool: object
    angles: tuple
    kept: dict


def _tools_of(inputs):
    """The different tools of some operations in their order, and the place of each operation's among them.

    Several tools have their own rates and a place in the magazine each: those without one, or with one that another
    tool has, get free ones.
    """
    known, places = [], []
    for one in inputs:
        tool = replace(one.assembled(), feedrate=one.feedrate, spindle=one.spindle)
        if tool not in known:
            known.append(tool)
        places.append(known.index(tool))
    if len(known) == 1:
        return (inputs[0].assembled(),), places
    used, numbers = set(), []
    for tool in known:
        numbers.append(tool.number if tool.number not in used else 0)
        used.add(tool.number)
    free = (number for number in count(1) if number not in used)
    return tuple(replace(tool, number=number or next(free))
                 for tool, number in zip(known, numbers, strict=True)), places


def _unplanned_record(operation):
    """An operation that has no passes, as its document has it."""
    from toolaxis.plan.document import orientation_from

    return OperationRecord(None, None, orientation_from(json.loads(operation.AxisMap)), json.loads(operation.Details))


def _with_rests(made, rows):
    """Operations that tell which of them left what they machine: where all of these are written too."""
    places = {row.kept["number"]: k for k, row in enumerate(rows, 1) if "number" in row.kept}
    found = []
    for op, row in zip(made, rows, strict=True):
        wanted = row.kept.get("rest_of", ())
        together = all(number in places for number in wanted)
        found.append(replace(op, rest_of=tuple(sorted(places[number] for number in wanted)) if together else ()))
    return found


def _in_no_operation(operations):
    """What a document keeps of areas in no operation, by names; nothing unless all of one whole plan is written."""
    above = plan_of(operations[0])
    whole = above is not None and {one.Name for one in operations_in(above)} == {one.Name for one in operations}
    if not whole or not above.InNoOperation:
        return {}
    words = json.loads(above.InNoOperation)
    if words.get("machined_before"):
        _check_up_to_date(above, why_plan_stale(above))
    return words


def _areas_in_no_operation(words):
    """What of the faces is in no operation, as a plan's fields."""
    from toolaxis.plan.face_share import FaceShare
    from toolaxis.plan.unplanned_area import UnplannedArea

    if not words:
        return {}
    unplanned = tuple(UnplannedArea(**{**one, "point": tuple(one["point"])}) for one in words["unplanned"])
    shares = {name: tuple(FaceShare(**one) for one in words.get(name, ())) for name in ("held", "machined_before")}
    return {"unplanned": unplanned, **shares}


def _join_again(part, joined):
    """A part with the skins joined that a plan has, but no operation of it machines."""
    from toolaxis.skin.join import join

    for numbers in joined:
        part = join(part, numbers, inf, inf)
    return part


def _outcome(made, tools, aside):
    """What operations that stand in a document come to."""
    from toolaxis.job.planning.rack import outcome_of_rack
    from toolaxis.plan.plan import outcome_of
    from toolaxis.plan.unplanned_area import HIDDEN

    if any(one.why != HIDDEN for one in aside.get("unplanned", ())):
        return "cancelled"
    return outcome_of_rack(made) if len(tools) > 1 else outcome_of(made)


def _inputs(operation):
    """The inputs of an operation that holds."""
    _check_up_to_date(operation, why_stale(operation))
    return inputs_of(operation)


def _check_up_to_date(thing, reasons):
    """Refuse what does not hold any more."""
    from toolaxis.errors import InvalidInput

    if reasons:
        name = plain_label(thing)
        raise InvalidInput(f"'{name}' is out of date ({'; '.join(reasons)}): recompute it before it is written")


def _together(operations, inputs):
    """One job for all operations; refused where they differ in what a plan has once."""
    from toolaxis.errors import InvalidInput

    if not inputs:
        raise InvalidInput("there is no operation: select faces and run Plan Orientations first")
    first = inputs[0]
    for operation, one in zip(operations, inputs, strict=True):
        for name, words in _SHARED.items():
            if getattr(one, name) != getattr(first, name):
                raise InvalidInput(f"'{operations[0].Label}' and '{operation.Label}' have different {words}: select "
                                   "those that go together, and write each kind into a folder of its own")
    things = {thing.Name for one in inputs for thing in one.things}
    obstacles = {body.Name: body for one in inputs for body in one.obstacles if body.Name not in things}
    faces = dict.fromkeys(face for one in inputs for face in one.faces)
    together = replace(first, faces=tuple(faces), obstacles=tuple(obstacles.values()))
    together.check_one_part()
    return together


def _offsets(together):
    """How many faces come before those of each part, by the parts' names."""
    from toolaxis.cad.freecad.documents import shape_of

    found, before = {}, 0
    for thing in together.things:
        found[thing.Name] = before
        before += len(shape_of(thing).Faces)
    return found


def _number_details(details, before):
    """What is kept of a sub-surface, its face counted through all parts."""
    own = str(details["face"])
    suffix = details["label"].removeprefix(own) if details["label"].startswith(own) else ""
    number = details["face"] + before
    rows = {name: [member + before for member in details.get(name, ())] for name in ("members", "stock_faces")}
    return details | rows | {"face": number, "label": f"{number}{suffix}"}


def _operations_with_angles(made, mounted, angles):
    """Operations with the rotary angles at which the machine that they were planned for holds them: those that the
    document tells, else the nearest ones."""
    done = [(op, kept) for op, kept in zip(made, angles, strict=True) if op.done and op.orientation.lead is None]
    rows = in_order(mounted, [(op.orientation.axis, op.path.cl) for op, _ in done])
    found = {}
    for (op, kept), (ways, taken) in zip(done, rows, strict=True):
        taken = nearest(ways, kept) if kept and ways else taken
        if taken >= 0 and ways:
            found[op.number] = tuple(map(float, ways[taken].rotary))
    return [replace(op, rotary=found.get(op.number, ())) for op in made]


def _datum(made, source):
    """The origin that all work coordinate systems share."""
    import numpy as np

    frames = [op.frame for op in made if op.frame is not None]
    return frames[0].origin if frames else np.array(source.datum)


def _verdict(operations):
    """What is known of operations, as the setup sheet says it."""
    found = {operation.Verdict for operation in operations if operation.Motions}
    return _JUDGED.get(found.pop(), "not verified yet: run toolaxis verify") if len(found) == 1 else (
        "FAILED" if "failed" in found else "not verified yet: run toolaxis verify")


def _write(plan, folder, wish, told):
    """Make all files beside the folder, then move them there."""
    from toolaxis.errors import InvalidInput
    from toolaxis.job.files.plan_folder import stage_folder, write_plan

    verdict, progress = told
    try:
        with stage_folder(folder) as stage:
            inner = stage.folder / folder.resolve().name  # the page is called by its folder
            inner.mkdir()
            progress.report("writing the plan", 0, 1)
            write_plan(plan, inner)
            if wish.dialect:
                for name, text in _program(plan, wish, folder.resolve().name, verdict).items():
                    (inner / name).write_text(text, encoding="utf-8")
            if wish.report:
                from toolaxis.job.output.report import report

                report(inner, None, progress)
            names = sorted(path.name for path in inner.iterdir())
            for name in names:
                (inner / name).rename(stage.folder / name)
            inner.rmdir()
            stage.publish()
    except OSError as reason:  # the disk is full, the drive is gone
        raise InvalidInput(f"folder {folder} cannot be written ({reason.strerror}): make room there, or give "
                           "another") from reason
    return names


def _program(plan, wish, name, verdict):
    """The files of a program."""
    from toolaxis.cad.machines import load_machine
    from toolaxis.errors import PartMisplaced
    from toolaxis.job.output.height_on_table import find_missing_height
    from toolaxis.job.output.post import post_plan
    from toolaxis.machine.setup import Mounting

    mounting = Mounting(load_machine(wish.machine), wish.offset) if wish.machine else None
    try:
        return post_plan(plan, wish.dialect, mounting, name=name, verdict=verdict)
    except PartMisplaced as reason:
        reason.missing_height = partial(find_missing_height, plan, mounting)
        raise
