"""Errors, tolerances and progress: the modules everything stands on."""

from math import inf, nan, radians

import numpy as np
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
        0.01, 0.1, 0.5, 1.0)
    assert tolerance.min_lead == radians(0.5)
    assert Tolerance(cutter_clearance=0.0, min_lead=0.0).cutter_clearance == 0.0


def test_the_shank_of_a_thin_cutter_keeps_a_share_of_its_diameter() -> None:
    kept = [Tolerance().for_cutter(diameter / 2).shank_clearance for diameter in (0.5, 1.0, 2.0, 4.0, 5.0, 20.0)]
    assert kept == pytest.approx([0.1, 0.1, 0.2, 0.4, 0.5, 0.5])
    assert Tolerance(cutter_clearance=0.3).for_cutter(0.5).shank_clearance == 0.3
    assert Tolerance(shank_clearance=0.05).for_cutter(0.5).shank_clearance == 0.05
    assert Tolerance(shank_share=None).for_cutter(0.5) == Tolerance(shank_share=None)
    assert Tolerance(0.02).with_clearances("0.1,0.3,2") == Tolerance(0.02, 0.1, 0.3, 2.0, shank_share=None)
    once = Tolerance().for_cutter(0.5)
    assert once.for_cutter(10.0) == once, "what was decided stays"


def test_the_chord_tolerance_is_a_share_of_scallop_height_and_machining_tolerance() -> None:
    assert [Tolerance().chord_for(scallop) for scallop in (0.01, 0.02, 0.2)] == pytest.approx([0.001, 0.002, 0.0025])
    assert Tolerance(0.002).chord_for(0.02) == pytest.approx(0.0005)
    given = Tolerance(chord=0.004)
    assert [given.chord_for(scallop) for scallop in (0.02, 0.006)] == pytest.approx([0.004, 0.003])
    assert Tolerance(0.005, chord=0.004).chord_for(0.02) == pytest.approx(0.0025)


def test_a_number_is_the_machining_tolerance() -> None:
    assert Tolerance.of(None) == Tolerance() == Tolerance.of(0.01)
    assert Tolerance.of(np.float64(0.05)) == Tolerance(gouge=0.05) and Tolerance.of(Tolerance(0.003)).gouge == 0.003


@pytest.mark.parametrize("value", [0.0, -1.0, nan, inf, 1e9, 0.2, 1e-9, True, "fine", (0.01,), 1 + 1j])
def test_a_wrong_machining_tolerance_is_refused_in_one_sentence(value: object) -> None:
    for make in (Tolerance.of, lambda given: Tolerance(gouge=given)):
        with pytest.raises(InvalidInput) as why:
            make(value)
        assert str(why.value).startswith("machining tolerance is ")
        assert str(why.value).endswith("it must be a number from 0.0005 to 0.1 mm; 0.01 mm is usual")


@pytest.mark.parametrize("name, value", [("chord", 0.0), ("trim", 0.0), ("chord", "fine"),
                                         ("holder_clearance", -0.1), ("shank_share", -0.1),
                                         ("shank_clearance", inf), ("min_lead", nan)])
def test_wrong_tolerances(name: str, value: object) -> None:
    with pytest.raises(InvalidInput, match=f"tolerance {name} is {value}: it must be"):
        Tolerance(**{name: value})  # type: ignore[arg-type]


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
