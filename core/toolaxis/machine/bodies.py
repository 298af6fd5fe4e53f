"""What a machine is made of: tables, cradles, heads, each carried by one axis, as boxes, cylinders and hulls of points.

All of them are given in machine coordinates with all axes at zero.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.support_functions import ConvexBodies, boxes, hull, revolve_body

Array = NDArray[np.float64]

#: What carries the rotary axes of the table, and does not move.
BED = "bed"
#: Shapes of a body: the words that each takes besides its own.
SHAPES: Mapping[str, tuple[str, ...]] = {"box": (), "cylinder": ("radius",), "points": ("round",), "step": ()}
_WORDS = {"name", "carried", "radius", "round", *SHAPES}


@dataclass(frozen=True, eq=False)
class MachineBody:
    """One convex piece of a machine; pieces of one name and one axis are one body.

    Attributes
    ----------
    name : str
        Such as "table" or "head", for messages.
    carried : str
        Name of the axis that carries it, or "bed".  An axis of the table carries what lies between it and the part;
        linear axes and those of the head carry what lies between them and the tool, each also what the ones after it
        carry.
    kind : str
        "box" (two opposite corners), "cylinder" (the ends of its axis), "points" (their hull), or "step": a STEP file
        that is not read yet.
    points : (n, 3) array
        mm
    radius : float
        Of a cylinder; of a ball that is carried around the hull of points.
    file : str
        Of the kind "step".

    Raises
    ------
    InvalidInput
        When numbers are not finite or enclose nothing.
    """

    name: str
    carried: str
    kind: str
    points: Array
    radius: float = 0.0
    file: str = ""

    def __post_init__(self) -> None:
        rows = np.asarray(self.points, dtype=float).reshape(-1, 3)
        object.__setattr__(self, "points", rows)
        what = f"body {self.name}"
        if self.kind not in SHAPES:
            raise InvalidInput(f"{what} is a {self.kind!r}: use {', '.join(SHAPES)}")
        if not (np.isfinite(rows).all() and np.isfinite(self.radius)):
            raise InvalidInput(f"{what} has a number that is not finite: give all of them in mm")
        if self.kind == "box" and (len(rows) != 2 or (np.ptp(rows, axis=0) <= 0).any()):
            raise InvalidInput(f"box of {what} goes from {rows[0].tolist()} to {rows[-1].tolist()}: two corners that "
                               "differ in X, Y and Z are needed")
        if self.kind == "cylinder" and (len(rows) != 2 or not np.ptp(rows, axis=0).any() or self.radius <= 0):
            raise InvalidInput(f"cylinder of {what} has the ends {rows.tolist()} and the radius {self.radius:g} mm: "
                               "two different ends and a radius above zero are needed")
        if self.kind == "points" and (len(rows) < 4 or self.radius < 0):
            raise InvalidInput(f"{what} is the hull of {len(rows)} points, rounded by {self.radius:g} mm: four points "
                               "or more and no negative radius are needed")

    @property
    def convex(self) -> ConvexBodies:
        """Its shape, machine coordinates.

        Raises
        ------
        InvalidInput
            When it is a STEP file that was not read.
        """
        if self.kind == "step":
            raise InvalidInput(f"body {self.name} is the file {self.file} and was not read: load the machine by "
                               "toolaxis.load_machine with CadQuery or build123d installed")
        if self.kind == "box":
            return boxes(self.points.min(axis=0), self.points.max(axis=0))
        if self.kind == "cylinder":
            return revolve_body(self.points, self.radius)
        return hull(self.points, self.radius)


def body_from(item: Any, folder: Path | None = None) -> MachineBody:
    """A body from its table in a TOML file.

    Parameters
    ----------
    item : mapping
        name, carried, and one of box, cylinder with radius, points with round, and step.
    folder : Path, optional
        Where STEP files are looked for.

    Raises
    ------
    InvalidInput
        When a word is unknown, a shape is missing, or there are two.
    """
    if not isinstance(item, dict):
        raise InvalidInput(f"body is {item!r}: a table of values is needed")
    unknown = sorted(set(item) - _WORDS)
    name = item.get("name")
    if not isinstance(name, str) or not name:
        raise InvalidInput("a body has no name: write name = \"table\"")
    if unknown:
        raise InvalidInput(f"body {name} has an unknown {unknown[0]!r}: use {', '.join(sorted(_WORDS))}")
    kinds = [kind for kind in SHAPES if kind in item]
    if len(kinds) != 1:
        raise InvalidInput(f"body {name} has {' and '.join(kinds) or 'no shape'}: give one of {', '.join(SHAPES)}, and "
                           "write a body of several pieces as several entries of one name")
    kind = kinds[0]
    odd = [word for word in ("radius", "round") if word in item and word not in SHAPES[kind]]
    if odd:
        raise InvalidInput(f"body {name} is a {kind} and has a {odd[0]}: leave it out")
    carried = item.get("carried")
    if not isinstance(carried, str):
        raise InvalidInput(f"body {name} is carried by {carried!r}: give the name of an axis, or \"{BED}\"")
    if kind == "step":
        path = Path(str(item["step"]))
        return MachineBody(name, carried, kind, np.empty((0, 3)), file=str(path if folder is None else folder / path))
    radius = item.get(SHAPES[kind][0], 0.0) if SHAPES[kind] else 0.0
    if isinstance(radius, bool) or not isinstance(radius, int | float):
        raise InvalidInput(f"{SHAPES[kind][0]} of body {name} is {radius!r}: a number of mm is needed")
    return MachineBody(name, carried, kind, _rows(item[kind], f"{kind} of body {name}"), float(radius))


def _rows(values: Any, what: str) -> Array:
    try:
        rows = np.array(values, dtype=float)
    except (TypeError, ValueError):
        rows = np.empty(0)
    if rows.ndim != 2 or rows.shape[1] != 3 or rows.size == 0:
        raise InvalidInput(f"{what} is {values!r}: rows of three numbers X, Y, Z are needed")
    return rows


def body_lines(body: MachineBody) -> list[str]:
    """The lines of a TOML file that `body_from` reads back.

    Parameters
    ----------
    body : MachineBody
    """
    rows = ", ".join("[" + ", ".join(repr(float(value)) for value in row) + "]" for row in body.points)
    shape = f"step = {_quote(body.file)}" if body.kind == "step" else f"{body.kind} = [{rows}]"
    words = [f"{word} = {body.radius!r}" for word in SHAPES[body.kind]]
    return [f"name = {_quote(body.name)}", f"carried = {_quote(body.carried)}", shape, *words]


def _quote(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
