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
    outcomes = [record["outcome"] for record in records]
    counts = [(outcome, outcomes.count(outcome)) for outcome in ("complete", "incomplete", "failed", "not done")
              if outcome in outcomes]
    troubles: dict[str, list[Any]] = {}
    for job in jobs:
        for text in job["troubles"]:
            troubles.setdefault(text, []).append(job)
    context = {"name": name, "version": __version__, "style": page_text("page.css"), "jobs": jobs, "counts": counts,
               "complete": not troubles, "troubles": list(troubles.items()), "headings": _HEADINGS,
               "figures": _figures(records)}
    return template("batch.html.j2").render(context)


def _figures(records: Sequence[Mapping[str, Any]]) -> list[tuple[str, str]]:
    planned = [record for record in records if record["operations"] is not None]
    found = [("operations", str(sum(record["operations"] for record in planned))),
             ("passes", str(sum(record["passes"] for record in planned))),
             ("cutting length", f"{number(sum(record['length'] for record in planned) / 1000, 1)} m"),
             ("time", clock(sum(record["seconds"] for record in planned)))]
    judged = [record["verdict"] for record in planned if record["verdict"]]
    return [*found, ("verified", f"{len(judged)} of {len(records)} jobs")]


def _job(record: Mapping[str, Any], leaf: JobPage) -> dict[str, Any]:
    """What the template needs of a job."""
    ended = ", ".join(filter(None, (record["outcome"], record["cause"])))
    troubles = [] if record["outcome"] == "complete" else [": ".join(filter(None, (ended, record["reason"])))]
    troubles = troubles or [text for level, text in leaf.warnings if level == "stop"]
    counted = [f"{count} {level}" for level in _LEVELS
               if (count := sum(one == level for one, _ in leaf.warnings))]
    first = next((text for level, text in leaf.warnings if level != "stop"), "")
    told = [str(record["reason"])] if record["reason"] else [", ".join(counted), first]
    said = "; ".join(filter(None, (*told, leaf.missing)))
    level = "stop" if troubles else "mind" if any(one == "mind" for one, _ in leaf.warnings) else "good"
    return {"name": record["job"], "page": quote(leaf.address), "level": level, "troubles": troubles, "said": said,
            "cells": list(zip(_cells(record), (right for _, right in _HEADINGS[1:-1]), strict=True))}


def _cells(record: Mapping[str, Any]) -> list[str]:
    status = ", ".join(filter(None, (record["outcome"], record["cause"],
                                    record["verdict"] and f"verdict {record['verdict']}")))
    figures = ["-"] * 7 if record["operations"] is None else [
        str(record["operations"]), str(record["orientations"]), str(record["passes"]), number(record["length"], 1),
        number(record["travel"], 1), clock(record["seconds"]),
        "-" if record["gouge"] is None else number(1000 * record["gouge"], 2)]
    return [status, record["tool"], record["machine"] or "-", *figures, f"{record['spent']:.1f} s"]
