"""Axes of few passes in the order of what their passes take when made, and of many in that of their counts."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.plan.choices import FEEDS
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.fixed_axis import best_axis
from toolaxis.search.local_search import CountedAxis
from toolaxis.search.rank_by_passes import _left as least_made_left
from toolaxis.search.rank_by_passes import least_made
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(6, 1)
H = 0.15
#: Along u whole passes and their ends make much of the length; along v of the same count little.
AXES = np.array([[0.103, 0.81, -0.578], [-0.113, 0.885, 0.452], [0.564, 0.795, -0.224]])


@pytest.fixture(scope="module")
def lens() -> Face:
    """One side of a thin blade that stands along +x."""
    z, x = np.meshgrid(np.linspace(-6, 6, 5), np.linspace(20, 30, 4), indexing="ij")
    return Face.from_bspline(np.dstack([x, 2 * (1 - (z / 6) ** 2) + 0.02 * (x - 20) * z, z]))


def candidates(job: FaceProblem) -> list[CountedAxis]:
    found = []
    for axis, feed in zip(AXES / np.linalg.norm(AXES, axis=1)[:, None], (0, 0, 1), strict=True):
        passes, length = job.worth.counted(axis, FEEDS[feed])
        found.append(CountedAxis(axis, feed, job.worth.value(axis, feed, passes, length), passes, length, 0.0))
    return sorted(found, key=lambda one: one.value)


def test_of_few_passes_the_shortest_that_is_made_comes_first(lens: Face) -> None:
    job = task(lens, TOOL, H)
    found = candidates(job)
    lengths = [job.made(one.axis, FEEDS[one.feed]).length(Motion.CUT) for one in found]
    assert np.argmin(lengths) == 2 and lengths[2] < 0.95 * min(lengths[:2])  # or this would show nothing
    ordered = least_made(job.worth, found, job.made)
    assert [found.index(one) for one in ordered] == np.argsort(lengths).tolist()


def test_passes_that_are_made_decide_where_they_are_to_be_few(lens: Face) -> None:
    job = task(lens, TOOL, H, objective="passes")
    found = candidates(job)
    low = [replace(one, value=5.0) for one in found]
    ordered = least_made(job.worth, low[::-1], job.made)
    numbers = [job.made(one.axis, FEEDS[one.feed]).passes for one in ordered]
    assert numbers == sorted(numbers) and numbers[0] < numbers[-1]
    same = [replace(one, value=5.0 + k) for k, one in enumerate([found[0]] * 2)]
    assert least_made(job.worth, same, job.made) == same


def test_what_counts_more_than_the_best_takes_is_not_made(lens: Face) -> None:
    job, asked = task(lens, TOOL, H), []
    found = candidates(job)

    def made(axis, feed):
        asked.append(axis)
        return job.made(axis, feed)

    far = [found[0], replace(found[2], value=1000.0), replace(found[1], value=1001.0)]
    assert least_made(job.worth, far, made) == far
    assert len(asked) == 1


def test_many_passes_keep_the_order_of_their_counts(lens: Face) -> None:
    job = task(lens, TOOL, H)
    found = [replace(one, passes=40.0) for one in candidates(job)]
    assert least_made(job.worth, found, job.made) is found
    assert least_made(job.worth, found[:1], job.made) == found[:1]


def test_what_stays_is_charged_once_beside_what_is_made(lens: Face) -> None:
    """Passes made leave out already what stays: with it they come to the value by the count."""
    job = task(lens, TOOL, H)
    one = candidates(job)[0]
    left = replace(one, unreached=0.3, value=one.length * job.worth.charge(one.length, 0.3))
    assert least_made_left(job.worth, one) == pytest.approx(0, abs=1e-9)
    assert 0.7 * one.length + least_made_left(job.worth, left) == pytest.approx(left.value, rel=1e-12)


def test_no_more_is_left_for_the_sake_of_whole_passes(lens: Face) -> None:
    job = task(lens, TOOL, H)
    found = candidates(job)
    more = [*found[:2], replace(found[2], unreached=0.1)]
    assert least_made(job.worth, more, job.made)[2] is more[2]


def test_what_cannot_be_made_goes_behind_what_can(lens: Face) -> None:
    job = task(lens, TOOL, H)
    found = candidates(job)

    def made(axis, feed):
        if axis is found[0].axis:
            raise InvalidInput("no strip")
        return job.made(axis, feed)

    assert least_made(job.worth, found, made)[-1] is found[0]


def test_no_other_lobe_would_have_been_shorter(lens: Face) -> None:
    job, best = task(lens, TOOL, H), best_axis(lens, TOOL, H, limits="cone:0,1,0,75")
    assert best.lobes
    for other in best.lobes:
        assert best.length <= job.made(other.axis, other.feed).length(Motion.CUT) * 1.001
