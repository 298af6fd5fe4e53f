"""Zones that passes leave: against dense points and the cutter's plain formula, and against what the judge finds."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.strip.swept_volume import distance_to_removed, distance_to_removed_numpy
from toolaxis.numeric.polygons import inside, polygon_area, slabs
from toolaxis.path import rest_material
from toolaxis.path.rest_grid import sample_grid
from toolaxis.path.rest_material import (
    FACTOR,
    Excess,
    RestFinder,
    machined_regions,
    may_stay,
    split,
    undercut,
)
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.tolerances import Tolerance
from toolaxis.verify.task import VerificationTask as Judged
from toolaxis.verify.verdict import SHARE, judge

TOOL = ta.Tool.torus(diameter=6, corner_radius=1, stickout=30)
SCALLOP = 0.05
SPECK, DEEP_ONE = 0.9, 1.2


def waved(trims: tuple = ()) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 30, 5), np.linspace(0, 24, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0.8 * np.sin(x / 7) * np.cos(y / 9)], axis=-1), trims=trims)


def post(x: float, y: float, radius: float, height: float = 9.0) -> ta.Face:
    t = np.linspace(0, 2 * np.pi, 41)
    ring = np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])
    return ta.Face.from_bspline([[[*p, z] for z in (height, -3.0)] for p in ring], degree=(1, 1))


def test_zones_are_cut_out_of_an_outline_whose_loops_touch() -> None:
    """What several operations leave side by side: a border across the line between them crosses both in one place."""
    below, above = (np.array([[0, y], [1, y], [1, y + 0.5], [0, y + 0.5]]) for y in (0.0, 0.5))
    rng = np.random.default_rng(0)
    for _ in range(40):
        angle = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(5, 40))))
        zone = 0.5 + rng.uniform(0.1, 0.4, len(angle))[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        inner, rest = split((below, above), (zone,))
        area = polygon_area((zone,))
        assert polygon_area(inner) == pytest.approx(area, abs=1e-5)
        assert polygon_area(rest) == pytest.approx(1 - area, abs=1e-5)


@pytest.fixture(scope="module")
def made() -> tuple[FaceProblem, ToolPath]:
    job = task(waved(), TOOL, SCALLOP, surroundings=(post(16, 11, 3.0),))
    return job, job.made(np.array([0.0, np.sin(0.12), np.cos(0.12)]), "v")


def dense_distance(path: ToolPath, points: np.ndarray) -> np.ndarray:
    """Least distance to a torus cutter at places 0.02 mm apart, from the torus' plain formula."""
    at = np.flatnonzero(path.kind[1:] == Motion.CUT)
    ways = [path.cl[i + 1] - path.cl[i] for i in at]
    tips = np.concatenate([path.cl[i] + np.linspace(0, 1, max(2, int(np.linalg.norm(way) / 0.02)))[:, None] * way
                           for i, way in zip(at, ways, strict=True)])
    axis, best = path.axis[0], np.full(len(points), np.inf)
    for k, p in enumerate(points):
        gap = p - tips
        z = gap @ axis
        rho = np.linalg.norm(gap - z[:, None] * axis, axis=1)
        tube = np.hypot(np.maximum(rho - 2, 0), z - 1) - 1
        body = np.maximum(rho - 3, 1 - z)
        best[k] = np.where(z > 1, body, np.where(rho > 2, tube, -z)).min()
    return best


def test_zones_hold_what_dense_points_find(made: tuple[FaceProblem, ToolPath]) -> None:
    job, path = made
    face = job.worth.face
    zones = RestFinder(face, TOOL, SCALLOP).find(path)
    assert len(zones) == 1 and 30 < zones[0].area < 200
    uv = np.random.default_rng(2).uniform(0, 1, (700, 2))
    raised = face.evaluate(uv).point + FACTOR * SCALLOP * face.normal(uv)
    distance = dense_distance(path, raised)
    within = np.any([inside(slabs(zone.loops), uv) for zone in zones], axis=0)
    clear = np.abs(distance) > 2e-3
    assert (within == (distance > 0))[clear].all()
    assert within.sum() > 50 and clear.sum() > 350


def test_a_look_at_further_passes_finds_what_a_first_look_finds(made: tuple[FaceProblem, ToolPath],
                                                                monkeypatch: pytest.MonkeyPatch) -> None:
    """It goes on where the last one found something, and asks for fewer points."""
    job, path = made
    some = path.kind.copy()
    some[np.flatnonzero(path.kind == Motion.CUT)[::40]] = Motion.LINK
    fewer = ToolPath(path.cc, path.cl, path.axis, path.normal, some, path.breaks)
    asked: list[int] = []
    ask = Excess.__call__
    monkeypatch.setattr(Excess, "__call__", lambda self, uv: asked.append(len(uv)) or ask(self, uv))

    def looked(finder: RestFinder, at: ToolPath) -> tuple[list[float], int]:
        asked.clear()
        return [zone.area for zone in finder.find(at)], sum(asked)

    def finder() -> RestFinder:
        return RestFinder(job.worth.face, TOOL, SCALLOP)

    (first, _), (whole, all_asked) = looked(finder(), fewer), looked(finder(), path)
    assert len(first) > len(whole) and sum(first) > sum(whole) + 4
    one = finder()
    assert looked(one, fewer)[0] == first
    again, few_asked = looked(one, path)
    assert sum(again) == pytest.approx(sum(whole), rel=1e-3) and len(again) == len(whole)
    back, _ = looked(one, fewer)
    assert back == first
    assert few_asked < all_asked


def test_zones_and_machined_area_are_the_face(made: tuple[FaceProblem, ToolPath]) -> None:
    job, path = made
    half = np.array([[0.0, 0.0], [0.55, 0.0], [0.5, 1.0], [0.0, 1.0]])
    for face in (job.worth.face, job.worth.face.trimmed((half,))):
        zones = RestFinder(face, TOOL, SCALLOP).find(path)
        rest = machined_regions(face, zones)
        areas = sum(zone.area for zone in zones), sum(piece.area for piece in rest)
        assert sum(areas) == pytest.approx(face.area, rel=1e-9) and min(areas) > 0
        uv = np.random.default_rng(3).random((3000, 2))
        hits = sum(inside(slabs(zone.loops), uv).astype(int) for zone in zones)
        hits = hits + sum(piece.contains(uv).astype(int) for piece in rest)
        assert (hits == face.contains(uv)).all()


def test_the_judge_finds_the_same_area_left(made: tuple[FaceProblem, ToolPath]) -> None:
    job, path = made
    face = job.worth.face
    given = Judged("op", path.cl, path.axis, path.kind, TOOL.profile, (face,), SCALLOP)
    seen = judge(given, spacing=0.12)
    share = sum(zone.area for zone in RestFinder(face, TOOL, SCALLOP).find(path)) / face.area
    assert 1 - seen.share_within == pytest.approx(share, abs=1.5e-3)
    assert sum(zone.area for zone in seen.zones if zone.area > 0.5) / face.area == pytest.approx(share, abs=1.5e-3)


def test_a_face_without_walls_has_no_zones() -> None:
    job = task(waved(), TOOL, SCALLOP)
    assert RestFinder(waved(), TOOL, SCALLOP).find(job.made(np.array([0.0, 0.2, 0.98]), "u")) == ()


def test_a_missing_pass_end_is_an_undercut_at_the_border_and_no_wall() -> None:
    job = task(waved(), TOOL, SCALLOP)
    path = job.made(np.array([0.0, 0.2, 0.98]), "v")
    short = path.cl[:, 1] < 21
    kind = np.where(short, path.kind, Motion.LINK).astype(np.int8)
    cut = ToolPath(path.cc, path.cl, path.axis, path.normal, kind, path.breaks)
    zones = RestFinder(waved(), TOOL, SCALLOP, walls=lambda uv: np.zeros(len(uv), dtype=bool)).find(cut)
    assert zones and not any(zone.at_wall for zone in zones)


def test_compiled_and_plain_distances_agree() -> None:
    rng = np.random.default_rng(4)
    starts, ends = rng.uniform(-8, 8, (2, 30, 3))
    points = rng.uniform(-9, 9, (60, 3))
    axis = np.array([0.2, -0.3, 0.9]) / np.linalg.norm([0.2, -0.3, 0.9])
    one = distance_to_removed(TOOL, axis, starts, ends, points, 4.0)
    other = distance_to_removed_numpy(TOOL, axis, starts, ends, points, 4.0)
    assert one == pytest.approx(other, abs=3e-6)
    assert (distance_to_removed(TOOL, axis, starts, ends, points, 4.0)
            <= distance_to_removed(TOOL, axis, starts[:9], ends[:9], points, 4.0)).all()
    assert (distance_to_removed(TOOL, axis, starts[:0], ends[:0], points) == np.inf).all()


def test_allowance_raises_what_is_asked_for() -> None:
    face = waved()
    job = task(face, TOOL, SCALLOP, allowance=0.3, tolerance=Tolerance())
    path = job.made(np.array([0.0, 0.2, 0.98]), "u")
    assert RestFinder(face, TOOL, SCALLOP, 0.3).find(path) == ()
    (zone, *_) = RestFinder(face, TOOL, SCALLOP).find(path)
    assert zone.area > 0.9 * face.area



def shortened(*starts: float) -> ToolPath:
    """Passes of a ball along y over the half x < 20 of a plane of 40 by 40, every third one begun late."""
    x = np.arange(0.4, 19.6, 1.3)
    tips = np.repeat(np.stack([x, np.full_like(x, -8.0), np.zeros_like(x)], axis=1), 2, axis=0)
    tips[1::2, 1] = 48.0
    tips[:6 * len(starts):6, 1] = starts
    up, kind = np.tile([0.0, 0.0, 1.0], (len(tips), 1)), np.tile([Motion.LINK, Motion.CUT], len(x)).astype(np.int8)
    return ToolPath(tips, tips, up, up, kind, np.arange(0, len(tips) + 1, 2))


@pytest.mark.parametrize(("starts", "good"), [
    ((SPECK,), True), ((SPECK, SPECK), False), ((DEEP_ONE,), False), ((SPECK, SPECK, DEEP_ONE), False)])
def test_what_may_stay_is_little_enough_for_the_judge(starts: tuple[float, ...], good: bool) -> None:
    """Specks, which no zone tells of, beside undercut ones and half of a face declared: the rest alone is asked for."""
    plane = ta.Face.from_bspline([[[0, 0, 0], [0, 40, 0]], [[40, 0, 0], [40, 40, 0]]], degree=(1, 1))
    ball, path = ta.Tool.ball(diameter=10, stickout=40), shortened(*starts)
    zones = RestFinder(plane, ball, SCALLOP, walls=lambda uv: uv[:, 0] > 0.5).find(path)
    declared = tuple(plane.trimmed(zone.loops) for zone in zones if zone.at_wall)
    seen = judge(Judged("op", path.cl, path.axis, path.kind, ball.profile, (plane,), SCALLOP, left=declared))
    assert (undercut(zones) <= may_stay(zones, plane.area)) == good
    assert seen.share_within >= SHARE or not good, seen.zones


def test_what_ends_of_passes_leave_along_a_narrow_band_is_told_to_the_judge() -> None:
    """A band across a large plane of which passes cut one side: its ends are a good part of what they machine."""
    size, wide, step = 120.0, 1.6, 0.4
    band = np.array([[0, 0], [wide, 0], [size, size - wide], [size, size], [size - wide, size], [0, wide]]) / size
    plane = ta.Face.from_bspline([[[0, 0, 0], [0, size, 0]], [[size, 0, 0], [size, size, 0]]], degree=(1, 1))
    face, ball = plane.trimmed((band,)), ta.Tool.ball(diameter=2, stickout=40)
    y = np.arange(-step, size + step, step)
    tips = np.repeat(np.stack([y - 2 * wide, y, np.zeros_like(y)], axis=1), 2, axis=0)
    tips[1::2, 0] = y
    up, kind = np.tile([0.0, 0.0, 1.0], (len(tips), 1)), np.tile([Motion.LINK, Motion.CUT], len(y)).astype(np.int8)
    path = ToolPath(tips, tips, up, up, kind, np.arange(0, len(tips) + 1, 2))
    zones = RestFinder(face, ball, 0.02).find(path)
    declared = tuple(plane.trimmed(zone.loops) for zone in zones)
    seen = judge(Judged("op", path.cl, path.axis, path.kind, ball.profile, (face,), 0.02, left=declared))
    assert 0.3 * face.area < sum(zone.area for zone in zones) < 0.6 * face.area
    assert seen.share_within >= SHARE, seen.zones


def test_what_is_known_of_whole_cells_is_what_their_nodes_say(made: tuple[FaceProblem, ToolPath]) -> None:
    job, path = made
    high = Excess(job.worth.face, TOOL, path, FACTOR * SCALLOP)
    grid = sample_grid(job.worth.face, high, 0.06, high.whole)
    plain = sample_grid(job.worth.face, high, 0.06, lambda middle, around: np.zeros(len(middle), dtype=bool))
    assert grid.above.tolist() == plain.above.tolist()
    assert (grid.values == 1).sum() > 0.5 * len(plain.above) > 5000


def test_distances_from_a_path_of_many_groups_of_motions_are_those_of_the_plain_twin():
    rng = np.random.default_rng(5)
    t = np.linspace(0, 1, 4001)
    line = np.column_stack([100 * t, 12 * np.sin(40 * t), 3 * np.cos(25 * t)])
    points = rng.uniform([-5, -16, -5], [105, 16, 9], (72, 3))
    axis = np.array([0.1, 0.2, 1.0]) / np.linalg.norm([0.1, 0.2, 1.0])
    found = distance_to_removed(TOOL, axis, line[:-1], line[1:], points, 4.0)
    plain = distance_to_removed_numpy(TOOL, axis, line[:-1], line[1:], points, 4.0)
    assert np.abs(found - plain).max() < 1e-5 and (plain < 4.0).any() and (plain == 4.0).any()


def test_motions_are_made_ready_once_however_often_it_is_asked(made, monkeypatch):
    job, path = made
    calls, sweep = [], rest_material.sweep_motions
    monkeypatch.setattr(rest_material, "sweep_motions", lambda *args: calls.append(1) or sweep(*args))
    high = Excess(job.worth.face, TOOL, path, SCALLOP)
    for _ in range(3):
        high(job.worth.face.grid(4, 4))
    assert len(calls) == 1


def test_a_cell_is_left_all_over_where_its_middle_is_farther_from_the_cut_than_it_reaches(made):
    job, path = made
    face = job.worth.face
    high = Excess(face, TOOL, path, FACTOR * SCALLOP)
    middle = face.grid(25, 25)
    size = np.array([face.bounds[1] - face.bounds[0], face.bounds[3] - face.bounds[2]]) / 50
    corners = np.array([[-1, -1], [0, -1], [1, -1], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0]])
    around = middle[:, None] + corners * size
    whole = high.whole(middle, around)
    assert whole.any() and not whole.all()
    for k in np.flatnonzero(whole):
        assert (high(around[k]) > 0).all() and high(middle[k][None])[0] > 0
    raised = high._raise_points(middle)
    reach = 1.2 * np.linalg.norm(high._raise_points(around.reshape(-1, 2)).reshape(-1, 8, 3) - raised[:, None],
                                 axis=2).max(axis=1)
    cutting = path.kind[1:] == Motion.CUT
    away = distance_to_removed(TOOL, path.axis[0], path.cl[:-1][cutting], path.cl[1:][cutting], raised)
    assert (whole == (away >= reach)).all()
