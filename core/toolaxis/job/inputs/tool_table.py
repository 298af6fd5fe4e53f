"""Tool tables in CSV, as CAM systems and spreadsheets write them: a header of column names, a tool in each line."""

import csv
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.cam_tool import ToolEntry, entry_from_cam, entry_label, to_mm
from toolaxis.job.inputs.tool_file import load_holder, read_text

#: What is measured in the table's unit of length; feeds are per minute.
_LENGTHS = ("diameter", "corner_radius", "flute_length", "stickout", "overall_length", "shank_diameter",
            "shoulder_length", "shoulder_diameter", "feedrate", "feed_per_tooth")
#: Names of columns without blanks, hyphens and "tool" at their beginning.
_COLUMNS = {
    "kind": ("type", "kind", "shape"),
    "diameter": ("diameter", "dia", "d", "cutterdiameter", "cuttingdiameter"),
    "corner_radius": ("cornerradius", "corner", "r"),
    "half_angle_deg": ("taperangle", "halfangle", "halfangledeg"),
    "flute_length": ("flutelength", "lengthofcut", "loc", "cuttinglength"),
    "stickout": ("stickout", "bodylength", "lengthbelowholder", "projection"),
    "overall_length": ("overalllength", "oal"),
    "shank_diameter": ("shankdiameter", "shaftdiameter"),
    "shoulder_length": ("shoulderlength", "necklength"),
    "shoulder_diameter": ("shoulderdiameter", "neckdiameter"),
    "title": ("description", "title", "name"),
    "number": ("number", "nr", "no", "t"),
    "teeth": ("teeth", "flutes", "numberofflutes", "numberofteeth", "z"),
    "spindle": ("spindle", "spindlespeed", "rpm"),
    "feedrate": ("feedrate", "feed", "feedcutting", "cuttingfeedrate"),
    "cutting_speed": ("cuttingspeed", "surfacespeed", "vc"),
    "feed_per_tooth": ("feedpertooth", "fz"),
    "holder": ("holder",),
    "unit": ("unit", "units"),
}
_UNITS = {"mm": 1.0, "millimeter": 1.0, "millimeters": 1.0, "millimetre": 1.0, "millimetres": 1.0, "metric": 1.0,
          "mm/min": 1.0, "m/min": 1.0, "in": 25.4, "inch": 25.4, "inches": 25.4, '"': 25.4, "imperial": 25.4,
          "in/min": 25.4, "ipm": 25.4, "ft/min": 25.4, "sfm": 25.4}
#: Feet in a metre: an inch table states cutting speeds in ft/min.
_FOOT = 0.3048


class TableColumn(NamedTuple):
    """A column that is read.

    Attributes
    ----------
    name : str
        Of `_COLUMNS`.
    header : str
        As it stands in the file.
    scale : float or None
        Of its unit, mm; None where its header states none.
    """

    name: str
    header: str
    scale: float | None


def read_tool_table(path: Path) -> list[ToolEntry]:
    """The tools of a table.

    Parameters
    ----------
    path : Path
        CSV with a header, parted by commas, semicolons or tabs.  The unit stands in a column "unit", or in brackets
        behind the names of the columns.

    Raises
    ------
    InvalidInput
        When there is no header, a unit is missing or unknown, or a line makes no tool.
    """
    lines = read_text(path).splitlines()
    delimiter = max(";\t,", key=lines[0].count) if lines else ","
    rows = [(k, row) for k, row in enumerate(csv.reader(lines, delimiter=delimiter), 1) if any(map(str.strip, row))]
    if not rows:
        raise InvalidInput(f"{path.name} is empty: a header with the columns type, diameter and unit is needed")
    columns = _columns(rows[0][1])
    for name, word in (("kind", "type"), ("diameter", "diameter")):
        if not any(column is not None and column.name == name for column in columns):
            raise InvalidInput(f"{path.name} has no column {word!r}: name it in the first line")
    return [_entry(path, k, columns, row, delimiter == ";") for k, row in rows[1:]]


def _columns(header: Sequence[str]) -> list[TableColumn | None]:
    """The column that each field of a line belongs to; of several with one meaning the first counts."""
    found: list[TableColumn | None] = []
    for text in header:
        column = _column(text.strip())
        twice = column is not None and any(one is not None and one.name == column.name for one in found)
        found.append(None if twice else column)
    return found


def _column(header: str) -> TableColumn | None:
    parts = re.fullmatch(r"(.*?)\s*(?:[(\[]([^()\[\]]*)[)\]])?", header)
    assert parts is not None
    name, bracket = parts[1], (parts[2] or "").strip()
    if "_" in bracket:
        # Fusion writes "Unit (tool_unit)" and "Unit (holder_unit)": what stands in brackets is unique.
        name, bracket = bracket, ""
    word = re.sub(r"[\s_\-]", "", name.lower()).removeprefix("tool")
    meaning = next((one for one, words in _COLUMNS.items() if word in words), None)
    return None if meaning is None else TableColumn(meaning, header, _UNITS.get(bracket.lower()))


def _entry(path: Path, line: int, columns: Sequence[TableColumn | None], row: Sequence[str],
           decimal_comma: bool) -> ToolEntry:
    texts = {column.name: (column, text.strip()) for column, text in zip(columns, row, strict=False)
             if column is not None and text.strip()}
    title = texts["title"][1] if "title" in texts else ""
    where = entry_label(path, "line", line, title)
    unit = texts["unit"][1].lower() if "unit" in texts else ""
    if unit and unit not in _UNITS:
        raise InvalidInput(f"{where}: unit is {unit!r}: use mm or inch")
    stated: dict[str, Any] = {}
    for name, (column, text) in texts.items():
        if name in ("kind", "title"):
            stated[name] = text
        elif name == "holder":
            stated[name] = _outline(where, text)
        elif name != "unit":
            stated[name] = _value(where, column, text, _UNITS.get(unit), decimal_comma)
    return entry_from_cam(where, stated)


def _outline(where: str, text: str) -> Any:
    """A holder's rows radius,z; None for its name, which says nothing of them."""
    if ";" not in text:
        return None
    try:
        return load_holder(text)["holder"]
    except InvalidInput as reason:
        raise InvalidInput(f"{where}: {reason}") from reason


def _value(where: str, column: TableColumn, text: str, unit: float | None, decimal_comma: bool) -> float | int:
    """A number of the table in mm, degrees, rev/min and m/min."""
    found = re.fullmatch(r"[tT]?\s*([-+\d.,]+(?:[eE][-+]?\d+)?|nan|inf)\s*([a-zA-Z/\"°]*)", text)
    try:
        number = float(found[1].replace(",", ".") if decimal_comma else found[1]) if found else None
    except ValueError:
        number = None
    if found is None or number is None:
        raise InvalidInput(f"{where}: {column.header} is {text!r}: a number is needed")
    if column.name in ("number", "teeth"):
        if not number.is_integer():
            raise InvalidInput(f"{where}: {column.header} is {text!r}: a whole number is needed")
        return int(number)
    if column.name not in (*_LENGTHS, "cutting_speed"):
        return number
    scale = _UNITS.get(found[2].lower()) or column.scale or unit
    if scale is None:
        raise InvalidInput(f"{where}: {column.header} has no unit: add a column unit with mm or inch, or write "
                           "the unit behind the column's name, as in diameter (mm)")
    if column.name == "cutting_speed":
        return number * _FOOT if scale == _UNITS["inch"] else number
    return to_mm(number, scale)
