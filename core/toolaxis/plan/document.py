"""A plan as a JSON document, and back: the written form that every door and the judge read."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import Fault, about
from toolaxis.machine.work_coordinates import WorkCoordinates
from toolaxis.plan.baseline import Baseline
from toolaxis.plan.blades_document import blades_document, blades_from
from toolaxis.plan.choices import ISO
from toolaxis.plan.face_share import FaceShare
from toolaxis.plan.machine_document import machine_document, machine_from, rotary_of
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import AxisMap, Orientation
from toolaxis.plan.part_account import PartAccount
from toolaxis.plan.plan import Option, Plan, PlanInputs
from toolaxis.plan.schema import NAME, VERSION, check
from toolaxis.plan.timing import MachiningTime, Order
from toolaxis.plan.unplanned_area import UnplannedArea
from toolaxis.plan.zone import Zone
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import split_at_kinks
from toolaxis.shape.part import Part
from toolaxis.skin.join import join
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import PROPERTIES, Tool

Array = NDArray[np.float64]
Document = dict[str, Any]

_SCALARS = ("feed", "passes", "count", "length", "average_strip_width", "gouge", "outcome", "evaluations", "unreached")


def _rows(values: Array | None) -> list[Any] | None:
    return None if values is None else np.asarray(values, dtype=float).tolist()


def _finite(values: Array) -> list[float | None]:
    return [_finite_or_none(value) for value in values]


def _finite_or_none(value: float) -> float | None:
    """A number as JSON takes it: infinite ones are written as null."""
    return float(value) if np.isfinite(value) else None


def _infinite_if_none(value: Any) -> Any:
    """What `_finite_or_none` wrote, as it was."""
    return np.inf if value is None else value


def tool_document(tool: Tool) -> Document:
    """A tool as numbers: sizes in mm, the half angle in rad.

    Parameters
    ----------
    tool : Tool
    """
    return {
        "name": tool.name,
        "kind": tool.kind,
        "radius": tool.radius,
        "corner_radius": tool.corner_radius,
        "half_angle": tool.half_angle,
        "flute_length": tool.flute_length,
        "stickout": tool.stickout,
        "shank": _rows(tool.shank),
        "holder": _rows(tool.holder),
        "title": tool.title,
        "number": tool.number,
        "feedrate": tool.feedrate,
        "spindle": tool.spindle,
    }


def tool_from(document: Mapping[str, Any]) -> Tool:
    """The tool that `tool_document` wrote.

    Parameters
    ----------
    document : mapping

    Raises
    ------
    InvalidInput
        When the sizes make no tool.
    """
    body = {key: document[key] for key in PROPERTIES if document.get(key)}
    return Tool.build(document["kind"], document["radius"], document["corner_radius"], document["half_angle"], **body)


def _map_document(found: AxisMap | None) -> Document | None:
    if found is None:
        return None
    return {
        "axis": _rows(found.axis),
        "passes": _finite(found.passes),
        "length": _finite(found.length),
        "reason": found.reason.tolist(),
        "amount": _finite(found.amount),
    }


def _map_from(document: Mapping[str, Any] | None) -> AxisMap | None:
    if document is None:
        return None

    def _numbers(name: str) -> Array:
        return np.array([_infinite_if_none(value) for value in document[name]], dtype=float)

    axis = np.array(document["axis"], dtype=float).reshape(-1, 3)
    reason = np.array(document["reason"], dtype=np.int8)
    return AxisMap(axis, _numbers("passes"), _numbers("length"), reason, _numbers("amount"))


def orientation_document(found: Orientation) -> Document:
    """An orientation as numbers, its lobes and its map included.

    Parameters
    ----------
    found : Orientation
    """
    record: Document = {name: getattr(found, name) for name in _SCALARS}
    for name in ("count", "length", "average_strip_width", "gouge", "unreached"):
        record[name] = _finite_or_none(record[name])
    record["passes"] = int(found.passes)
    record["evaluations"] = int(found.evaluations)
    record["axis"] = _rows(found.axis)
    record["clearance"] = {name: _finite_or_none(value) for name, value in found.clearance.items()}
    record["reasons"] = list(found.reasons)
    record["lead"] = found.lead
    record["pattern"] = found.pattern
    record["ideal"] = float(found.ideal)
    record["lobes"] = [orientation_document(lobe) for lobe in found.lobes]
    record["map"] = _map_document(found.map)
    return record


def orientation_from(document: Mapping[str, Any]) -> Orientation:
    """The orientation that `orientation_document` wrote.

    Parameters
    ----------
    document : mapping
    """
    scalars = {name: _infinite_if_none(document[name]) for name in _SCALARS}
    axis = document["axis"]
    return Orientation(
        axis=None if axis is None else np.array(axis, dtype=float),
        clearance={name: _infinite_if_none(value) for name, value in document["clearance"].items()},
        reasons=tuple(document["reasons"]),
        map=_map_from(document["map"]),
        lead=document.get("lead"),
        pattern=document.get("pattern", ISO),
        ideal=document.get("ideal", 0.0),
        lobes=tuple(orientation_from(lobe) for lobe in document["lobes"]),
        **scalars,
    )


def _frame_document(frame: WorkCoordinates | None) -> Document | None:
    if frame is None:
        return None
    return {name: _rows(getattr(frame, name)) for name in ("origin", "x", "y", "z", "shown_at")}


def _smooth_piece(part: Part, number: int, label: str) -> Face:
    """The face, or its piece between kinks that has a label."""
    face = part.face(number)
    return next((piece for piece in split_at_kinks(face) if piece.label == label), face)


def region_of(face: Face, part: Part) -> list[list[list[float]]] | None:
    """Trim loops of a sub-surface in (u, v); None for a whole face of a part, or a whole piece of one between kinks.

    Parameters
    ----------
    face : Face
    part : Part
    """
    whole = _smooth_piece(part, face.number, face.label)
    same = len(whole.trims) == len(face.trims) and all(map(np.array_equal, whole.trims, face.trims))
    return None if same else [np.asarray(loop, dtype=float).tolist() for loop in face.trims]


def sub_surface_from(part: Part, number: int, label: str, region: Sequence[ArrayLike] | None) -> Face:
    """The sub-surface of a part that `region_of` tells.

    Parameters
    ----------
    part : Part
    number : int
        Of the face.
    label : str
        Of the sub-surface.
    region : sequence of (m, 2) array_like, or None
    """
    face = _smooth_piece(part, number, label)
    if region is not None:
        return face.trimmed(tuple(np.array(loop, dtype=float) for loop in region), label)
    return face if face.label == label else face.trimmed(face.trims, label)  # a piece that is all of its face


def zone_documents(zones: Sequence[Zone]) -> list[Document]:
    """What an operation leaves, as documents that `json.dump` takes.

    Parameters
    ----------
    zones : sequence of Zone
    """
    return [_zone_document(zone) for zone in zones]


def _zone_document(zone: Zone) -> Document:
    loops = [_rows(loop) for loop in zone.loops]
    return {**asdict(zone), "loops": loops, "avoided": list(zone.avoided)}


def zones_from(documents: Sequence[Mapping[str, Any]]) -> tuple[Zone, ...]:
    """The zones that `zone_documents` tells.

    Parameters
    ----------
    documents : sequence of mapping
    """
    return tuple(_zone_from(document) for document in documents)


def _zone_from(document: Mapping[str, Any]) -> Zone:
    loops = tuple(np.array(loop, dtype=float) for loop in document["loops"])
    avoided = tuple(document.get("avoided", ()))
    return Zone(**{**document, "loops": loops, "avoided": avoided})


def _operation_document(op: Operation, plan: Plan, cl_file: str | None, failure_file: str | None) -> Document:
    face = op.face
    return {
        "number": op.number,
        "name": op.name,
        "face": face.number,
        "faces": list(face.numbers),
        "label": face.label,
        "tool": 1 + plan.tools.index(op.tool),
        "rest_of": list(op.rest_of),
        "unreachable": op.unreachable,
        "kind": face.kind,
        "area": face.area,
        "surface_tolerance": face.tolerance,
        "region": region_of(face, plan.part),
        "orientation": orientation_document(op.orientation),
        "work_coordinates": _frame_document(op.frame),
        "cl_file": cl_file,
        "failure_file": failure_file,
        "travel": op.travel,
        "points": 0 if op.path is None else len(op.path.cl),
        "seconds": op.seconds(plan.inputs.feedrate, plan.inputs.rapid),
        "time": _time_document(op.time),
        "rotary": _rows(rotary_of(plan.machine, op, op.tool.gauge_length)),
        "zones": zone_documents(op.zones),
    }


def _time_document(time: MachiningTime | None) -> Document | None:
    return None if time is None else {**asdict(time), "rotary": list(time.rotary)}


def account_document(found: PartAccount) -> Document:
    """How much of its faces a plan machines, mm^2 and mm; null for what is not known.

    Parameters
    ----------
    found : PartAccount
    """
    return {
        "area": found.area,
        "machined": found.machined,
        "unreachable": found.unreachable,
        "open": found.open,
        "not_begun": found.not_begun,
        "length": found.length,
        "bound": found.bound or None,
        "gap": found.gap,
    }


def plan_document(plan: Plan, files: Mapping[str, Any]) -> Document:
    """A plan as a document that `json.dump` takes and `schema.check` accepts.

    Parameters
    ----------
    plan : Plan
    files : mapping
        "part": {"file", "sha256"}; "obstacles": list of the same; "operations": CL file name or None per operation;
        "failures": name of the file that tells of a failure, or None, per operation, and "failure" for what failed of
        the whole; none of them unless given.

    Raises
    ------
    Exception
        Where an operation cannot be written, `toolaxis.errors.piece_of` tells which, by the label of its face.
    """
    failures = files.get("failures") or [None] * len(plan.operations)
    return {
        "schema": NAME,
        "version": VERSION,
        "units": {"length": "mm", "angle": "rad", "feedrate": "mm/min", "spindle": "rev/min"},
        "part": {**files["part"], **_part_document(plan)},
        "obstacles": list(files["obstacles"]),
        "tools": [tool_document(tool) for tool in plan.tools],
        "inputs": _inputs_document(plan.inputs),
        "datum": _rows(plan.datum),
        "outcome": plan.outcome,
        "not_checked": list(plan.not_checked),
        "length": plan.length,
        "travel": plan.travel,
        "orientations": plan.orientations,
        "seconds": plan.seconds,
        "baselines": [_baseline_document(baseline) for baseline in plan.baselines],
        "blades": blades_document(plan.blades),
        "machine": machine_document(plan.machine),
        "order": _order_document(plan.order),
        "in_the_way": list(plan.in_the_way),
        "faults": [one.sentence for one in plan.faults],
        "failure_file": files.get("failure"),
        "options": [_option_document(option) for option in plan.options],
        "operations": [_try_document(op, plan, names)
                       for op, *names in zip(plan.operations, files["operations"], failures, strict=True)],
    }


def _part_document(plan: Plan) -> Document:
    """What is told of the part besides its file."""
    part = plan.part
    as_read = part.original or part
    return {
        "source": part.source,
        "unit": part.unit,
        "faces": len(as_read.faces),
        "warnings": list(part.warnings),
        "joined": [list(face.numbers) for face in part.faces if face.members],
        "stock_faces": [] if part.stock is None else sorted(part.stock.faces),
        "seams": [seam.document for seam in as_read.seams],
        **account_document(plan.account),
        "held": [one._asdict() for one in plan.held],
        "machined_before": [one._asdict() for one in plan.machined_before],
        "unplanned": [{**one._asdict(), "point": list(one.point)} for one in plan.unplanned],
    }


def _inputs_document(inputs: PlanInputs) -> Document:
    allowance_on = [list(pair) for pair in inputs.allowance_on]
    return {**asdict(inputs), "avoid": list(inputs.avoid), "allowance_on": allowance_on}


def _baseline_document(baseline: Baseline) -> Document:
    return {name: value for name, value in asdict(baseline).items() if name != "title"}


def _order_document(order: Order | None) -> Document | None:
    if order is None:
        return None
    listed = order.listed if np.isfinite(order.listed) else None
    return {**asdict(order), "listed": listed}


def _option_document(option: Option) -> Document:
    return {name: value for name, value in asdict(option).items() if value is not None}


def _try_document(op: Operation, plan: Plan, names: Sequence[str | None]) -> Document:
    """The record of an operation, tried out as JSON, so that what cannot be written is told of it alone."""
    with about(op.face.label):
        record = _operation_document(op, plan, *names)
        json.dumps(record, allow_nan=False)
    return record


def _operation_from(document: Mapping[str, Any], part: Part, tools: Sequence[Tool],
                    path: ToolPath | None) -> Operation:
    face = sub_surface_from(part, document["face"], document["label"], document["region"])
    tool = tools[document["tool"] - 1]
    orientation = orientation_from(document["orientation"])
    frame = _frame_from(document["work_coordinates"])
    zones = zones_from(document.get("zones", ()))
    time = _time_from(document.get("time"))
    solutions = document.get("rotary") or [()]
    rotary = tuple(solutions[0])
    return Operation(document["number"], face, tool, orientation, path, frame, zones, time, rotary,
                     tuple(document["rest_of"]), unreachable=document["unreachable"])


def _frame_from(document: Mapping[str, Any] | None) -> WorkCoordinates | None:
    if document is None:
        return None
    return WorkCoordinates(**{name: np.array(row, dtype=float) for name, row in document.items()})


def _time_from(document: Mapping[str, Any] | None) -> MachiningTime | None:
    return None if document is None else MachiningTime(**{**document, "rotary": tuple(document["rotary"])})


def _order_from(document: Mapping[str, Any] | None) -> Order | None:
    if document is None:
        return None
    return Order(**{**document, "listed": _infinite_if_none(document["listed"])})


def _inputs_from(document: Mapping[str, Any]) -> PlanInputs:
    tolerance = Tolerance(**document["tolerance"])
    avoid = tuple(document.get("avoid", ()))
    pairs = document.get("allowance_on", ())
    allowance_on = tuple((int(number), float(value)) for number, value in pairs)
    return PlanInputs(**{**document, "tolerance": tolerance, "avoid": avoid, "allowance_on": allowance_on})


def _part_from(document: Mapping[str, Any], inputs: PlanInputs, part: Part) -> Part:
    """The part that a plan was made for, from the one in its file: faces joined, and with the stock that is left."""
    part = inputs.prepare_part(part)
    for numbers in document["part"].get("joined", ()):
        part = join(part, numbers, np.inf, np.inf)
    if inputs.stock > 0:
        machined = {number for record in document["operations"] for number in record["faces"]}
        part = part.with_stock(inputs.stock, machined.union(document["part"].get("stock_faces", ())))
    return part


def _unplanned_from(document: Mapping[str, Any]) -> UnplannedArea:
    return UnplannedArea(**{**document, "point": tuple(document["point"])})


def plan_from(document: Mapping[str, Any], part: Part, obstacles: Sequence[Part],
              paths: Sequence[ToolPath | None]) -> Plan:
    """The plan that `plan_document` wrote, with the part and the paths that stand beside it.

    Parameters
    ----------
    document : mapping
    part : Part
        As its file has it; faces that were joined are joined again.
    obstacles : sequence of Part
    paths : sequence of ToolPath or None
        One per operation.

    Raises
    ------
    InvalidInput
        When the document breaks the schema or names a face that the part does not have.
    """
    check(document)
    inputs = _inputs_from(document["inputs"])
    part = _part_from(document, inputs, part)
    tools = tuple(tool_from(one) for one in document["tools"])
    operations = tuple(_operation_from(record, part, tools, path)
                       for record, path in zip(document["operations"], paths, strict=True))
    of_part = document["part"]
    return Plan(
        part, tools, inputs, operations, tuple(obstacles),
        datum=np.array(document["datum"], dtype=float),
        outcome=document["outcome"],
        options=tuple(Option(**one) for one in document.get("options", ())),
        baselines=tuple(Baseline(**one) for one in document.get("baselines", ())),
        blades=blades_from(document.get("blades"), len(operations)),
        machine=machine_from(document.get("machine")),
        order=_order_from(document.get("order")),
        in_the_way=tuple(document.get("in_the_way", ())),
        faults=tuple(Fault(sentence) for sentence in document.get("faults", ())),
        held=tuple(FaceShare(**one) for one in of_part.get("held", ())),
        machined_before=tuple(FaceShare(**one) for one in of_part.get("machined_before", ())),
        unplanned=tuple(_unplanned_from(one) for one in of_part.get("unplanned", ())),
    )
