"""The page of a plan: everything in it, nothing fetched, the numbers of the plan, the same bytes each time."""

import base64
import hashlib
import json
import re
import shutil
import sys
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput, MissingBackend
from toolaxis.job.files.plan_folder import OF_PLAN, read_plan, stage_folder, write_json, write_plan
from toolaxis.job.files.verdict_maps import read_views, write_views
from toolaxis.job.output.post import verdict_of
from toolaxis.job.output.report import report
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.numeric.equal_area import from_equal_area
from toolaxis.numeric.vectors import perpendicular
from toolaxis.plan.orientation import REASONS
from toolaxis.plan.plan import Plan

pytest.importorskip("plotly")
pytest.importorskip("jinja2")


class Page(HTMLParser):
    """What a page holds: addresses, texts of elements with an id, rows of tables, scripts of data."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.data: dict[str, Any] = {}
        self.words: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.rows: list[list[str]] = []
        self._script: str | None = None
        self._cell = self._quiet = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.tags.append((tag, found))
        self.addresses += [str(found[name]) for name in ("src", "href", "action", "srcset") if name in found]
        if tag == "script":
            self._script = str(found["id"]) if found.get("type") == "application/json" else ""
        self._quiet = tag in ("style", "script")
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
            self._cell = True

    def handle_endtag(self, tag: str) -> None:
        self._cell = self._cell and tag not in ("td", "th")
        if tag in ("script", "style"):
            self._script, self._quiet = None, False

    def handle_data(self, data: str) -> None:
        if self._script:
            self.data[self._script.removeprefix("data:")] = json.loads(data)
        elif not self._quiet:
            self.words.append(data)
            if self._cell:
                self.rows[-1][-1] += data

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def judged(folder: Path) -> Path:
    plan = read_plan(folder)
    verdict = verify_plan(plan)
    write_json(verdict_document(plan, verdict), folder / "verdict.json")
    write_views(plan, verdict, folder)
    return folder


def written(plan: Plan, folder: Path) -> Path:
    with stage_folder(folder) as stage:
        write_plan(plan, stage.folder)
        stage.publish(OF_PLAN)
    return folder


@pytest.fixture(scope="module")
def whole(small_plan: Plan, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with plan, verdict, maps and page."""
    folder = judged(written(small_plan, tmp_path_factory.mktemp("whole") / "wavy"))
    report(folder)
    return folder


@pytest.fixture(scope="module")
def page(whole: Path) -> Page:
    return Page((whole / "report.html").read_text(encoding="utf-8"))


def column(values: Any) -> np.ndarray:
    """An array of a figure, as the viewer decodes it."""
    if not isinstance(values, dict):
        return np.array(values, dtype=float)
    kinds = {"f4": "<f4", "i4": "<i4", "i2": "<i2", "i1": "i1", "u1": "u1", "u2": "<u2", "f8": "<f8"}
    return np.frombuffer(base64.b64decode(values["bdata"]), kinds[values["dtype"]]).astype(float)


def index_of(cells: dict[str, Any]) -> np.ndarray:
    kind = {1: "u1", 2: "<u2"}[cells["bytes"]]
    return np.frombuffer(base64.b64decode(cells["index"]), kind).reshape(cells["shape"]).astype(int)


def test_nothing_is_fetched_and_nothing_may_be(page: Page) -> None:
    assert page.addresses and all(address.startswith("data:") for address in page.addresses)
    (rule,) = [found["content"] for tag, found in page.tags if tag == "meta" and found.get("http-equiv")]
    assert rule is not None and "default-src 'none'" in rule and "http" not in rule and "*" not in rule


def test_it_shows_all_of_the_plan(page: Page, whole: Path) -> None:
    document = json.loads((whole / "plan.json").read_text())
    (op,) = document["operations"]
    rows = {row[0]: row for row in page.rows if row}
    axis = " ".join(f"{value:+.6f}" for value in op["work_coordinates"]["z"])
    assert any(axis in row for row in page.rows)
    for path in ("plan.json", "part.json", f"{op['name']}.apt", "verdict.json", "verdict-maps.npz"):
        content = (whole / path).read_bytes()
        assert rows[path] == [path, str(len(content)), hashlib.sha256(content).hexdigest()]
    for name, value in document["inputs"].items():
        if name != "tolerance":
            numbers = [value] if isinstance(value, float) else value if isinstance(value, list) else []
            text = ", ".join(f"{number:g}" for number in numbers) if numbers else str(value) if value else "-"
            assert rows[name][1].split()[0] == text.split()[0]
    others = [name for name in document["inputs"]["tolerance"] if name != "gouge"]
    assert {"machining tolerance", *(f"tolerance {name.replace('_', ' ')}" for name in others)} <= set(rows)
    assert rows["holder (radius, z)"][1] == "10, 0; 10, 40" and rows["stick-out"][1] == "50 mm"
    for value in (f"{document['length']:.1f} mm", f"{document['length'] + document['travel']:.1f} mm", "passed"):
        assert value in page.text
    kinds = set(page.data)
    assert {"scene", "tool", "times", *(f"{op['name']}:{what}" for what in ("hemisphere", "scallop", "gouge", "widths"))
            } <= kinds
    assert page.text.index("Warnings") < page.text.index("Part, passes and axes")
    assert "not checked: obstacles other than the part, machine" in page.text


def test_the_times_add_up_to_that_of_the_plan(page: Page, whole: Path) -> None:
    document = json.loads((whole / "plan.json").read_text())
    (total,) = [row for row in page.rows if row and row[0] == "all"]
    assert sum(map(float, total[1:5])) == pytest.approx(document["seconds"], abs=0.21)
    assert float(total[5]) == pytest.approx(document["seconds"], abs=0.06)


def test_each_place_of_the_hemisphere_tells_the_axis_nearest_to_it(page: Page, small_plan: Plan) -> None:
    (op,) = small_plan.operations
    found = op.orientation.map
    assert found is not None
    chart = page.data[f"{op.name}:hemisphere"]
    (cells,) = chart["cells"]
    index, texts = index_of(cells), cells["texts"]
    centre = op.face.normal(op.face.grid(24, 24)).sum(axis=0)
    centre /= np.linalg.norm(centre)
    line = np.linspace(-1, 1, index.shape[0])
    flat = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    nearest = (from_equal_area(flat, centre, perpendicular(centre)[0]) @ found.axis.T).argmax(axis=1)
    on = (flat**2).sum(axis=1) <= 1.0
    assert all(texts[k] == "" for k in index.ravel()[~on])
    for k, shown in zip(nearest[on], index.ravel()[on], strict=True):
        code = int(found.reason[k])
        assert ", ".join(f"{value:+.4f}" for value in found.axis[k] + 0.0) in texts[shown]
        assert (REASONS[code] if code else f"{op.face.area / found.length[k]:.3f} mm") in texts[shown]
        value = cells["values"][0 if code else 1][shown]
        assert value == code if code else value == pytest.approx(op.face.area / found.length[k], abs=1e-4)
    assert {int(found.reason[k]) for k in nearest[on]} >= {0, 2, 3}


def test_maps_show_no_less_than_the_judge_found(page: Page, whole: Path, small_plan: Plan) -> None:
    (op,) = small_plan.operations
    view = read_views(whole)[op.name]
    for what, cells in (("scallop", view.scallop), ("gouge", view.gouge)):
        (packed,) = page.data[f"{op.name}:{what}"]["cells"]
        index = index_of(packed)
        assert index.shape == cells.shape
        shown = np.array([np.nan if value is None else value / 1000 for value in packed["values"][0]])[index]
        there = np.isfinite(cells)
        assert np.array_equal(np.isfinite(shown), there)
        limit = {"scallop": small_plan.inputs.scallop, "gouge": small_plan.inputs.tolerance.gouge}[what]
        assert (shown[there] >= cells[there] - 1e-6).all()
        assert (shown[there] - cells[there]).max() <= 1.5 * limit / 179 + 1e-6
    most = json.loads((whole / "verdict.json").read_text())["operations"][0]["scallop_max"]
    assert np.nanmax(view.scallop) <= most + 1e-9


def test_the_scene_is_the_part_with_its_passes(page: Page, small_plan: Plan) -> None:
    (op,) = small_plan.operations
    traces = {trace["name"]: trace for trace in page.data["scene"]["figure"]["data"]}
    mesh = traces[f"1: face {op.face.label}"]
    points = np.stack([column(mesh[name]) for name in "xyz"], axis=1)
    assert np.allclose([points.min(axis=0), points.max(axis=0)], op.face.box, atol=0.01)
    corners = np.stack([column(mesh[name]) for name in "ijk"], axis=1).astype(int)
    sides = points[corners]
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1).sum()
    assert area == pytest.approx(op.face.area, rel=1e-3)
    lines = np.stack([column(traces["passes"][name]) for name in "xyz"], axis=1)
    gaps = np.isnan(lines).any(axis=1)
    assert gaps.sum() == op.orientation.passes - 1
    (bound,) = re.findall(r"lines within ([0-9.]+) mm", page.text)
    lengths = np.linalg.norm(np.diff(lines, axis=0), axis=1)
    contact = op.path
    assert contact is not None and np.nansum(lengths) == pytest.approx(op.orientation.length, rel=0.05)
    assert float(bound) < 0.01


def test_the_same_plan_gives_the_same_bytes(whole: Path, tmp_path: Path) -> None:
    first = (whole / "report.html").read_bytes()
    moved = tmp_path / whole.name
    shutil.copytree(whole, moved)
    (moved / "report.html").unlink()
    assert report(moved) == moved / "report.html"
    assert (moved / "report.html").read_bytes() == first
    assert len(first) < 8_000_000


def test_without_a_verdict_it_says_so_first(folder: Path) -> None:
    found = Page(report(folder).read_text(encoding="utf-8"))
    assert "verdict on what was made: not verified yet" in found.text
    levels = [attributes["class"] for tag, attributes in found.tags if tag == "li"]
    assert levels[0] == "stop" and "stop not verified: run toolaxis verify" in found.text
    assert not any(name.endswith(":scallop") for name in found.data)


@pytest.mark.parametrize("outcome", ["incomplete", "cancelled"])
def test_what_is_missing_comes_first(small_plan: Plan, tmp_path: Path, outcome: str) -> None:
    (op,) = small_plan.operations
    why = "the holder collides with <face> 7 & all is lost"
    lost = replace(op, number=2, path=None, frame=None,
                   orientation=replace(op.orientation, axis=None, outcome="infeasible", reasons=(why,), lobes=()))
    plan = replace(small_plan, operations=(op, lost), outcome=outcome)
    found = Page(report(written(plan, tmp_path / "p")).read_text(encoding="utf-8"))
    items = [k for k, (tag, _) in enumerate(found.tags) if tag == "li"]
    assert found.tags[items[0]][1]["class"] == "stop"
    assert f"op02-face1 has no axis: {why}" in found.text
    assert ("the plan was cancelled before all sub-surfaces were done" in found.text) == (outcome == "cancelled")
    assert found.text.index(why) < found.text.index("not checked")
    assert f"plan: {outcome}" in found.text and "1 of 2" in found.text
    names = [trace["name"] for trace in found.data["scene"]["figure"]["data"]]
    assert "2: face 1, no axis" in names


def test_a_face_without_an_axis_does_not_spoil_the_verdict_on_the_others(small_plan: Plan, tmp_path: Path) -> None:
    """Found: it said "verdict: FAILED" where every pass that was made had passed."""
    (op,) = small_plan.operations
    lost = replace(op, number=2, path=None, frame=None, zones=(), unreachable=0.25 * op.face.area,
                   orientation=replace(op.orientation, axis=None, outcome="infeasible", reasons=("a wall",), lobes=()))
    folder = written(replace(small_plan, operations=(op, lost), outcome="incomplete"), tmp_path / "p")
    plan = read_plan(folder)
    document = verdict_document(plan, verify_plan(plan))
    write_json(document, folder / "verdict.json")
    assert (document["passed"], document["made_passed"]) == (False, True)
    found = Page(report(folder).read_text(encoding="utf-8"))
    area = op.face.area
    assert "verdict on what was made: passed (1 of 1 operation); plan: incomplete" in found.text
    assert (f"stays open: {area:.1f} of {2 * area:.1f} mm2 (50.0 %), {area / 4:.1f} mm2 of it proven out of reach"
            ) in found.text
    assert "FAIL" not in found.text and ("p", {"class": "verdict part"}) in found.tags
    assert verdict_of(folder) == "passed"
    spoilt = {**document, "made_passed": False, "operations": [{**document["operations"][0], "passed": False}]}
    write_json(spoilt, folder / "verdict.json")
    failed = Page(report(folder).read_text(encoding="utf-8"))
    assert "verdict on what was made: FAILED (0 of 1 operation)" in failed.text and verdict_of(folder) == "FAILED"
    assert ("p", {"class": "verdict bad"}) in failed.tags


def test_names_are_text_and_never_code(small_plan: Plan, tmp_path: Path) -> None:
    wild = "<img src=x onerror=alert(1)>"
    (op,) = small_plan.operations
    face = replace(op.face, label="1</script><script>alert(2)</script>")
    plan = replace(small_plan, part=replace(small_plan.part, source=wild, warnings=(wild,)),
                   operations=(replace(op, face=face),))
    folder = tmp_path / wild
    folder.mkdir()
    from toolaxis.report.html.page import PlanFiles
    from toolaxis.report.html.page import page as page_of

    text = page_of(plan, PlanFiles(source=wild), wild)
    found = Page(text)
    assert not [tag for tag, _ in found.tags if tag == "img"] and "alert(2)</script>" not in text
    assert len(re.findall(r"<script", text.split("</style>")[1].split("plotly.js v")[0])) == len(found.data) + 1


def spoil_json(path: Path) -> None:
    path.write_text("{")


def other_json(path: Path) -> None:
    path.write_text(json.dumps({"schema": "toolaxis.verdict", "passed": True, "operations": [{}], "reasons": [],
                                "not_checked": []}))


@pytest.mark.parametrize(("name", "spoil"), [("verdict.json", spoil_json), ("verdict.json", other_json),
                                             ("verdict-maps.npz", spoil_json), ("plan.json", spoil_json),
                                             ("op01-face1.apt", spoil_json), ("part.json", spoil_json)])
def test_what_is_damaged_is_refused_and_the_old_page_stays(whole: Path, tmp_path: Path, name: str,
                                                           spoil: Callable[[Path], None],
                                                           capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(whole, folder)
    (folder / "report.html").write_text("old")
    before = {path.name for path in folder.iterdir()}
    spoil(folder / name)
    assert main(["report", str(folder)]) == 2
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert said.startswith("toolaxis: ") and name.split(".")[0] in said
    assert (folder / "report.html").read_text() == "old" and {path.name for path in folder.iterdir()} == before


def test_a_folder_without_a_plan_and_an_out_that_is_a_folder_are_refused(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="does not exist"):
        report(tmp_path)
    with pytest.raises(InvalidInput, match="is a folder"):
        report(folder, tmp_path)
    assert not (tmp_path / "report.html").exists() and not (folder / "report.html").exists()


def test_the_page_goes_where_it_is_asked_for(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "new" / "page.html"
    assert main(["report", str(folder), "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told == {"page": str(out), "bytes": out.stat().st_size}
    assert [path.name for path in out.parent.iterdir()] == ["page.html"] and not (folder / "report.html").exists()


@pytest.mark.parametrize("library", ["plotly", "jinja2"])
def test_without_its_libraries_it_says_what_to_install(folder: Path, monkeypatch: pytest.MonkeyPatch,
                                                       library: str) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == library or name in (
            "toolaxis.report.html.page", "toolaxis.report.html.scene_3d", "toolaxis.report.html.charts")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingBackend, match=r"pip install 'toolaxis\[report\]'"):
        report(folder)
    assert not (folder / "report.html").exists()


def test_a_new_plan_takes_the_old_page_away(folder: Path, small_plan: Plan) -> None:
    report(folder)
    written(small_plan, folder)
    assert not (folder / "report.html").exists()
