"""A rack of tools: from tool libraries, tool tables, folders, single tools, and several of them together."""

import json
import os
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.cam_tool import ToolEntry, entry_label
from toolaxis.job.inputs.fusion_library import read_fusion_library
from toolaxis.job.inputs.tool_file import (
    UnplannableBit,
    build_tool,
    check_sizes,
    freecad_sizes,
    library,
    load_tool,
    read_text,
    read_toml,
)
from toolaxis.job.inputs.tool_table import read_tool_table
from toolaxis.resources import find_files
from toolaxis.tools.registry import cutters, short_forms
from toolaxis.tools.tool import Tool

#: The rack that is taken where nobody names one.
GENERAL_RACK = "general-rack"
#: What names tools.
ToolSource = Tool | str | Path


@dataclass(frozen=True)
class ToolLibrary:
    """The tools that can be planned with.

    Attributes
    ----------
    tools : tuple of Tool
        In the order of their sources.
    warnings : tuple of str
        What was left out and what is not known of the others, a sentence each.
    """

    tools: tuple[Tool, ...]
    warnings: tuple[str, ...] = ()


def racks() -> dict[str, Path]:
    """The libraries that can be given by name: files in resources/racks of a clone or of an installed wheel.

    Returns
    -------
    dict of str to Path
        The folder in the environment variable TOOLAXIS_RACKS, if set, comes first.
    """
    return find_files("racks", *_READERS)


def load_tools(source: ToolSource | Sequence[ToolSource] | None = None) -> tuple[Tool, ...]:
    """The tools of a rack; `load_library` also says what was left out.

    Parameters
    ----------
    source
        See `load_library`.

    Raises
    ------
    InvalidInput
        See `load_library`.
    """
    return load_library(source).tools


def load_library(source: ToolSource | Sequence[ToolSource] | None = None) -> ToolLibrary:
    """The tools of a rack, and what is to be said of them.

    Parameters
    ----------
    source : None, Tool, str, Path or sequence of these
        None for the general rack.  A text is a short form, a file (tool: .toml, .fctb; library: .toml, .fctl, .csv,
        .json, .tools), a folder of tool files, or a name from resources/tools or resources/racks.  Of a sequence the
        tools of all of it.

    Raises
    ------
    InvalidInput
        When a source is none of these or a tool is wrong, no tool is left, two tools have one number, or tools without
        numbers have one name.
    """
    if source is None:
        source = GENERAL_RACK
    sources: Sequence[Any] = list(source) if isinstance(source, Iterable) and not isinstance(source, str) else [source]
    if not sources:
        raise InvalidInput("the rack is empty: name at least one tool, library or folder")
    entries: list[ToolEntry] = []
    warnings: list[str] = []
    for one in sources:
        found, left = _entries_of(one)
        entries += found
        warnings += left
    entries, same = _without_twins(entries)
    _check_numbers(entries)
    _check_names(entries)
    return ToolLibrary(tuple(_tool(entry) for entry in entries), (*warnings, *same, *_without_holder(entries)))


def _entries_of(source: Any) -> tuple[list[ToolEntry], list[str]]:
    """Tools of one source that can be planned with, and what is to be said of the others."""
    if isinstance(source, Tool):
        return [ToolEntry(source.shop_name, source)], []
    if not isinstance(source, str | Path):
        raise InvalidInput(f"tools are {source!r}: give a Tool, its short form, a file, a folder or a name, or several")
    if isinstance(source, str) and source.partition(":")[0].strip() in cutters():
        return [ToolEntry(source, load_tool(source))], []
    path = _find(source)
    found = _folder(path) if path.is_dir() else _file(path)
    kept = [entry for entry in found if entry.tool is not None]
    kinds = Counter(entry.kind for entry in found if entry.tool is None)
    listed = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
    if not kept:
        why = f"none of its tools can be planned with ({listed})" if kinds else "it holds no tools"
        raise InvalidInput(f"the rack {path.name} is empty: {why}; end mills, bull noses and ball ends are needed")
    if not kinds:
        return kept, []
    return kept, [f"{path.name}: {len(found) - len(kept)} of {len(found)} tools are left out, since no pass is planned "
                  f"with them: {listed}"]


def _find(source: str | Path) -> Path:
    if os.path.exists(source):
        return Path(source)
    tools, known = library(), racks()
    found = tools.get(str(source)) or known.get(str(source))
    if found is None:
        raise InvalidInput(f"tools {str(source)!r} is neither a short form ({short_forms('')}), nor a file or folder, "
                           f"nor one of the racks: {', '.join(known) or 'none'}, nor one of the tools: "
                           f"{', '.join(tools) or 'none'}")
    return found


def _folder(path: Path) -> list[ToolEntry]:
    return [entry for file in sorted(path.iterdir()) if file.suffix.lower() in (".toml", ".fctb")
            for entry in _file(file)]


def _file(path: Path) -> list[ToolEntry]:
    suffix = path.suffix.lower()
    if suffix == ".fctb":
        return [_bit(path)]
    if suffix not in _READERS:
        raise InvalidInput(f"tools cannot be read from {path.name}: use one of {', '.join(('.fctb', *_READERS))}")
    return _READERS[suffix](path)


def _bit(path: Path, number: int = 0) -> ToolEntry:
    """A tool bit of FreeCAD, at a place in the magazine."""
    try:
        sizes = freecad_sizes(path)
    except UnplannableBit as reason:
        return ToolEntry(path.name, None, reason.shape)
    return ToolEntry(path.name, build_tool(f"tool file {path.name}", {**sizes, "number": number or None}))


def _read_toml_library(path: Path) -> list[ToolEntry]:
    """Tools in tables [[tool]] with holders in tables [holders.NAME], or the single tool of a tool file."""
    stated = read_toml(path)
    if not {"tool", "holders"} & set(stated):
        return [ToolEntry(path.name, load_tool(str(path)))]
    unknown = set(stated) - {"note", "unit", "holders", "tool"}
    if unknown:
        raise InvalidInput(f"{path.name} has an unknown {sorted(unknown)[0]!r}: a library has note, unit, holders and "
                           "tool")
    if stated.get("unit", "mm") != "mm":
        raise InvalidInput(f"{path.name} is in {stated['unit']!r}: a TOML library is in mm; give the tools in mm, or "
                           "in a .csv table with a column unit")
    holders, tools = stated.get("holders", {}), stated.get("tool", [])
    if not isinstance(holders, dict) or not isinstance(tools, list) or not all(isinstance(one, dict) for one in tools):
        raise InvalidInput(f"{path.name} is not a tool library: it needs tables [[tool]] and [holders.NAME]")
    return [_toml_entry(path, k, tool, holders) for k, tool in enumerate(tools, 1)]


def _toml_entry(path: Path, place: int, tool: dict[str, Any], holders: dict[str, Any]) -> ToolEntry:
    where = entry_label(path, "tool", place, tool.get("title"))
    check_sizes(where, tool)
    name = tool.get("holder")
    if isinstance(name, str):
        outline = holders[name].get("holder") if isinstance(holders.get(name), dict) else None
        if outline is None:
            raise InvalidInput(f"{where}: holder {name!r} has no outline: give it as holder in a table "
                               f"[holders.{name}]")
        tool = {**tool, "holder": outline}
    return ToolEntry(where, build_tool(where, tool))


def _read_freecad_library(path: Path) -> list[ToolEntry]:
    """A FreeCAD library, whose tool bits stand in the folder Bit beside its own, or where their paths say."""
    try:
        tools = [(int(tool["nr"]), str(tool["path"])) for tool in json.loads(read_text(path))["tools"]]
    except (ValueError, KeyError, TypeError, OverflowError) as reason:
        raise InvalidInput(f"{path.name} is not a FreeCAD tool library: {reason!r}") from reason
    entries = []
    for number, name in tools:
        places = (path.parent / name, path.parent.parent / "Bit" / name, path.parent / "Bit" / name)
        bit = next((place for place in places if os.path.isfile(place)), None)
        if bit is None:
            raise InvalidInput(f"{path.name}, tool {number}: the tool bit {name} is missing: put it into the folder "
                               "Bit beside the library's own")
        entries.append(_bit(bit, number)._replace(where=entry_label(path, "tool", number, Path(name).stem)))
    return entries


#: What reads library files, by the ends of their names.
_READERS: dict[str, Callable[[Path], list[ToolEntry]]] = {
    ".toml": _read_toml_library, ".fctl": _read_freecad_library, ".csv": read_tool_table,
    ".json": read_fusion_library, ".tools": read_fusion_library}


def _tool(entry: ToolEntry) -> Tool:
    assert entry.tool is not None
    return entry.tool


def _without_twins(entries: Iterable[ToolEntry]) -> tuple[list[ToolEntry], list[str]]:
    """Entries without those that are another one once more, and what is to be said of these."""
    kept: list[ToolEntry] = []
    said = []
    for entry in entries:
        twin = next((one for one in kept if _same(_tool(one), _tool(entry))), None)
        if twin is None:
            kept.append(entry)
        else:
            said.append(f"{entry.where} is the same tool as {twin.where}: only the first one is used")
    return kept, said


def _same(one: Tool, other: Tool) -> bool:
    """Whether two tools cut and collide alike, at the same rates or as one tool with rates for several materials."""
    sizes, others = ((tool.kind, tool.radius, tool.corner_radius, tool.half_angle, tool.flute_length, tool.stickout)
                     for tool in (one, other))
    if sizes != others or set(one.outlines) != set(other.outlines):
        return False
    if not all(np.array_equal(line, other.outlines[name]) for name, line in one.outlines.items()):
        return False
    return (one.feedrate, one.spindle) == (other.feedrate, other.spindle) or \
        (one.number, one.title) == (other.number, other.title)


def _check_numbers(entries: Iterable[ToolEntry]) -> None:
    known: dict[int, str] = {}
    for entry in entries:
        number = _tool(entry).number
        if number and number in known:
            raise InvalidInput(f"{known[number]} and {entry.where} both have number {number}: give each tool its own "
                               "place in the magazine")
        known[number] = entry.where


def _check_names(entries: Iterable[ToolEntry]) -> None:
    """Names tell tools apart that have no number."""
    known: dict[str, ToolEntry] = {}
    for entry in entries:
        name = _tool(entry).shop_name
        first = known.setdefault(name, entry)
        if first is not entry and not (_tool(first).number and _tool(entry).number):
            raise InvalidInput(f"{first.where} and {entry.where} differ and have one name, {name!r}: give each tool "
                               "its own title or number")


def _without_holder(entries: Sequence[ToolEntry]) -> list[str]:
    """Which tools have no holder, where others have one."""
    bare = [_tool(entry).shop_name for entry in entries if _tool(entry).holder is None]
    if not bare or len(bare) == len(entries):
        return []
    return [f"the holder is not checked of {len(bare)} of {len(entries)} tools, which have none: {'; '.join(bare)}"]
