"""A batch as one HTML page: what needs a look, and a table of jobs that leads to the page of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

from toolaxis import __version__
from toolaxis.plan.baseline import clock
from toolaxis.report.html.page import page_text, template
from toolaxis.report.tables import number

Warnings = Sequence[tuple[str, str]]

_HEADINGS = (("job", False), ("status", False), ("tool", False), ("machine", False), ("operations", True),
             ("axes", True), ("passes", True), ("cutting length mm", True), ("links mm", True), ("time", True),
             ("gouge µm", True), ("planned in", True), ("warnings", False))
_LEVELS = ("stop", "mind", "note")


@dataclass(frozen=True)
class JobPage:
    """The page of a job.

    Attributes
    ----------
    address : str
        From the folder of the batch; empty where there is no page.
    warnings : sequence of (str, str)
        Level and sentence of each, the gravest first.
    missing : str
        Why there is no page, of a job that has a plan.
    """

    address: str = ""
    warnings: Warnings = ()
    missing: str = ""


def batch_page(name: str, records: Sequence[Mapping[str, Any]], leaves: Mapping[str, JobPage]) -> str:
    """The page of a batch.

    Parameters
    ----------
    name : str
        Of the batch, for the title.
    records : sequence of mappings
        The jobs of its summary.
    leaves : mapping of str to Leaf
        Their pages, by the names of the jobs.

    Returns
    -------
    str
        HTML that fetches nothing; the same for the same batch.
    """
    jobs = [_job(record, leaves.get(record["job"], JobPage())) for record in records]
    jobs_by_trouble: dict[str, list[Any]] = {}
    for job in jobs:
        for text in job["troubles"]:
            jobs_by_trouble.setdefault(text, []).append(job)
    context = {
        "name": name,
        "version": __version__,
        "style": page_text("page.css"),
        "jobs": jobs,
        "counts": _count_outcomes(records),
        "complete": not jobs_by_trouble,
        "troubles": list(jobs_by_trouble.items()),
        "headings": _HEADINGS,
        "figures": _figures(records),
    }
    return template("batch.html.j2").render(context)


def _count_outcomes(records: Sequence[Mapping[str, Any]]) -> list[tuple[str, int]]:
    """The outcomes that there are, and how many jobs ended so."""
    outcomes = [record["outcome"] for record in records]
    known = ("complete", "incomplete", "failed", "not done")
    return [(outcome, outcomes.count(outcome)) for outcome in known if outcome in outcomes]


def _figures(records: Sequence[Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Sums over all jobs that have a plan, by name."""
    planned = [record for record in records if record["operations"] is not None]
    operations = sum(record["operations"] for record in planned)
    passes = sum(record["passes"] for record in planned)
    metres = sum(record["length"] for record in planned) / 1000
    seconds = sum(record["seconds"] for record in planned)
    judged = sum(bool(record["verdict"]) for record in planned)
    return [
        ("operations", str(operations)),
        ("passes", str(passes)),
        ("cutting length", f"{number(metres, 1)} m"),
        ("time", clock(seconds)),
        ("verified", f"{judged} of {len(records)} jobs"),
    ]


def _join(separator: str, *texts: str | None) -> str:
    """Those of some texts that say something."""
    return separator.join(filter(None, texts))


def _job(record: Mapping[str, Any], leaf: JobPage) -> dict[str, Any]:
    """What the template needs of a job."""
    troubles = _troubles(record, leaf)
    if troubles:
        level = "stop"
    else:
        level = "mind" if any(one == "mind" for one, _ in leaf.warnings) else "good"
    to_the_right = [right for _, right in _HEADINGS[1:-1]]
    return {
        "name": record["job"],
        "page": quote(leaf.address),
        "level": level,
        "troubles": troubles,
        "said": _remark(record, leaf),
        "cells": list(zip(_cells(record), to_the_right, strict=True)),
    }


def _troubles(record: Mapping[str, Any], leaf: JobPage) -> list[str]:
    """Why a job needs a look: how it ended where it did not get through, else its gravest warnings."""
    if record["outcome"] != "complete":
        ended = _join(", ", record["outcome"], record["cause"])
        return [_join(": ", ended, record["reason"])]
    return [text for level, text in leaf.warnings if level == "stop"]


def _remark(record: Mapping[str, Any], leaf: JobPage) -> str:
    """The last column: why a job failed, or how many warnings it has and the first one that is not grave."""
    if record["reason"]:
        return _join("; ", str(record["reason"]), leaf.missing)
    levels = [level for level, _ in leaf.warnings]
    counts = [f"{levels.count(level)} {level}" for level in _LEVELS if level in levels]
    first = next((text for level, text in leaf.warnings if level != "stop"), "")
    return _join("; ", ", ".join(counts), first, leaf.missing)


def _cells(record: Mapping[str, Any]) -> list[str]:
    """The other columns, but for the name."""
    verdict = f"verdict {record['verdict']}" if record["verdict"] else ""
    status = _join(", ", record["outcome"], record["cause"], verdict)
    figures = ["-"] * 7 if record["operations"] is None else _plan_figures(record)
    return [status, record["tool"], record["machine"] or "-", *figures, f"{record['spent']:.1f} s"]


def _plan_figures(record: Mapping[str, Any]) -> list[str]:
    gouge = record["gouge"]
    return [
        str(record["operations"]),
        str(record["orientations"]),
        str(record["passes"]),
        number(record["length"], 1),
        number(record["travel"], 1),
        clock(record["seconds"]),
        "-" if gouge is None else number(1000 * gouge, 2),
    ]
