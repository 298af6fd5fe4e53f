"""4+1 axes: one rotary axis stands still, the other turns without jumps, and passes are never longer than with both
still."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import SKIN, CheckSurfaces
from toolaxis.feasibility.violations import GOUGE
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.path.moving_axis import MovingCut
from toolaxis.search.face_problem import task
from toolaxis.strategies.common.path_check import prove_moving
from toolaxis.strategies.four_plus_one.clamp_angle import ClampSearch
from toolaxis.strategies.four_plus_one.links import free_angles, on_the_circle
from toolaxis.strategies.four_plus_one.passes import AngleField, Clamp, ClampedAxis, ClampedChart
from toolaxis.strategies.four_plus_one.search import (
    FourPlusOneSearch,
    _ways,
    clampable_angles,
    four_plus_one,
    machine_of,
    screen_angles,
)
from toolaxis.tools.tool import Tool

from .conftest import flat, floor_and_wall, seeded  # type: ignore[import-not-found]

TOOL = Tool.torus(12, 1, stickout=40, holder=[(14, 0), (14, 30)])
H = 0.05
#: Greatest turn of the free axis on this bent face, rad/mm.
STEEP = 0.15
MIKRON = load_machine("mikron-ucp-710")


@pytest.fixture(scope="module")
def searched():
    """One search, with the clamped angles that it ranks before passes are laid."""
    job, ranked, found = task(seeded(5, 1.2), TOOL, H, Mounting(MIKRON)), [], FourPlusOneSearch.found
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FourPlusOneSearch, "found", lambda self, fixed: ranked.extend(found(self, fixed)) or ranked)
        return job, *four_plus_one(job), ranked


@pytest.fixture(scope="module")
def found(searched):
    return searched[:3]


def _clamp(orientation) -> tuple[int, float]:
    name, said = orientation.reasons[0].split(" clamped at ")
    return [axis.name for axis in MIKRON.rotary].index(name), np.radians(float(said.split()[0]))


def test_it_is_shorter_than_the_best_fixed_axis_here_and_proven(found) -> None:
    job, orientation, path = found
    said = next(why for why in orientation.reasons if why.startswith("the best fixed axis takes"))
    fixed = float(said.split(" of ")[1].split()[0])
    assert orientation.outcome == "feasible" and path is not None and orientation.lead is not None
    assert orientation.length == path.length(Motion.CUT) < 0.95 * fixed
    assert prove_moving(path, TOOL, job.groups).witness is None
    assert orientation.gouge <= job.feasibility.tolerance.gouge == 0.01 and orientation.passes == path.passes


def test_one_axis_stands_still_and_the_other_has_no_jump(found) -> None:
    _, orientation, path = found
    which, angle = _clamp(orientation)
    along = following(MIKRON, path)
    clamped, free = along.rotary[:, which], along.rotary[:, 1 - which]
    assert np.ptp(clamped) < np.radians(0.02)
    assert clamped[0] == pytest.approx(angle, abs=np.radians(0.002))  # what is said is what the machine does
    turn, way = np.abs(np.diff(free)), np.linalg.norm(np.diff(along.tips, axis=0), axis=1)
    cut = path.kind[along.arrival[1:]] == Motion.CUT
    assert np.ptp(free) > np.radians(3) and turn[~cut].max() <= np.radians(1.01)
    assert (turn[cut] <= 1e-3 + STEEP * way[cut]).all()


@pytest.mark.parametrize("which", [0, 1])
def test_both_solutions_of_the_machine_are_told(which: int) -> None:
    """Below 30 deg A reaches both: they are told, the one that begins near zero first."""
    turn = np.radians(np.linspace(5, 25, 30))
    clamp = Clamp(MIKRON, which, np.radians([40.0, 12.0][which]))
    axes = clamp.axes(turn)
    cl = np.column_stack([np.linspace(0, 30, 30), np.zeros(30), np.zeros(30)])
    path = ToolPath(cl, cl, axes, axes, np.zeros(30, dtype=np.int8), np.array([0, 30]))
    told = _ways(Mounting(MIKRON), which, path)
    said = np.array([[float(word) for part in row for word in part.split() if word[-1].isdigit()] for row in told])
    wanted = [[[40, 5, 25], [-140, -25, -5]], [[12, 5, 25], [-12, -175, -155]]][which]
    assert np.allclose(said, wanted, atol=2e-3)
    if which == 0:
        upright = clamp.axes(turn - np.radians(15))  # past the place where both meet
        told = _ways(Mounting(MIKRON), 0, replace(path, axis=upright, normal=upright))
        assert [part.split()[3] for part, _ in told] == ["40.000", "-140.000"]
        steep = clamp.axes(turn + np.radians(30))
        assert len(_ways(Mounting(MIKRON), 0, replace(path, axis=steep, normal=steep))) == 1


def test_no_other_clamped_angle_is_counted_shorter(searched) -> None:
    """The first that is ranked, against angles all over the range and beside it: within 1 %."""
    job, best = searched[0], searched[3][0]
    finder = FourPlusOneSearch(ClampSearch(job, machine_of(job)))
    clamp, others = best.candidate.clamp, []
    for which, axis in enumerate(MIKRON.rotary):
        for angle in clampable_angles(axis, np.radians(150.0)):
            others += [(finder.search.clamp(which, float(angle)), feed) for feed in ("u", "v")]
    others += [(finder.search.clamp(clamp.which, clamp.angle + np.radians(off)), best.candidate.feed)
               for off in (-0.5, 0.5)]
    rough = [(one, finder.search.reckoned(*one)) for one in others]
    limit = 1.1 * best.count.length
    near = [finder.choice(*one) for one, about in rough if about is not None and about.length < limit]
    ranked = sorted((one for one in near if one is not None), key=lambda one: one.count.length)
    assert ranked and best.count.length <= 1.01 * min(finder.moving(one).count.length for one in ranked[:1])


def test_the_free_angle_goes_on_from_pass_to_pass(found) -> None:
    """Beside each other, places of two passes have angles that differ as little as along a pass."""
    _, orientation, path = found
    which, angle = _clamp(orientation)
    cut = path.kind == Motion.CUT
    free = free_angles(path.axis, Clamp(MIKRON, which, angle))[cut]
    number = np.searchsorted(path.breaks, np.flatnonzero(cut), side="right")
    for k in np.unique(number)[:-1]:
        one, other = path.cc[cut][number == k], path.cc[cut][number == k + 1]
        apart = np.linalg.norm(one[:, None] - other, axis=2)
        turn = np.abs(free[number == k] - free[number == k + 1][apart.argmin(axis=1)])
        assert (turn <= 1e-3 + STEEP * apart.min(axis=1)).all()


def test_screening_takes_places_that_are_better_than_their_neighbours(found) -> None:
    job = found[0]
    rows = screen_angles(ClampSearch(job, machine_of(job)), np.radians(12.0))
    lengths = [one.length for one in rows]
    assert lengths == sorted(lengths) and len(set(np.round(lengths, 6))) == len(lengths)


@pytest.mark.parametrize("name", ["mikron-ucp-710", "dmg-dmu-60t", "head-head-portal", "nutating-head"])
@pytest.mark.parametrize("which", [0, 1])
def test_free_angles_of_axes_on_the_circle_are_theirs(name: str, which: int) -> None:
    machine = load_machine(name)
    free = machine.rotary[1 - which]
    low, high = max(free.low, -3.0), min(free.high, 3.0)
    angles = np.linspace(low + 0.1, high - 0.1, 40)
    clamp = Clamp(machine, which, 0.35)
    axes = clamp.axes(angles)
    again = free_angles(axes, clamp)
    assert np.allclose(clamp.axes(again), axes, atol=1e-12) and np.allclose(np.diff(again), np.diff(angles), atol=1e-9)


def test_links_turn_the_free_axis_alone(found) -> None:
    _, orientation, path = found
    which, angle = _clamp(orientation)
    clamp = Clamp(MIKRON, which, angle)
    off = path.axis + 0.02 * np.cross(path.axis, [0.3, 1.0, 0.2]) * (path.kind != Motion.CUT)[:, None]
    bent = replace(path, axis=off / np.linalg.norm(off, axis=1, keepdims=True))
    made = on_the_circle(bent, clamp)
    assert np.allclose(clamp.axes(free_angles(made.axis, clamp)), made.axis, atol=1e-12)
    assert made.length() == pytest.approx(path.length(), rel=1e-9) and made.passes == path.passes
    cut = made.kind == Motion.CUT
    assert np.allclose(made.cl[cut], path.cl[path.kind == Motion.CUT], atol=1e-12)
    assert np.abs(np.diff(free_angles(made.axis, clamp)))[~cut[1:]].max() <= np.radians(1.0) + 1e-9


def test_a_component_that_is_not_there_is_not_to_blame() -> None:
    """Turning by 0.1 deg on the skin is too near to it for a proof: that is said of the cutter, not of a holder."""
    lean = np.radians(0.1)
    axis = np.array([[0.0, 0.0, 1.0], [np.sin(lean), 0.0, np.cos(lean)]])
    path = ToolPath(np.zeros((2, 3)), np.zeros((2, 3)), axis, axis, np.full(2, Motion.LINK, dtype=np.int8),
                    np.array([0, 2]))
    floor = flat([-20, -20, 0], [40, 0, 0], [0, 40, 0])
    group = CheckSurfaces(SKIN, (floor,), np.array([-0.002, 0.5, 1.0]))
    witness = prove_moving(path, Tool.ball(8), (group,)).witness
    assert witness is not None and witness.reason == GOUGE and np.allclose(witness.point, 0, atol=1.0)


def test_a_field_that_does_not_turn_has_the_strips_of_a_fixed_axis() -> None:
    face = seeded(5, 1.2)
    clamp, angle = Clamp(MIKRON, 0, np.radians(30.0)), np.radians(14.0)
    along, step = np.linspace(*face.bounds[:2], 5), np.linspace(*face.bounds[2:], 5)
    axis = clamp.axes(np.array([angle]))[0]
    turning = ClampedAxis(clamp, AngleField(along, step, np.full((5, 5), angle)), "u")
    cut = MovingCut(TOOL, axis, H, 0.0, field=turning)
    places = np.array([(a, s) for a in (0.2, 0.5, 0.8) for s in (0.25, 0.5, 0.75)]).T
    standing, moving = (ClampedChart(face, "u", still).half_widths(cut, *places) for still in (True, False))
    assert (standing > 0).all() and np.allclose(moving, standing, rtol=3e-2)
    guess = ClampedChart(face, "u").screen(cut, *places)
    assert np.allclose(guess, standing.sum(axis=1), rtol=0.2)


def test_a_field_goes_on_ever_slower_beyond_its_nodes() -> None:
    x = np.linspace(0, 1, 6)
    field = AngleField(x, 2 * x, 0.3 * x[:, None] - 0.2 * (2 * x) + 0.1)
    inside, near = (np.array([0.1, 1.0]), np.array([0.4, 0.0])), (np.array([-1e-4, 0.5]), np.array([0.4, 2.0 + 1e-4]))
    for at in (inside, near):
        assert np.allclose(field.at(*at), 0.3 * at[0] - 0.2 * at[1] + 0.1, atol=1e-9)
    far = field.at(np.array([-5.0, 6.0]), np.array([0.4, 0.4])) - field.at(np.array([0.0, 1.0]), np.array([0.4, 0.4]))
    assert np.allclose(far, [-0.3 * 0.2, 0.3 * 0.2], atol=1e-9)


def test_a_wall_is_kept_clear_of() -> None:
    part = floor_and_wall()
    job = task(part.face(1), TOOL, H, Mounting(MIKRON), part=part)
    search = ClampSearch(job, machine_of(job))
    for which in (0, 1):
        one = search.standing(search.clamp(which, np.radians(-20.0)), "u")
        if one is not None:
            nodes = search.nodes["u"]
            axes = one.clamp.axes(one.angles[one.chosen].ravel())
            assert search._free(nodes.uv, axes)[nodes.counts.ravel()].all()


def test_angles_at_which_an_axis_may_be_clamped() -> None:
    turning, tilting = MIKRON.rotary
    whole = np.degrees(clampable_angles(turning, np.radians(30.0)))
    assert np.allclose(whole, np.arange(-180, 180, 30))
    ends = np.degrees(clampable_angles(tilting, np.radians(30.0)))
    assert np.allclose(ends, [-30, 0, 30, 60, 90, 120])


@pytest.mark.parametrize("machine", [None, "three-axes-fixture"])
def test_a_machine_with_two_driven_axes_is_needed(machine: str | None) -> None:
    limits = None if machine is None else Mounting(load_machine(machine))
    with pytest.raises(InvalidInput, match="clamps one of two driven rotary axes"):
        four_plus_one(task(seeded(5, 0.5), TOOL, H, limits))
