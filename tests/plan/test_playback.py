"""Places of a playback and its clock: exact on paths that can be counted, and against the time of a plan."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS
from toolaxis.plan.playback import Playback, TimedPath, seconds_between
from toolaxis.plan.timing import MachiningTime

UP = np.array([0.0, 0.0, 1.0])


def path_of(tips: object, kinds: object) -> ToolPath:
    rows = np.array(tips, dtype=float)
    axes = np.tile(UP, (len(rows), 1))
    return ToolPath(rows, rows, axes, axes, np.array(kinds, dtype=np.int8), np.array([0, len(rows)]))


#: 10 mm in, 60 mm of cuts, 10 mm out, and a link of 100 mm: 8 s at 600 mm/min and 1 s at 6000.
PATH = path_of([(0, 0, 10), (0, 0, 0), (40, 0, 0), (60, 0, 0), (60, 0, 10), (60, 0, 110)],
               [Motion.LINK, Motion.ENTRY, Motion.CUT, Motion.CUT, Motion.EXIT, Motion.LINK])


def test_motions_take_their_length_over_their_rate() -> None:
    timed = TimedPath.at_rates(PATH, 600, 6000)
    assert timed.arrival.tolist() == pytest.approx([0, 1, 5, 7, 8, 9])
    assert timed.seconds == pytest.approx(9) and timed.cutting == pytest.approx(6)
    assert timed.motion(0) == (1, 0.0) and timed.motion(2) == (2, pytest.approx(0.25))
    assert timed.motion(8.5) == (5, pytest.approx(0.5)) and timed.motion(99) == (5, 1.0)
    assert timed.motion(-1) == (1, 0.0)


def test_the_time_of_the_machine_is_spread_over_the_motions_of_each_kind() -> None:
    known = MachiningTime(cut=12, entry=3, exit=2, link=0.5)
    timed = TimedPath.at_rates(PATH, 600, 6000, known)
    assert np.diff(timed.arrival).tolist() == pytest.approx([3, 8, 4, 2, 0.5])
    assert timed.seconds == pytest.approx(known.path) and timed.cutting == pytest.approx(known.cut)
    still = path_of([(0, 0, 0)] * 3, [Motion.LINK, Motion.CUT, Motion.CUT])  # the axis turns, the tip does not move
    assert np.diff(TimedPath.at_rates(still, 600, 6000, known).arrival).tolist() == pytest.approx([6, 6])


def test_places_go_through_paths_and_index_moves() -> None:
    timed = TimedPath.at_rates(PATH, 600, 6000)
    played = Playback((timed, timed), (6.0,))
    assert played.seconds == pytest.approx(24) and played.length == pytest.approx(24)
    assert played.cutting == pytest.approx(12) and played.moving == pytest.approx(12)
    one = played.at(2 / 24)
    assert (one.operation, one.between, one.motion, one.share) == (0, False, 2, pytest.approx(0.25))
    move = played.at(12 / 24)
    assert (move.operation, move.between, move.share) == (0, True, pytest.approx(0.5))
    assert move.seconds == pytest.approx(12) and move.motion == 5
    last = played.at(1.0)
    assert (last.operation, last.between, last.motion, last.share) == (1, False, 5, 1.0)
    assert last.seconds == pytest.approx(24) and played.at(7.0) == last and played.at(-1.0) == played.at(0.0)


@pytest.mark.parametrize("between", [0.0, 0.01, 6.0, 1000.0])
def test_places_and_motions_are_each_other_s_inverse(between: float) -> None:
    timed = TimedPath.at_rates(PATH, 600, 6000)
    played = Playback((timed, timed, timed), (between, 0.0))
    for operation in range(3):
        for motion in range(1, 6):
            for share in (0.1, 0.5, 0.9):
                found = played.at(played.place_of(operation, motion, share))
                assert (found.operation, found.between, found.motion) == (operation, False, motion)
                assert found.share == pytest.approx(share)
                assert found.seconds == pytest.approx(
                    9 * operation + between * (operation > 0) + timed.arrival[motion - 1]
                    + share * np.diff(timed.arrival)[motion - 1])
    for k in range(2):
        found = played.at(played.place_between(k, 0.25))
        assert (found.operation, found.between, found.share) == (k, True, pytest.approx(0.25))


def test_an_index_move_that_takes_no_time_can_be_watched() -> None:
    timed = TimedPath.at_rates(PATH, 600, 6000)
    played = Playback((timed, timed), (0.0,))
    assert played.seconds == pytest.approx(18) and played.length == pytest.approx(18.6)
    clock = [played.at(place).seconds for place in np.linspace(0, 1, 2001)]
    assert (np.diff(clock) >= 0).all() and clock[-1] == pytest.approx(18), "the clock never runs back"
    assert played.at(played.place_between(0, 0.1)).seconds == played.at(played.place_between(0, 0.9)).seconds


def test_a_point_alone_can_be_played() -> None:
    point = path_of([(1, 2, 3)], [Motion.LINK])
    played = Playback((TimedPath.at_rates(point, 600, 6000),) * 2, (0.0,))
    assert played.seconds == 0 and (played.at(0).motion, played.at(1.0).operation) == (0, 1)
    assert 0 <= played.place_of(1, 0) <= 1


def test_what_cannot_be_played_is_refused() -> None:
    timed = TimedPath.at_rates(PATH, 600, 6000)
    for rates, words in (((0, 1), "feed rate is 0 mm/min"), ((1, -2), "rapid rate is -2 mm/min")):
        with pytest.raises(InvalidInput, match=words):
            TimedPath.at_rates(PATH, *rates)
    with pytest.raises(InvalidInput, match="the path has no points"):
        TimedPath.at_rates(path_of(np.empty((0, 3)), []), 600, 6000)
    for paths, between in (((), ()), ((timed,), (1.0,)), ((timed, timed), ())):
        with pytest.raises(InvalidInput, match="index moves between them"):
            Playback(paths, between)


def test_between_operations() -> None:
    other = np.array([0.6, 0.0, 0.8])
    assert seconds_between((UP, UP), False) == 0.0
    assert seconds_between((UP, other), False) == INDEX_SECONDS
    assert seconds_between((UP, other), True, 2.5) == 2.5 + CHANGE_SECONDS
