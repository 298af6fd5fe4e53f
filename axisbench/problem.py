"""A problem of the benchmark: what is machined, with which tools, within which limits, and what is measured."""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
from axisbench.faces import FaceData

import toolaxis as ta
from toolaxis.machine.library import load_machine
from toolaxis.machine.limits import AxisLimits, parse_limits
from toolaxis.machine.machine import Machine
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool
from toolaxis.verify.verdict import FACTOR, SHARE

FOLDER = Path(__file__).parent
DATA = FOLDER / "data"
PROBLEMS = FOLDER / "problems.toml"

#: The tasks, and what is measured in each.
TASKS = {"fixed-axis": "length", "passes": "length", "orientations": "orientations", "whole-part": "time",
         "four-plus-one": "length", "five-axes": "length"}
#: Tasks in which the axis may move during a pass.
MOVING = ("four-plus-one", "five-axes")
#: Units of what is measured.
UNITS = {"length": "mm", "orientations": "", "time": "s"}
#: Places each way at which normals are looked at for the bound on orientations.
_PLACES = 40


class UnknownProblem(ta.InvalidInput):
    """No problem of the benchmark has the name."""


@dataclass(frozen=True, eq=False)
class BenchmarkProblem:
    """One problem.

    Attributes
    ----------
    name : str
        The task and the name of the face or part: "fixed-axis-saddle".
    task : str
        One of `TASKS`.
    data : str
        Name of the face or the part, of its file too.
    tools : tuple of Tool
        What an entry may use; one but for whole parts.
    scallop : float
        Greatest scallop height, mm.
    tolerance : float
        How deep a gouge may be, mm.
    axis : (3,) array or None
        Unit axis that every pass must have, in the task "passes".
    limits : str
        Limits of the axis in the short form of the command; empty for none.
    machine : str
        Machine whose rotary axes must reach every axis; empty for none.
    printed : tuple of str
        What papers print of the same surface, with the key of the source.
    faces : tuple of int
        Numbers of the faces of a whole part that must be machined; the sculptured ones unless given.
    """

    name: str
    task: str
    data: str
    tools: tuple[Tool, ...]
    scallop: float
    tolerance: float = 0.01
    axis: np.ndarray | None = None
    limits: str = ""
    machine: str = ""
    printed: tuple[str, ...] = ()
    faces: tuple[int, ...] = ()

    @property
    def measured(self) -> str:
        """What the score is made from: "length", "orientations" or "time"."""
        return TASKS[self.task]

    @property
    def is_part(self) -> bool:
        """Whether it is a whole part, with a STEP file."""
        return self.task == "whole-part"

    @property
    def path(self) -> Path:
        """The file with the geometry."""
        return DATA / "parts" / f"{self.data}.step" if self.is_part else DATA / "faces" / f"{self.data}.json"

    @cached_property
    def face_data(self) -> FaceData:
        """The face as its file has it."""
        return FaceData.from_document(json.loads(self.path.read_text("utf-8")))

    @cached_property
    def part(self) -> ta.Part:
        """The part, or the face alone."""
        return ta.load(self.path) if self.is_part else ta.Part.from_faces([self.face_data.face()])

    @cached_property
    def asked(self) -> tuple[Face, ...]:
        """The faces that must be machined."""
        if self.faces:
            return tuple(self.part.face(number) for number in self.faces)
        return tuple(self.part.sculptured) if self.is_part else (self.part.faces[0],)

    @cached_property
    def obstacles(self) -> tuple[Face, ...]:
        """What stands around a face and must not be touched."""
        if self.is_part:
            return ()
        return tuple(one.face(2 + k) for k, one in enumerate(self.face_data.obstacles))

    @cached_property
    def axis_limits(self) -> AxisLimits | None:
        """Limits of the axis; None where there are none."""
        return parse_limits(self.limits) if self.limits else None

    @cached_property
    def machine_model(self) -> Machine | None:
        """The machine; None where none is named."""
        return load_machine(self.machine) if self.machine else None

    @cached_property
    def bound(self) -> float | None:
        """A proven lower bound of what is measured; None where none is known.

        Of orientations: two where no hemisphere holds the normals of the face, as no axis then sees all of it, else
        one.  Of the length on a plane under a ball end: what a pass finishes is no more than its length times the
        widest strip, w, and half a disc at each end; as it counts no less than a diameter, 2 R, the length is no less
        than the area over w (1 + pi w / (8 R)).
        """
        if self.measured == "orientations":
            normals = self.asked[0].normal(self.asked[0].grid(_PLACES, _PLACES))
            return 1.0 if np.linalg.norm(smallest_cap(normals).centre) > 0 else 2.0
        (tool, *others), flat = self.tools, not self.is_part and self.face_data.degree == (1, 1)
        if self.measured != "length" or others or tool.corner_radius < tool.radius or not flat:
            return None
        height = FACTOR * self.scallop + self.tolerance
        strip = 2 * np.sqrt(height * (2 * tool.radius - height))
        return float(SHARE * self.asked[0].area / (strip * (1 + np.pi * strip / (8 * tool.radius))))


@cache
def load_problems() -> Mapping[str, BenchmarkProblem]:
    """All problems by name, in the order of the file."""
    document = tomllib.loads(PROBLEMS.read_text("utf-8"))
    body = document["tool"]
    found = {}
    for kind, tables in (("face", document["face"]), ("part", document.get("part", {}))):
        for data, table in tables.items():
            tasks = ("whole-part",) if kind == "part" else table["tasks"]
            for task in tasks:
                one = _read_problem(task, data, table, body)
                found[one.name] = one
    return found


def _read_problem(task: str, data: str, table: Mapping[str, Any], body: Mapping[str, Any]) -> BenchmarkProblem:
    own = {**table, **table.get(task, {})}
    texts = own["tools"] if "tools" in own else [own["tool"]]
    body = {**body, **own.get("body", {})}
    tools = tuple(Tool.parse(text, stickout=body["stickout"], holder=body["holder"]) for text in texts)
    axis = None
    if task == "passes":
        axis = np.array(own["axis"], dtype=float)
        axis = axis / np.linalg.norm(axis)
    return BenchmarkProblem(f"{task}-{data}", task, data, tools, float(own["scallop"]),
                            float(own.get("tolerance", 0.01)), axis, own.get("limits", ""), own.get("machine", ""),
                            tuple(own.get("printed", ())), tuple(own.get("faces", ())))


def problem_named(name: str) -> BenchmarkProblem:
    """The problem with a name.

    Parameters
    ----------
    name : str

    Raises
    ------
    UnknownProblem
        When there is none.
    """
    known = load_problems()
    if name not in known:
        raise UnknownProblem(f"no problem is called {name!r}: name the file after one that `python -m axisbench list` "
                             "prints, such as fixed-axis-saddle.csv")
    return known[name]
