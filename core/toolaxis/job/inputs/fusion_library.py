"""Tool libraries of Fusion: .json as it exports them, and .tools, which is the same in a ZIP archive."""

import json
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.cam_tool import ToolEntry, entry_from_cam, entry_label, to_mm
from toolaxis.job.inputs.tool_file import read_text

_UNITS = {"millimeters": 1.0, "inches": 25.4}
#: Its words for lengths, which ISO 13399 has too.
_LENGTHS = {"diameter": "DC", "corner_radius": "RE", "flute_length": "LCF", "stickout": "LB", "overall_length": "OAL",
            "shank_diameter": "SFDM", "shoulder_length": "shoulder-length", "shoulder_diameter": "shoulder-diameter"}


def read_fusion_library(path: Path) -> list[ToolEntry]:
    """The tools of a library; holders that stand there by themselves are none.

    Parameters
    ----------
    path : Path
        .json or .tools

    Raises
    ------
    InvalidInput
        When it is no such library, or a tool in it is wrong.

    Notes
    -----
    Feed rate and spindle speed are those of a tool's first preset.
    """
    try:
        tools = json.loads(_text(path))["data"]
        return [_entry(path, k, tool) for k, tool in enumerate(tools, 1) if tool["type"] != "holder"]
    except InvalidInput:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, OverflowError) as reason:
        raise InvalidInput(f"{path.name} is not a Fusion tool library: {reason!r}") from reason


def _text(path: Path) -> str:
    if path.suffix.lower() != ".tools":
        return read_text(path)
    try:
        with zipfile.ZipFile(path) as archive:
            return archive.read("tools.json").decode("utf-8-sig")
    except (OSError, zipfile.BadZipFile) as reason:
        raise InvalidInput(f"{path} cannot be read: {reason}") from reason


def _entry(path: Path, place: int, tool: Mapping[str, Any]) -> ToolEntry:
    title = str(tool.get("description") or "").strip()
    where = entry_label(path, "tool", place, title)
    scale = _scale(where, tool)
    geometry = tool.get("geometry") or {}
    stated: dict[str, Any] = {name: to_mm(geometry[word], scale) for name, word in _LENGTHS.items()
                              if geometry.get(word)}
    stated |= {"kind": tool["type"], "title": title, "number": (tool.get("post-process") or {}).get("number"),
               "half_angle_deg": geometry.get("TA"), "teeth": geometry.get("NOF")}
    stated.setdefault("diameter", 0.0)
    presets = (tool.get("start-values") or {}).get("presets") or [{}]
    stated |= {"spindle": presets[0].get("n"), "feedrate": to_mm(presets[0].get("v_f") or 0, scale)}
    shaft = tool.get("shaft") or {}
    if shaft.get("segments"):
        stated["shaft"] = _outline(shaft["segments"], _scale(where, shaft) if "unit" in shaft else scale)
    holder = tool.get("holder") or {}
    if holder.get("segments"):
        own = _scale(where, holder) if "unit" in holder else scale
        stated["holder"] = _below(_outline(holder["segments"], own), to_mm(holder.get("gaugeLength") or 0, own))
    return entry_from_cam(where, stated)


def _scale(where: str, record: Mapping[str, Any]) -> float:
    if record.get("unit") not in _UNITS:
        raise InvalidInput(f"{where}: unit is {record.get('unit')!r}: use millimeters or inches")
    return _UNITS[record["unit"]]


def _outline(segments: Sequence[Mapping[str, float]], scale: float) -> list[tuple[float, float]]:
    """Rows (radius, z) of a stack of cones, which begins at the end towards the cutter."""
    rows, height = [], 0.0
    for segment in segments:
        rows.append((to_mm(segment["lower-diameter"] / 2, scale), height))
        height = to_mm(height / scale + segment["height"], scale)
        rows.append((to_mm(segment["upper-diameter"] / 2, scale), height))
    return rows


def _below(rows: list[tuple[float, float]], gauge: float) -> list[tuple[float, float]]:
    """The part of a holder below the gauge line; what is above is inside the spindle."""
    if not 0 < gauge < rows[-1][1]:
        return rows
    kept = [(radius, z) for radius, z in rows if z < gauge]
    (r0, z0), (r1, z1) = kept[-1], rows[len(kept)]
    return [*kept, (r0 + (r1 - r0) * (gauge - z0) / (z1 - z0), gauge)]
