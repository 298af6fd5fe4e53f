"""The page of a batch: a row for each job that leads to its page, what needs a look first, nothing fetched."""

import json
import os
import re
import shutil
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from toolaxis.batch.report import report_batch
from toolaxis.batch.run import Batch, batch
from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput

pytest.importorskip("plotly")
pytest.importorskip("jinja2")

Made = Callable[[int], list[dict[str, Any]]]


class Page(HTMLParser):
    """Rows of the table, addresses, and sentences of the list."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.links: list[str] = []
        self.items: list[str] = []
        self._into: list[list[str]] = []
        self.feed(path.read_text(encoding="utf-8"))
        self.rows = [[" ".join(cell.split()) for cell in row] for row in self.rows]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        assert tag not in ("script", "img", "iframe")
        assert all(name not in given for name in ("src", "srcset", "action"))
        if tag == "a":
            self.links.append(str(given["href"]))
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
            self._into.append(self.rows[-1])
        if tag == "li":
            self.items.append("")
            self._into.append(self.items)

    def handle_endtag(self, tag: str) -> None:
        if tag in ("td", "th", "li"):
            self._into.pop()

    def handle_data(self, data: str) -> None:
        if self._into:
            self._into[-1][-1] += data


@pytest.fixture(scope="module")
def four(domes: Made, tmp_path_factory: pytest.TempPathFactory) -> Batch:
    """A batch of a job that is judged, one that is not, one without an axis, and one that fails."""
    one, two, three, four = domes(4)
    folder = tmp_path_factory.mktemp("batch")
    (folder / "broken.step").write_text("no STEP file\n" * 9)
    jobs = [{**one, "name": "judged part", "verify": True}, two, {**three, "limits": "cone:0,0,-1,20"},
            {**four, "part": folder / "broken.step"}]
    return batch(jobs, folder / "out <1>", workers=2)


@pytest.fixture(scope="module")
def page(four: Batch) -> Page:
    assert main(["report", str(four.folder)]) == 0
    return Page(four.folder / "report.html")


def test_every_job_has_a_row_with_the_figures_of_the_summary_and_a_way_to_its_page(four: Batch, page: Page) -> None:
    document = json.loads((four.folder / "summary.json").read_text())
    assert [row["outcome"] for row in document["jobs"]] == ["complete", "complete", "incomplete", "failed"]
    head, *rows = page.rows
    assert head[0] == "job" and [row[0] for row in rows] == [row["job"] for row in document["jobs"]]
    for row, told in zip(rows, document["jobs"], strict=True):
        assert row[1].startswith(told["outcome"]) and row[2] == told["tool"]
        if told["operations"] is not None:
            assert row[head.index("passes")] == str(told["passes"])
            assert float(row[head.index("cutting length mm")]) == pytest.approx(told["length"], abs=0.06)
    assert rows[0][1] == f"complete, verdict {document['jobs'][0]['verdict']}"
    for name in set(page.links):
        assert (four.folder / name.replace("%20", " ")).is_file()
    assert "judged%20part/report.html" in page.links


def test_what_needs_a_look_stands_first_and_says_why(four: Batch, page: Page) -> None:
    items = [re.sub(r"\s+", " ", item).strip().removeprefix("stop ") for item in page.items]
    said = {row.job: " ".join(item for item in items if item.startswith(f"{row.job}: ")) for row in four.rows}
    assert said["judged part"] == "" and len(items) == 3
    assert "not verified" in said["dome-001"] and "incomplete" in said["dome-002"] and "failed" in said["dome-003"]
    text = (four.folder / "report.html").read_text(encoding="utf-8")
    assert text.index("not verified") < text.index("<table") and "out &lt;1&gt;" in text


def test_pages_of_jobs_are_made_once_and_again_when_their_plan_changed(four: Batch, page: Page) -> None:
    own = four.folder / "dome-001" / "report.html"
    first, before = (four.folder / "report.html").read_bytes(), own.stat().st_mtime_ns
    report_batch(four.folder, workers=1)
    assert own.stat().st_mtime_ns == before and (four.folder / "report.html").read_bytes() == first
    os.utime(own, (1, 1))
    report_batch(four.folder, workers=1)
    assert own.stat().st_mtime_ns > 10**18


def test_a_job_whose_folder_is_damaged_is_told_and_the_others_are_shown(four: Batch, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(four.folder, copy)
    (copy / "dome-001" / "report.html").unlink()
    (copy / "dome-001" / "plan.json").write_text("{")
    made = Page(report_batch(copy, tmp_path / "page.html", workers=1))
    row = next(row for row in made.rows if row[0] == "dome-001")
    assert "no page" in row[-1] and "not JSON" in row[-1]
    assert [other[0] for other in made.rows[1:]] == [row.job for row in four.rows]


def test_what_is_no_summary_is_refused_in_a_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "summary.json").write_text('{"schema": "other"}')
    with pytest.raises(InvalidInput, match="is no summary of a batch of this version"):
        report_batch(tmp_path)
    assert main(["report", str(tmp_path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["summary.json"]


def test_a_job_that_is_planned_again_leaves_no_old_page(domes: Made, tmp_path: Path) -> None:
    (job,) = domes(1)
    batch([job], tmp_path / "out", workers=1)
    (tmp_path / "out" / "dome-000" / "report.html").write_text("of the plan before")
    batch([{**job, "scallop": 0.3}], tmp_path / "out", workers=1)
    assert not (tmp_path / "out" / "dome-000" / "report.html").exists()
    assert sorted(path.name for path in (tmp_path / "out").iterdir() if path.is_dir()) == ["dome-000"]
