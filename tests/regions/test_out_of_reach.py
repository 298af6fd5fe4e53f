"""What is proven to be out of reach stands up to brute force, and what can be reached is not claimed."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.machine.limits import Cone
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.regions import out_of_reach
from toolaxis.regions.axis_cones import first_cones
from toolaxis.regions.out_of_reach import OutOfReach, prove_out_of_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

cq = pytest.importorskip("cadquery")

HOLDER = [(12, 0), (16, 40)]
BALL = ta.Tool.ball(4, stickout=20, holder=HOLDER)
BULL = ta.Tool.torus(diameter=5, corner_radius=0.5, stickout=20, holder=HOLDER)


def contradictions(scene: ReachScene, face: Face, tools: list[ta.Tool], found: OutOfReach) -> int:
    """Postures at random places of what is proven that the exact check passes: 30 places, 200 axes, each tool."""
    rng, limits = np.random.default_rng(11), scene.limits
    rows = found.rectangles[rng.integers(len(found.rectangles), size=60)]
    uv = rows[:, [0, 2]] + rng.random((60, 2)) * (rows[:, [1, 3]] - rows[:, [0, 2]])
    uv = uv[face.contains(uv)][:30]
    assert len(uv) >= 8
    axes = unit(rng.normal(size=(200, 3)))
    axes = axes if limits is None else axes[limits.allowed(axes)]
    groups = group_surroundings(face, scene.tolerance, part=scene.part)
    return sum(int(Feasibility(face, tool, groups, scene.tolerance).reach(uv, axis, itself=True).sum())
               for tool in tools for axis in axes)


def scene_of(solid: object) -> ReachScene:
    """What stands in the way on a part: made once for all tests of it, since what it is made of takes a second."""
    return ReachScene.of(ta.load(solid))


def wall_of(slot: ReachScene) -> Face:
    """One of the two sides of the slot."""
    return next(face for face in slot.part.faces if np.allclose(face.evaluate(face.grid(3, 3)).point[:, 1], -3.0))


@pytest.fixture(scope="module")
def pocket() -> ReachScene:
    """A block with a pocket, 16 x 16 x 20 mm, whose corners have radius 1 mm."""
    return scene_of(cq.Workplane().box(40, 40, 30).faces(">Z").workplane().rect(16, 16).cutBlind(-20)
                   .edges("|Z").edges(cq.selectors.BoxSelector((-10, -10, -15), (10, 10, 16))).fillet(1.0))


@pytest.fixture(scope="module")
def slot() -> ReachScene:
    """A block with a slot, 6 mm wide and 45 deep, from end to end."""
    return scene_of(cq.Workplane().box(60, 40, 50).faces(">Z").workplane().rect(60, 6).cutBlind(-45))


@pytest.fixture(scope="module")
def long_proof(slot: ReachScene) -> OutOfReach:
    """What is proven of a side of the slot in a few seconds."""
    return prove_out_of_reach(wall_of(slot), [BALL], slot, 300_000)


def test_cones_cover_all_axes() -> None:
    axes = unit(np.random.default_rng(2).normal(size=(5000, 3)))
    whole = first_cones()
    for cones in (whole, whole.halve()):
        away = np.asarray(angle_between(axes[:, None], cones.middle[None])) - cones.radius
        assert away.min(axis=1).max() <= 1e-12


def test_corners_are_out_of_reach_of_a_ball_that_is_too_large(pocket: ReachScene) -> None:
    corners = [face for face in pocket.part.faces if face.kind == "cylinder"]
    for face in corners:
        found = prove_out_of_reach(face, [BALL], pocket)
        assert found.area == pytest.approx(face.area) and found.by_corner == found.area
        assert contradictions(pocket, face, [BALL], found) == 0
        small = prove_out_of_reach(face, [BALL, ta.Tool.ball(1.5, stickout=30, holder=HOLDER)], pocket)
        assert small.area < 0.05 * face.area and small.reached > 0.9 * face.area, "all but the end at the floor"


def test_what_lies_open_is_not_claimed(pocket: ReachScene, slot: ReachScene) -> None:
    for scene in (pocket, slot):
        top = max(scene.part.faces, key=lambda face: face.evaluate(face.grid(3, 3)).point[:, 2].min())
        found = prove_out_of_reach(top, [BALL, BULL], scene)
        assert found.area == 0.0 and found.reached == pytest.approx(top.area)


def test_the_middle_of_a_deep_slot_is_out_of_reach_for_the_holder(slot: ReachScene, long_proof: OutOfReach) -> None:
    side, found = wall_of(slot), long_proof
    # 20 mm from both ends and from the top, and a strip along the floor, but for what the holder's clearance takes
    assert 400 < found.area < 22 * 27 + 60 * 2 and found.by_corner < 0.5 * found.area
    assert found.area + found.reached <= side.area * (1 + 1e-9)
    assert contradictions(slot, side, [BALL], found) == 0


def test_what_lies_beside_a_sharp_edge_is_out_of_reach_as_far_as_the_corner_is_round(slot: ReachScene) -> None:
    """A ball of radius 2 on the wall comes nearer to the floor than the 0.1 mm that it keeps up to 2.1 mm above it."""
    side = wall_of(slot)
    long = ta.Tool.ball(4, stickout=60, holder=HOLDER), ta.Tool.torus(6, 2.5, stickout=60, holder=HOLDER)
    found = prove_out_of_reach(side, long, slot, 60_000)  # more pairs decide no more
    assert 0.96 * 2.1 * 60 < found.by_corner <= 2.1 * 60
    assert found.area == found.by_corner and found.area + found.reached <= side.area * (1 + 1e-9)
    flat = ta.Tool.flat(4, stickout=60, holder=HOLDER)
    assert prove_out_of_reach(side, (*long, flat), slot, 60_000).by_corner == 0.0, "its corner is sharp"


def test_of_a_sliver_that_no_cell_has_a_place_of_nothing_is_claimed(pocket: ReachScene) -> None:
    top = max(pocket.part.faces, key=lambda face: face.evaluate(face.grid(3, 3)).point[:, 2].min())
    u0, u1, v0, v1 = top.bounds
    way = np.array([u0, v0]) + np.array([[0.0, 0.0], [0.076, 1.0], [1.0, 0.137]]) * [u1 - u0, v1 - v0]
    thin = np.array([0.0, 0.0028 * (v1 - v0)])
    sliver = top.trimmed((np.concatenate([way, way[::-1] + thin]),))
    found = prove_out_of_reach(sliver, [BALL], pocket)
    assert (found.area, found.reached, len(found.rectangles)) == (0.0, 0.0, 0)


def test_limits_of_the_axes_count(pocket: ReachScene) -> None:
    floor = next(face for face in pocket.part.faces if np.allclose(face.evaluate(face.grid(3, 3)).point[:, 2], -5.0))
    aside = Cone(np.array([1.0, 0.0, 0.0]), np.radians(20))
    limited = replace(pocket, limits=aside)
    found = prove_out_of_reach(floor, [BALL], limited)
    assert found.area == pytest.approx(floor.area), "no such axis sees the floor past the walls"
    assert contradictions(limited, floor, [BALL], found) == 0
    assert prove_out_of_reach(floor, [BALL], pocket).area < 0.5 * floor.area


def test_a_longer_proof_finds_no_less_and_a_short_one_claims_little(slot: ReachScene, long_proof: OutOfReach) -> None:
    side = wall_of(slot)
    areas = [*(prove_out_of_reach(side, [BALL], slot, most).area for most in (1000, 100_000)), long_proof.area]
    assert areas == sorted(areas) and areas[0] < 0.6 * areas[-1]


def test_no_more_pairs_are_looked_at_than_may_be(slot: ReachScene, monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: the tip of a wing took 6 GB, as all pairs that waited were looked at once more when few were left to try.
    """
    seen: list[int] = []
    look = out_of_reach._Proof._may_touch
    monkeypatch.setattr(out_of_reach, "_AT_ONCE", 700)
    monkeypatch.setattr(out_of_reach._Proof, "_may_touch",
                        lambda proof, cells, pairs: (seen.append(len(pairs.cell)), look(proof, cells, pairs))[1])
    tried: list[int] = []
    close = out_of_reach._Proof.close
    monkeypatch.setattr(out_of_reach._Proof, "close", lambda *given: (tried.append(close(*given)), tried[-1])[1])
    found = prove_out_of_reach(wall_of(slot), [BALL], slot, 20_000)
    assert max(seen) <= 700 and 10_000 < sum(tried) <= 20_000 + 700
    assert found.area > 0


def block_with_pits(seed: int) -> Part:
    """A block with a waved top and holes, slots and pockets in it, drawn at random."""
    rng = np.random.default_rng(seed)
    solid = cq.Workplane().box(40, 40, 24)
    for _ in range(3):
        x, y = rng.uniform(-12, 12, 2)
        wide, deep = rng.uniform(2, 12), rng.uniform(3, 20)
        top = solid.faces(">Z").workplane(origin=(x, y, 12))
        shape = rng.integers(3)
        solid = (top.circle(wide / 2) if shape == 0 else top.rect(wide, rng.uniform(wide, 30)) if shape == 1
                 else top.slot2D(wide * 2.2, wide, rng.uniform(0, 180))).cutBlind(-deep)
    return ta.load(solid)


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.long) for k in range(1, 40))])
def test_nothing_fits_where_that_is_proven(seed: int, request: pytest.FixtureRequest) -> None:
    part, tools = block_with_pits(seed), [BALL, BULL, ta.Tool.ball(2, stickout=12, holder=HOLDER)]
    scene, claims, most = ReachScene.of(part), 0, 100_000 if request.config.getoption("--long") else 30_000
    for face in part.faces:
        found = prove_out_of_reach(face, tools, scene, most)
        assert found.area + found.reached <= face.area * (1 + 1e-9)
        if found.area > 0.02 * face.area:
            claims += 1
            assert contradictions(scene, face, tools, found) == 0, face.number
    assert claims, "some of the pits are too narrow"
