"""What a batch came to: a row for each job, as CSV and as JSON."""

import csv
import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

NAME, VERSION = "toolaxis.batch", 1
_FIGURES = ("operations", "without_axis", "orientations", "passes", "length", "travel", "seconds", "gouge", "verdict")
_FIRST = ("job", "outcome", "cause", "reason", "part", "tool", "machine", "scallop", "folder")


@dataclass(frozen=True)
class JobRow:
    """A job and what came of it.

    Attributes
    ----------
    job, part, tool, machine : str
    scallop : float
        mm
    outcome : str
        "complete", "incomplete" (a face has no axis, or the verdict is fail), "failed" (there is no plan) or
        "not done".
    cause, reason : str
        See `toolaxis.batch.task.BatchAnswer`.
    figures : dict
        operations, those without_axis, orientations (different axes), passes, length of cuts and travel in links, mm,
        machining time, s, greatest gouge, mm, verdict.
    folder : str
        Name of the job's folder in that of the batch; empty where there is none.
    spent : float
        s that it took to plan; not a property of the plan, and not in the job's folder.
    """

    job: str
    part: str
    tool: str
    machine: str
    scallop: float
    outcome: str = "not done"
    cause: str = ""
    reason: str = ""
    figures: dict[str, Any] = field(default_factory=dict)
    folder: str = ""
    spent: float = 0.0

    @property
    def record(self) -> dict[str, Any]:
        """The row as a flat record."""
        return {**{name: getattr(self, name) for name in _FIRST},
                **{name: self.figures.get(name) for name in _FIGURES}, "spent": round(self.spent, 3)}


def summary_document(rows: Sequence[JobRow]) -> dict[str, Any]:
    """Rows as a document that `json.dump` takes.

    Parameters
    ----------
    rows : sequence of JobRow

    Returns
    -------
    dict
        Lengths in mm, times in s; "counts" by outcome.
    """
    return {"schema": NAME, "version": VERSION, "units": {"length": "mm", "time": "s"},
            "counts": dict(sorted(Counter(row.outcome for row in rows).items())), "jobs": [row.record for row in rows]}


def summary_csv(rows: Sequence[JobRow]) -> str:
    """Rows as comma-separated values with a line of names first.

    Parameters
    ----------
    rows : sequence of JobRow
    """
    text = io.StringIO()
    writer = csv.DictWriter(text, (*_FIRST, *_FIGURES, "spent"), lineterminator="\n")
    writer.writeheader()
    writer.writerows(row.record for row in rows)
    return text.getvalue()
