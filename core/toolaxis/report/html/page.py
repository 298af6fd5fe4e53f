"""A plan as one HTML page that needs nothing else: template, viewer and data inlined."""

import json
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import PurePath
from typing import Any

import jinja2
import numpy as np
import plotly.io
import plotly.offline
from numpy.typing import NDArray

from toolaxis import __version__
from toolaxis.cldata.toolpath import Motion
from toolaxis.plan.baseline import clock
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import INDEX_SECONDS, Plan, outcome_of
from toolaxis.report.areas_aside import describe_open
from toolaxis.report.figures.splat_renderer import mean_direction
from toolaxis.report.html import charts
from toolaxis.report.html.charts import PageFigure
from toolaxis.report.html.page_tables import (
    Rows,
    file_rows,
    orientation_rows,
    rows_of,
    setting_rows,
    time_rows,
    verdict_rows,
    zone_rows,
)
from toolaxis.report.html.scene_3d import scene
from toolaxis.report.tables import baselines_table, number, open_table, options_table, plan_table, reckoning
from toolaxis.report.verdict_words import PASSED, count_passed, name_verdict
from toolaxis.report.warnings import warnings_of
from toolaxis.verify.axis_view import RestMaterialView, coarser

Array = NDArray[np.float64]
Curve = tuple[Array, Array]

#: Worst places that are marked.
_PLACES = 8
#: Cells of all maps of a page together, and of one at most.
_CELLS, _MOST_CELLS = 1_200_000, 90_000


@dataclass(frozen=True, eq=False)
class PlanFiles:
    """What stands beside a plan, or follows from it.

    Attributes
    ----------
    verdict : mapping or None
        The document of verdict.json.
    views : mapping of str to View
        The judge's maps by operation.
    widths : mapping of str to sequence of ((n, 3) array, (n,) array)
        Contact points along the passes of an operation, mm, and strip widths there, mm.
    feeds : mapping of str to pair of (n,) arrays
        Way along the longest pass of an operation, mm, and feed there, mm/min.
    files : sequence of (str, int, str)
        Name, bytes and SHA-256 of each file.
    source : str
        What the part's file was called where it was planned; empty where it was no file.
    still : bytes
        Picture of the plan (PNG), for print and where nothing can be turned; empty for none.
    """

    verdict: Mapping[str, Any] | None = None
    views: Mapping[str, RestMaterialView] = field(default_factory=dict)
    widths: Mapping[str, Sequence[Curve]] = field(default_factory=dict)
    feeds: Mapping[str, Curve] = field(default_factory=dict)
    files: Sequence[tuple[str, int, str]] = ()
    source: str = ""
    still: bytes = b""


def page(plan: Plan, beside: PlanFiles, name: str) -> str:
    """The page of a plan.

    Parameters
    ----------
    plan : Plan
    beside : PlanFiles
    name : str
        Of the plan, for the title.

    Returns
    -------
    str
        HTML that fetches nothing; the same for the same plan.
    """
    made = scene(plan, _worst(beside.verdict))
    tools = {f"tool {k}" if k > 1 else "tool": charts.tool_chart(tool) for k, tool in enumerate(plan.used_tools, 1)}
    common = {"scene": PageFigure(made.figure), **tools}
    done = [op for op in plan.operations if op.done]
    copies = {} if plan.blades is None else plan.blades.copies
    originals = [op for op in done if op.number not in copies]
    seconds = _times(plan)
    if originals:
        shown = [one for op, one in zip(done, seconds, strict=True) if op.number not in copies]
        common["times"] = charts.times_chart(originals, shown)
    own = {op.name: _operation_charts(plan, op, beside) for op in plan.operations}
    data = {name: _json(chart) for name, chart in common.items()}
    data |= {f"{name}:{what}": _json(chart) for name, found in own.items() for what, chart in found.items()}
    chooser = [{"name": name, "said": _said(plan, name), "charts": list(found)} for name, found in own.items() if found]
    warnings = warnings_of(plan, beside.verdict)
    context = {
        "name": name, "plan": plan, "version": __version__, "verdict": _verdict_line(plan, beside.verdict),
        "warnings": warnings, "told": json.dumps([[one.level, one.text] for one in warnings]),
        "figures": _figures(plan),
        "tables": _tables(plan, beside, (done, seconds)), "chooser": chooser, "data": data,
        "still": b64encode(beside.still).decode("ascii"),
        "bounds": _bounds(made.off, made.apart, beside, bool(copies)),
        "plotly": plotly.offline.get_plotlyjs(), "style": page_text("page.css"), "script": page_text("page.js"),
        "source": PurePath(beside.source).name or "given as faces", "has_feeds": bool(beside.feeds),
        "has_views": bool(beside.views),
    }
    return template("page.html.j2").render(context)


def page_text(name: str) -> str:
    """A file of the page: template, style or script.

    Parameters
    ----------
    name : str
    """
    return files("toolaxis.report.html").joinpath(name).read_text("utf-8")


@cache
def template(name: str) -> jinja2.Template:
    """A template of this package, by the name of its file.

    Parameters
    ----------
    name : str
    """
    world = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    return world.from_string(page_text(name))


def _json(chart: PageFigure) -> str:
    """A chart as JSON that may stand in a script element."""
    figure = json.loads(plotly.io.to_json(chart.figure, validate=False, engine="json", remove_uids=True))
    text = json.dumps({"figure": figure, "cells": chart.cells}, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _worst(verdict: Mapping[str, Any] | None) -> dict[str, list[dict[str, Any]]]:
    """The worst places that the judge found, each of another operation."""
    found: dict[str, list[dict[str, Any]]] = {}
    judged = () if verdict is None else verdict["operations"]
    for label, key in (("worst scallop", "worst_scallop"), ("worst gouge", "worst_gouge")):
        places = [(op["name"], place) for op in judged for place in op[key][:1]]
        places.sort(key=lambda one: -np.inf if one[1]["value"] is None else -one[1]["value"])
        found[label] = [{"point": place["point"], "text": f"{name}: {label} {number(place['value'], 4)} mm, "
                         f"face {place['face']}"} for name, place in places[:_PLACES]]
    return found


def _operation_charts(plan: Plan, op: Operation, beside: PlanFiles) -> dict[str, PageFigure]:
    """The charts of one operation by what they show."""
    found: dict[str, PageFigure] = {}
    copies = {} if plan.blades is None else plan.blades.copies
    if op.number not in copies and op.orientation.map is not None and len(op.orientation.map.axis):
        normal = mean_direction(op.face.normal(grid if len(grid := op.face.grid(24, 24)) else op.face.outline[0]))
        found["hemisphere"] = charts.hemisphere_chart(op.orientation.map, op.face.area, normal, _marks(op, normal),
                                                      op.name)
    if op.name in beside.views:
        view = coarser(beside.views[op.name], min(_CELLS // max(len(beside.views), 1), _MOST_CELLS))
        inputs = plan.inputs
        for what, limit in (("scallop", inputs.scallop), ("gouge", inputs.tolerance.gouge)):
            found[what] = charts.map_chart(view, what, limit, op.name)
    if op.frame is not None and beside.widths.get(op.name):
        found["widths"] = charts.widths_chart(beside.widths[op.name], (op.frame.x, op.frame.y), op.frame.origin,
                                              op.name)
    if op.name in beside.feeds:
        found["feed"] = charts.feed_chart(*beside.feeds[op.name], plan.inputs.feedrate, op.name)
    return found


def _marks(op: Operation, normal: Array) -> dict[str, Array]:
    marks: dict[str, Array] = {}
    if op.orientation.axis is not None:
        marks["chosen"] = np.asarray(op.orientation.axis, dtype=float)
    lobes = [lobe.axis for lobe in op.orientation.lobes if lobe.axis is not None]
    if lobes:
        marks["other lobes"] = np.array(lobes)
    marks["mean normal"] = normal
    return marks


def _said(plan: Plan, name: str) -> str:
    """What the chooser calls an operation."""
    op = next(one for one in plan.operations if one.name == name)
    copies = {} if plan.blades is None else plan.blades.copies
    if op.number in copies:
        original = next(one.name for one in plan.operations if one.number == copies[op.number])
        return f"{name} (turned copy of {original})"
    return name if op.done else f"{name} ({'rest material' if op.left else 'no axis'})"


def _times(plan: Plan) -> list[dict[str, float]]:
    """Time of each operation that has a path, by kind of motion, s; together what `Plan.seconds` says."""
    found: list[dict[str, float]] = []
    before = None
    for op in plan.operations:
        if op.path is None:
            continue
        time = op.time if plan.timed else None
        if op.time is not None:
            one = {"cut": op.time.cut, "entry and exit": op.time.entry + op.time.exit, "link": op.time.link}
        else:
            slow, fast = 60 / plan.inputs.feedrate, 60 / plan.inputs.rapid
            one = {"cut": slow * op.path.length(Motion.CUT), "link": fast * op.path.length(Motion.LINK),
                   "entry and exit": slow * op.path.length(Motion.ENTRY, Motion.EXIT)}
        axis = op.orientation.axis
        turns = before is not None and axis is not None and bool((np.abs(axis - before) > 1e-9).any())
        found.append({**one, "index": time.index if time is not None else INDEX_SECONDS if turns else 0.0})
        before = axis
    return found


def _verdict_line(plan: Plan, verdict: Mapping[str, Any] | None) -> dict[str, str]:
    """What the page says first: the judge on what was made, what came of the plan, and what stays open."""
    word = name_verdict(verdict)
    level = "bad" if word != PASSED else "good" if plan.outcome == "complete" else "part"
    return {"level": level, "word": word, "count": count_passed(verdict), "open": describe_open(plan)}


def _figures(plan: Plan) -> list[tuple[str, str]]:
    """The numbers that stand on top."""
    done = [op for op in plan.operations if op.done]
    needed = sum(op.done or outcome_of([op], plan.blades) == "incomplete" for op in plan.operations)
    needed += sum(one.whole for one in plan.unplanned)
    moves = any(op.orientation.lead is not None for op in done)
    return [("outcome", plan.outcome), ("sub-surfaces", f"{len(done)} of {needed}"),
            ("orientations", "moving axes" if moves else str(plan.orientations)),
            ("passes", str(sum(op.orientation.passes for op in done))), ("cutting length", f"{plan.length:.1f} mm"),
            ("with links", f"{plan.length + plan.travel:.1f} mm"), ("time", f"{clock(plan.seconds)} min"),
            ("gouge at most", f"{number(max((op.orientation.gouge for op in done), default=None), 4)} mm")]


def _tables(plan: Plan, beside: PlanFiles, times: tuple[list[Operation], list[dict[str, float]]]) -> dict[str, Rows]:
    found = {"operations": rows_of(plan_table(plan)), "orientations": orientation_rows(plan)}
    if (still_open := open_table(plan)) is not None:
        found["open"] = rows_of(still_open)
    if beside.verdict is not None:
        found["verdict"] = verdict_rows(plan, beside.verdict)
    if times[0]:
        found["times"] = time_rows(*times, reckoning(plan).splitlines())
    zones = zone_rows(plan)
    if zones.rows:
        found["zones"] = zones
    if plan.baselines:
        found["baselines"] = rows_of(baselines_table(plan))
    if plan.options:
        found["options"] = rows_of(options_table(plan.options))
    return found | {"settings": setting_rows(plan, beside.source), "files": file_rows(beside.files)}


def _bounds(off: float, apart: float, beside: PlanFiles, copies: bool) -> list[str]:
    """What the drawings leave out, in sentences."""
    said = [f"In three dimensions faces are drawn as triangles, at most {off:.3f} mm off where that was measured, and "
            f"passes as lines within {apart:.3f} mm of their points."]
    if copies:
        said.append("Turned copies have the colour of their original; their passes are not drawn.")
    if beside.views:
        cells = [coarser(view, min(_CELLS // len(beside.views), _MOST_CELLS)).cell for view in beside.views.values()]
        size = f"{min(cells):.2f}" if max(cells) < 1.005 * min(cells) else f"{min(cells):.2f} to {max(cells):.2f}"
        said.append(f"Maps show the greatest value in each cell of {size} mm, rounded up to the next level of colour.")
    return said
