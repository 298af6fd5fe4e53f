"""Tools from text: a short form, a tool file, or a name from the tool library; holders likewise."""

import json
import re
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.resources import find_files
from toolaxis.tools.cutter import BIT_SIZES
from toolaxis.tools.cutting_data import CUTTING_DATA, rates_from_cutting_data
from toolaxis.tools.registry import cutter_named, cutter_of_bit, cutters, short_forms
from toolaxis.tools.tool import PROPERTIES, Tool

_UNITS = {"": 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, '"': 25.4, "°": 1.0, "deg": 1.0}
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


class UnplannableBit(UnsupportedGeometry):
    """A tool bit of a shape that no pass is planned with.

    Parameters
    ----------
    file : str
    shape : str
        As the file calls it.
    """

    def __init__(self, file: str, shape: str) -> None:
        super().__init__(f"tool file {file} is a {shape}: only end mills, ball ends, bull noses and tapered ball noses "
                         "can be planned with")
        self.shape = shape


def library() -> dict[str, Path]:
    """The tools that can be given by name: files in resources/tools of a clone or of an installed wheel.

    Returns
    -------
    dict of str to Path
        The folder in the environment variable TOOLAXIS_TOOLS, if set, comes first.
    """
    return find_files("tools", ".toml", ".fctb")


def load_tool(text: str, **body: Any) -> Tool:
    """A tool from its short form, a TOML or FreeCAD .fctb file, or a name from the library.

    Parameters
    ----------
    text : str
    **body
        stickout, holder: override what a file says; see `Tool.build`.

    Raises
    ------
    InvalidInput
        When the text names no tool, or the sizes make none.
    """
    given = {name: value for name, value in body.items() if value is not None}
    if text.partition(":")[0].strip() in cutters():
        return Tool.parse(text, **given)
    path = Path(text)
    if not path.is_file():
        known = library()
        if text not in known:
            names = ", ".join(known) or "none"
            raise InvalidInput(f"tool {text!r} is neither a short form ({short_forms('')}), nor a file, "
                               f"nor one of the library: {names}")
        path = known[text]
    reader = freecad_sizes if path.suffix.lower() == ".fctb" else _toml_sizes
    return build_tool(f"tool file {path.name}", {**reader(path), **given})


def build_tool(where: str, sizes: Mapping[str, Any]) -> Tool:
    """A tool from what a file states of it.

    Parameters
    ----------
    where : str
        Which one it is, for the message: "tool file ball-8.toml".
    sizes : mapping
        "kind", the sizes of that kind, `PROPERTIES` and `CUTTING_DATA`, mm and degrees.

    Raises
    ------
    InvalidInput
        When the sizes make no tool.
    """
    kind = sizes["kind"]
    names = cutter_named(kind).sizes
    missing = [name for name in names if name not in sizes]
    if missing:
        raise InvalidInput(f"{where} has no {missing[0]}: a {kind} needs {', '.join(names)}")
    properties = {name: sizes[name] for name in PROPERTIES if name in sizes}
    try:
        tool = Tool.of(kind, *(sizes[name] for name in names), **properties)
        rates = rates_from_cutting_data(2 * tool.radius, sizes)
        return replace(tool, feedrate=rates.get("feedrate"), spindle=rates.get("spindle"))
    except (TypeError, ValueError, OverflowError) as reason:
        raise InvalidInput(f"{where}: {reason}") from reason


def read_text(path: Path) -> str:
    """The text of a file.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InvalidInput
        When it cannot be read, or is no text.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as reason:
        raise InvalidInput(f"{path} cannot be read: {reason}") from reason


def read_toml(path: Path) -> dict[str, Any]:
    """What a TOML file states.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InvalidInput
        When it cannot be read, or is no TOML.
    """
    try:
        return tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as reason:
        raise InvalidInput(f"{path.name} is not valid TOML: {reason}") from reason


def check_sizes(where: str, sizes: Mapping[str, Any]) -> None:
    """See that a tool in TOML states a kind and nothing that this kind does not have.

    Parameters
    ----------
    where : str
        Which one it is, for the message.
    sizes : mapping

    Raises
    ------
    InvalidInput
        When it does not.
    """
    kind: Any = sizes.get("kind")
    if kind not in cutters():
        raise InvalidInput(f"{where} has kind {kind!r}: use {', '.join(cutters())}")
    known = (*cutter_named(kind).sizes, *PROPERTIES, *CUTTING_DATA)
    unknown = set(sizes) - {"kind", "note", *known}
    if unknown:
        raise InvalidInput(f"{where} has an unknown {sorted(unknown)[0]!r}: a {kind} has {', '.join(known)} and note")


def _toml_sizes(path: Path) -> dict[str, Any]:
    sizes = read_toml(path)
    check_sizes(f"tool file {path.name}", sizes)
    return sizes


def _quantity(path: Path, parameters: Mapping[str, Any], name: str) -> float | None:
    """A FreeCAD quantity ("6.0000 mm", '0.25 "') in mm or degrees; None where the file does not have it."""
    if name not in parameters:
        return None
    found = re.fullmatch(rf"\s*({_NUMBER})\s*([a-z\"°]*)\s*", str(parameters[name]))
    if found is None or found[2] not in _UNITS:
        raise InvalidInput(f"tool file {path.name}: {name} is {parameters[name]!r}: a number with mm, in or deg "
                           "is needed")
    return float(found[1]) * _UNITS[found[2]]


def freecad_sizes(path: Path) -> dict[str, Any]:
    """Sizes from a FreeCAD tool bit, with its name as title.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InvalidInput
        When the file is no tool bit.
    UnplannableBit
        When it is a drill or another bit that no pass is planned with.
    """
    try:
        bit = json.loads(read_text(path))
        shape = str(bit.get("shape-type") or Path(str(bit["shape"])).stem).lower().replace(" ", "")
        parameters = dict(bit["parameter"])
    except (ValueError, KeyError, AttributeError, TypeError) as reason:
        raise InvalidInput(f"tool file {path.name} is not a FreeCAD tool bit: {reason!r}") from reason
    kind = cutter_of_bit(shape)
    if kind is None:
        raise UnplannableBit(path.name, shape)
    size = {name: _quantity(path, parameters, name)
            for name in (*BIT_SIZES, "CuttingEdgeHeight", "ShankDiameter", "Length")}
    sizes: dict[str, Any] = {"kind": kind.name, **kind.sizes_of_bit(size), "flute_length": size["CuttingEdgeHeight"],
                             "title": bit.get("name")}
    if size["ShankDiameter"] and size["Length"] and size["Length"] > (size["CuttingEdgeHeight"] or 0):
        sizes["shank"] = [(size["ShankDiameter"] / 2, 0.0), (size["ShankDiameter"] / 2, size["Length"])]
    return {name: value for name, value in sizes.items() if value is not None}


def load_holder(text: str) -> dict[str, Any]:
    """A holder from a TOML file or from rows "r,z;r,z;...".

    Parameters
    ----------
    text : str
        A file has ``holder = [[radius, z], ...]`` from the holder's own lower face and may have ``stickout``.

    Returns
    -------
    dict
        "holder" and, where the file says it, "stickout", mm.

    Raises
    ------
    InvalidInput
        When the text is neither.
    """
    path = Path(text)
    if path.is_file():
        found = read_toml(path)
        if "holder" not in found:
            raise InvalidInput(f"holder file {path.name} has no 'holder': give rows [radius, z] in mm")
        return {name: found[name] for name in ("holder", "stickout") if name in found}
    try:
        rows = [tuple(float(part) for part in row.split(",")) for row in text.split(";") if row.strip()]
    except ValueError:
        rows = []
    if not rows or any(len(row) != 2 for row in rows):
        raise InvalidInput(f"holder {text!r} is neither a file nor rows of radius,z in mm: "
                           "write 10,0;10,40;25,40;25,80")
    return {"holder": rows}
