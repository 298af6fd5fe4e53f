"""Tools from text: a short form, a tool file, or a name from the tool library; holders likewise."""

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.resources import find_files
from toolaxis.tools.cutter import BIT_SIZES
from toolaxis.tools.registry import cutter_named, cutter_of_bit, cutters, short_forms
from toolaxis.tools.tool import PROPERTIES, Tool

_UNITS = {"": 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, '"': 25.4, "°": 1.0, "deg": 1.0}


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
    reader = _freecad_sizes if path.suffix.lower() == ".fctb" else _toml_sizes
    return _build(path, {**reader(path), **given})


def _build(path: Path, sizes: Mapping[str, Any]) -> Tool:
    kind = sizes["kind"]
    names = cutter_named(kind).sizes
    missing = [name for name in names if name not in sizes]
    if missing:
        raise InvalidInput(f"tool file {path.name} has no {missing[0]}: a {kind} needs {', '.join(names)}")
    try:
        return Tool.of(kind, *(float(sizes[name]) for name in names),
                       **{name: sizes[name] for name in PROPERTIES if name in sizes})
    except (TypeError, ValueError) as reason:
        raise InvalidInput(f"tool file {path.name}: {reason}") from reason


def _text_of(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as reason:
        raise InvalidInput(f"{path} cannot be read: {reason}") from reason


def _toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(_text_of(path))
    except tomllib.TOMLDecodeError as reason:
        raise InvalidInput(f"{path.name} is not valid TOML: {reason}") from reason


def _toml_sizes(path: Path) -> dict[str, Any]:
    sizes = _toml(path)
    if sizes.get("kind") not in cutters():
        raise InvalidInput(f"tool file {path.name} has kind {sizes.get('kind')!r}: use {', '.join(cutters())}")
    own = cutter_named(sizes["kind"]).sizes
    unknown = set(sizes) - {"kind", "note", *own, *PROPERTIES}
    if unknown:
        raise InvalidInput(f"tool file {path.name} has an unknown {sorted(unknown)[0]!r}: a {sizes['kind']} has "
                           f"{', '.join((*own, *PROPERTIES))} and note")
    return sizes


def _quantity(path: Path, parameters: Mapping[str, Any], name: str) -> float | None:
    """A FreeCAD quantity ("6.0000 mm", '0.25 "') in mm or degrees; None where the file does not have it."""
    if name not in parameters:
        return None
    found = re.fullmatch(r"\s*([-+0-9.eE]+)\s*([a-z\"°]*)\s*", str(parameters[name]))
    if found is None or found[2] not in _UNITS:
        raise InvalidInput(f"tool file {path.name}: {name} is {parameters[name]!r}: a number with mm, in or deg "
                           "is needed")
    return float(found[1]) * _UNITS[found[2]]


def _freecad_sizes(path: Path) -> dict[str, Any]:
    """Sizes from a FreeCAD tool bit."""
    try:
        bit = json.loads(_text_of(path))
        shape = str(bit.get("shape-type") or Path(str(bit["shape"])).stem).lower().replace(" ", "")
        parameters = bit["parameter"]
    except (ValueError, KeyError, AttributeError, TypeError) as reason:
        raise InvalidInput(f"tool file {path.name} is not a FreeCAD tool bit: {reason!r}") from reason
    kind = cutter_of_bit(shape)
    if kind is None:
        raise UnsupportedGeometry(f"tool file {path.name} is a {shape}: only end mills, ball ends, bull noses and "
                                  "tapered ball noses can be planned with")
    size = {name: _quantity(path, parameters, name)
            for name in (*BIT_SIZES, "CuttingEdgeHeight", "ShankDiameter", "Length")}
    sizes: dict[str, Any] = {"kind": kind.name, **kind.sizes_of_bit(size), "flute_length": size["CuttingEdgeHeight"]}
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
        found = _toml(path)
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
