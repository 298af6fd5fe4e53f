"""One tool as CAM systems describe it, with a kind in words, a shaft and a shoulder, as the sizes of a tool here."""

from collections.abc import Mapping
from math import isclose
from pathlib import Path
from typing import Any, NamedTuple

from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.tool_file import build_tool
from toolaxis.tools.cutting_data import CUTTING_DATA
from toolaxis.tools.registry import cutter_of_bit
from toolaxis.tools.sizes import positive
from toolaxis.tools.tool import Tool


class ToolEntry(NamedTuple):
    """A tool of a library file.

    Attributes
    ----------
    where : str
        Which one it is: "shop.csv, line 4 (Ball 8)".
    tool : Tool or None
        None for one that no pass is planned with.
    kind : str
        What the file calls it, where it cannot be planned with.
    """

    where: str
    tool: Tool | None
    kind: str = ""


def to_mm(value: float, scale: float) -> float:
    """A length in mm, without the last digits in which 0.06 inch is 1.5239999999999998 mm.

    Parameters
    ----------
    value : float
    scale : float
        mm in its unit.
    """
    return round(value * scale, 9)


def entry_label(file: Path, unit: str, number: int, title: object) -> str:
    """Which tool of a library a message is about.

    Parameters
    ----------
    file : Path
    unit : str
        What is counted: "line" or "tool".
    number : int
    title : object
        Its name; may be empty or None.
    """
    return f"{file.name}, {unit} {number}" + (f" ({title})" if title else "")


def entry_from_cam(where: str, stated: Mapping[str, Any]) -> ToolEntry:
    """A tool from the words of a CAM system.

    Parameters
    ----------
    where : str
        Which one it is, for messages.
    stated : mapping
        "kind" in words; in mm and degrees what is known of "diameter", "corner_radius", "half_angle_deg",
        "flute_length", "stickout", "overall_length", "shank_diameter", "shoulder_length", "shoulder_diameter"; "shaft"
        and "holder" as rows; "title", "number", "spindle", "feedrate" and `CUTTING_DATA`.  Zero stands for what the
        system has no value for, but for the diameter.

    Raises
    ------
    InvalidInput
        When the sizes make no tool.
    """
    known = {name: value for name, value in stated.items() if value not in (None, "", 0) or name == "diameter"}
    word = str(known.get("kind", "")).strip()
    kind = _kind(word, known)
    if kind is None:
        return ToolEntry(where, None, word.lower() or "unknown")
    names = ("diameter", "corner_radius", "half_angle_deg", "flute_length", "stickout", "holder", "title", "number",
             "spindle", "feedrate")
    sizes = {name: known[name] for name in names if name in known}
    if kind == "tapered":
        sizes["corner_radius"] = known.get("diameter", 0) / 2 if _is_full_ball(known) else 0.0
    sizes |= _cutting_data(known)
    if known.get("diameter"):
        sizes["shank"] = _shank(where, known) or None
    return ToolEntry(where, build_tool(where, {"kind": kind, **sizes}))


def _kind(word: str, known: Mapping[str, Any]) -> str | None:
    """Name of the cutter; an end mill with a corner radius is a bull nose, and one with the largest is a ball end."""
    cutter = cutter_of_bit(word)
    if cutter is None:
        return None
    corner, full = known.get("corner_radius", 0), _is_full_ball(known)
    if cutter.name == "flat" and corner:
        return "ball" if full else "torus"
    # Systems differ in where they measure the diameter of a tapered mill whose corner is no full ball.
    if cutter.name == "tapered" and corner and not full:
        return None
    return cutter.name


def _is_full_ball(known: Mapping[str, Any]) -> bool:
    """Whether the corner radius is half the diameter, up to the digits that systems write."""
    return isclose(2 * known.get("corner_radius", 0), known.get("diameter", 0), rel_tol=1e-5)


def _cutting_data(known: Mapping[str, Any]) -> dict[str, Any]:
    """Cutting data that rates are still needed from: systems state both, rounded."""
    data = {name: known[name] for name in CUTTING_DATA if name in known}
    if "spindle" in known:
        data.pop("cutting_speed", None)
    if "feedrate" in known or not {"spindle", "cutting_speed"} & set(known) or "teeth" not in known:
        data.pop("feed_per_tooth", None)
    return data


def _shank(where: str, known: Mapping[str, Any]) -> list[tuple[float, float]]:
    """Outline above the cutting edge: shoulder, tapered shaft, and the shank up to the holder or its end."""
    rows: list[tuple[float, float]] = []
    try:
        usual = 2 * positive("diameter", known["diameter"])
        height = positive("flute length", known.get("flute_length", usual))
        shoulder = positive("shoulder length", known.get("shoulder_length", height))
        whole = positive("overall length", known.get("overall_length", height))
        end = positive("stick-out", known.get("stickout", whole))
        neck = positive("shoulder diameter", known.get("shoulder_diameter", usual)) / 2
        wide = positive("shank diameter", known.get("shank_diameter", usual)) / 2
    except InvalidInput as reason:
        raise InvalidInput(f"{where}: {reason}") from reason
    if shoulder > height:
        # Without the shoulder's own diameter, what follows is taken down to the cutting edge.
        if "shoulder_diameter" in known:
            rows += [(neck, height), (neck, shoulder)]
        height = shoulder
    shaft = [(radius, height + z) for radius, z in known.get("shaft", ())]
    rows += shaft
    height = shaft[-1][1] if shaft else height
    if "shank_diameter" in known and end > height:
        rows += [(wide, height), (wide, end)]
    return rows
