"""Errors, tolerances and progress: the modules everything stands on."""

from math import inf, nan, radians

import pytest

from toolaxis.errors import Cancelled, InvalidInput, JobError, MissingBackend, ToolAxisError, UnsupportedGeometry
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.tolerances import Tolerance


def test_one_family_of_errors() -> None:
    family = (InvalidInput, UnsupportedGeometry, MissingBackend, JobError, Cancelled)
    assert all(issubclass(kind, ToolAxisError) for kind in family)
    assert issubclass(InvalidInput, ValueError) and issubclass(MissingBackend, ImportError)


def test_job_errors_name_stage_and_item() -> None:
    error = JobError("passes", "face 7", "no axis reaches it")
    assert (error.stage, error.item, str(error)) == ("passes", "face 7", "passes, face 7: no axis reaches it")


def test_default_tolerances() -> None:
    tolerance = Tolerance()
    assert (tolerance.gouge, tolerance.cutter_clearance, tolerance.shank_clearance, tolerance.holder_clearance) == (
        0.002, 0.1, 0.5, 1.0)
    assert tolerance.chord_for(0.02) == pytest.approx(0.0004) and Tolerance(chord=0.01).chord_for(0.02) == 0.01
    assert tolerance.min_lead == radians(0.5)
    assert Tolerance(cutter_clearance=0.0, min_lead=0.0).cutter_clearance == 0.0


@pytest.mark.parametrize("name, value", [("gouge", 0.0), ("gouge", -1.0), ("gouge", nan), ("chord", 0.0), ("trim", 0.0),
                                         ("holder_clearance", -0.1), ("shank_clearance", inf), ("min_lead", nan)])
def test_wrong_tolerances(name: str, value: float) -> None:
    with pytest.raises(InvalidInput, match=f"tolerance {name} is {value}: it must be"):
        Tolerance(**{name: value})


def test_progress_offers_what_is_made_only_when_asked_for() -> None:
    taken: list[object] = []
    makes = iter([True, False])
    progress = Progress(None, None, lambda make: taken.append(make()) if next(makes) else None)
    for part in (progress, progress.within("face 1")):
        part.offer(lambda: "map")
    assert taken == ["map"]
    NO_PROGRESS.offer(lambda: taken.append("never"))
    assert taken == ["map"]


def test_progress_reports_and_stops() -> None:
    seen: list[tuple[str, float, float]] = []
    asked = iter([False, False, True])
    progress = Progress(lambda *report: seen.append(report), lambda: next(asked))
    progress.report("search", 1, 3)
    progress.check()
    with pytest.raises(Cancelled, match="cancelled by the user"):
        progress.report("search", 2, 3)
    assert seen == [("search", 1, 3)]
    NO_PROGRESS.report("search", 1, 1)
