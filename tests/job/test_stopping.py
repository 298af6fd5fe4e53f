"""Stop is heard soon, in whatever stage: between two checks there is only a little work, and any check may stop."""

from math import radians
from threading import Thread

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.clearance import queries as distances
from toolaxis.errors import Cancelled
from toolaxis.feasibility import normal_cells
from toolaxis.feasibility.normal_cone import NormalField
from toolaxis.numeric.vectors import unit
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress, activate_progress, breathe
from toolaxis.shape import nurbs

#: Most work between two checks, and the mean.
POINTS, MOTIONS, MEAN = 250_000, 256, 5_000


class Counted:
    """A progress that counts checks, and the work between them."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, stop_at: int | None = None) -> None:
        self.checks, self.work, self.most, self.stop_at = 0, {"points": 0, "motions": 0}, {}, stop_at
        self.total = {"points": 0, "motions": 0}
        self.progress = Progress(None, self.asked)
        evaluate, descend = nurbs.surface_derivatives_many, distances.descend_many

        def counted_points(data, uv):
            self.done("points", len(uv))
            return evaluate(data, uv)

        def counted_motions(data, tool, asked, room, answer):
            self.done("motions", len(asked[0]))
            return descend(data, tool, asked, room, answer)

        monkeypatch.setattr(nurbs, "surface_derivatives_many", counted_points)
        monkeypatch.setattr(distances, "descend_many", counted_motions)

    def done(self, what: str, count: int) -> None:
        self.work[what] += count
        self.total[what] += count
        self.most[what] = max(self.most.get(what, 0), self.work[what])

    def asked(self) -> bool:
        self.checks += 1
        self.work = dict.fromkeys(self.work, 0)
        return self.stop_at is not None and self.checks >= self.stop_at


def test_a_loop_hears_only_whom_its_thread_listens_to() -> None:
    stop = Progress(None, lambda: True)
    breathe()
    with activate_progress(stop):
        with pytest.raises(Cancelled):
            breathe()
        with activate_progress(Progress()):
            breathe()
        other = Thread(target=breathe)
        other.start()
        other.join()
    breathe()


def test_there_is_little_work_between_two_checks(small_plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    counted = Counted(monkeypatch)
    # One core: with several, what other threads do while this one asks depends on the moment.
    made = ta.plan(small_plan.part, small_plan.tools[0], 0.1, workers=1, progress=counted.progress)
    assert made.outcome == "complete" and counted.checks > 500
    assert counted.total["points"] < MEAN * counted.checks
    assert 0 < counted.most["points"] <= POINTS and counted.most.get("motions", 0) <= MOTIONS, counted.most
    judge = Counted(monkeypatch)
    assert ta.verify(made, progress=judge.progress).passed and judge.checks > 30
    assert judge.most["points"] <= POINTS


def counted_checks(act) -> int:
    """How often a computation asks whether to stop."""
    asked = []
    act(Progress(None, lambda: bool(asked.append(1))))
    return len(asked)


def test_any_check_stops_the_whole(small_plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    def act(progress):
        return ta.plan(small_plan.part, small_plan.tools[0], 0.1, progress=progress)

    checks = counted_checks(act)
    for share in (0.001, 0.3, 0.7, 0.999):
        stopped = Counted(monkeypatch, max(1, int(share * checks)))
        made = act(stopped.progress)
        assert made.outcome == "cancelled"
        assert all(op.done for op in made.operations) and (share > 0.9 or not made.operations)
        assert stopped.checks <= stopped.stop_at + 5, "nothing goes on after it"


def test_the_judge_stops_at_any_check(small_plan: Plan) -> None:
    checks = counted_checks(lambda progress: ta.verify(small_plan, progress=progress))
    for share in (0.01, 0.5, 0.99):
        asked = iter(range(max(1, int(share * checks))))
        with pytest.raises(Cancelled):
            ta.verify(small_plan, progress=Progress(None, lambda asked=asked: next(asked, None) is None))


def test_ranges_of_angles_are_the_same_in_pieces_of_any_size(small_plan: Plan,
                                                             monkeypatch: pytest.MonkeyPatch) -> None:
    field = NormalField(small_plan.part.faces[0])
    axis = unit(np.array([0.3, 0.1, 1.0]))
    limits = radians(1.0), radians(25.0)
    found = field.range_of_angles(axis, *limits)
    monkeypatch.setattr(normal_cells, "_AT_ONCE", 7)
    counted = Counted(monkeypatch)
    with activate_progress(counted.progress):
        pieces = NormalField(field.face).range_of_angles(axis, *limits)
    assert all(np.array_equal(one, other) for one, other in zip(found, pieces, strict=True))
    assert 0 < counted.most["points"] <= 7
