"""What is claimed to be out of reach stands up to brute force that shares nothing with the proof."""

from pathlib import Path

import numpy as np
import pytest
from benchmarks._part_samples import PartSamples
from benchmarks._postures import hemisphere, outline_of
from benchmarks.out_of_reach import Attack, Claim, Place, claims_of, draw_places, rack

import toolaxis as ta
from toolaxis.regions.out_of_reach import prove_out_of_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.part import Part

HOLDER = [(12, 0), (16, 40)]
TOOLS = (ta.Tool.ball(4, stickout=20, holder=HOLDER),
         ta.Tool.torus(diameter=8, corner_radius=1.5, stickout=20, holder=HOLDER))
AXES, SEED = 150, 5


@pytest.fixture(scope="module")
def pit() -> Part:
    """A block with a pit, 9 x 24 mm and 26 deep, whose corners have radius 1 mm."""
    cq = pytest.importorskip("cadquery")
    return ta.load(cq.Workplane().box(40, 40, 32).faces(">Z").workplane().rect(9, 24).cutBlind(-26)
                   .edges("|Z").edges(cq.selectors.BoxSelector((-6, -14, -17), (6, 14, 17))).fillet(1.0))


@pytest.fixture(scope="module")
def claims(pit: Part) -> list[Claim]:
    scene, rows = ReachScene.of(pit), []
    side = next(face for face in pit.faces if np.allclose(face.evaluate(face.grid(3, 3)).point[:, 0], -4.5))
    for face in pit.faces:
        found = prove_out_of_reach(face, TOOLS, scene, 250_000 if face is side else 1000)
        rows.append(Claim(face, found.area, found.rectangles))
    return rows


def test_no_tool_reaches_what_is_claimed_of_a_pit(pit: Part, claims: list[Claim]) -> None:
    attack, rng = Attack(pit, TOOLS, axes=AXES), np.random.default_rng(SEED)
    places = [place for claim in claims if claim.area > 0 for place in draw_places(claim, 2, rng)]
    assert sum(claim.area > 0 for claim in claims) == 9, "the pit: its roundings, and what lies beside its sharp edges"
    for place in places:
        assert attack.reach(place).lack > 0, (place.face.label, place.point)


def test_a_claim_that_is_wrong_is_contradicted(pit: Part, claims: list[Claim]) -> None:
    attack, rng = Attack(pit, TOOLS, axes=AXES), np.random.default_rng(SEED)
    top = max(claims, key=lambda one: one.face.evaluate(one.face.grid(3, 3)).point[:, 2].min())
    assert top.area == 0.0
    u0, u1, v0, v1 = top.face.bounds
    wrong = top._replace(area=top.face.area, rectangles=np.array([[u0, u1, v0, v1]]))
    assert all(attack.reach(place).lack <= 0 for place in draw_places(wrong, 2, rng))
    longer = Attack(pit, tuple(ta.Tool.ball(size, stickout=60, holder=HOLDER) for size in (1.8, 4)), axes=AXES)
    lost = [place for claim in claims if claim.area > 0 for place in draw_places(claim, 1, rng)]
    assert any(longer.reach(place).lack <= 0 for place in lost), "with other tools the same places are reached"


@pytest.mark.long
def test_what_is_reached_passes_the_exact_distance(pit: Part, claims: list[Claim]) -> None:
    """The posture that brute force finds is measured with the tool's exact distance, on points of its own."""
    attack, rng = Attack(pit, TOOLS, axes=AXES), np.random.default_rng(SEED)
    samples = PartSamples.of(pit)
    places = [place for claim in claims for place in draw_places(claim, 1, rng, claimed=False)]
    checked = 0
    for place in places:
        found = attack.reach(place)
        if found.lack > 0:
            continue
        tool, axis = TOOLS[found.tool], found.axis
        across = place.normal - place.normal @ axis * axis
        across /= np.linalg.norm(across)
        tip = place.point + tool.corner_radius * (place.normal - axis) + tool.flat_radius * across
        beside = np.cross(axis, across)
        points = samples.around(place.point).point - tip
        local = np.column_stack([points @ across, points @ beside, points @ axis])
        assert tool.distance(local).value.min() > -0.0101
        assert tool.distance(local, "holder").value.min() > 0.999
        checked += 1
    assert checked >= 5


def test_axes_are_spread_over_the_hemisphere() -> None:
    normal = np.array([0.6, -0.48, 0.64])
    axes = hemisphere(normal, 2000)
    assert (axes @ normal > 0).all() and np.allclose(np.linalg.norm(axes, axis=1), 1.0)
    asked = np.random.default_rng(SEED).normal(size=(2000, 3))
    asked /= np.linalg.norm(asked, axis=1)[:, None]
    asked = asked[asked @ normal > 0]
    assert np.degrees(np.arccos((asked @ axes.T).max(axis=1).clip(-1, 1))).max() < 3.5


def test_outlines_are_those_of_the_tool() -> None:
    (tool,) = (one for one in rack() if one.shop_name.startswith("Tapered ball D6"))
    outline = outline_of(tool, 10.0)
    assert outline.cutter[5] == pytest.approx(tool.profile.top_radius)
    assert outline.high[2] == pytest.approx(tool.height) and outline.high[3] == pytest.approx(tool.height + 10)


@pytest.mark.long
@pytest.mark.parametrize("name", ["mousecover.step"])
def test_no_tool_of_the_rack_reaches_what_is_claimed_of_parts_of_others(shared_parts: Path, name: str) -> None:
    part, tools = ta.load(shared_parts / name), rack()
    claims, rng = claims_of(part, tools, 200_000), np.random.default_rng(SEED)
    attack = Attack(part, tools, axes=100)
    places: list[Place] = [place for claim in claims if claim.area > 0 for place in draw_places(claim, 1, rng)][:3]
    assert places, "some of its fillets are too tight"
    for place in places:
        assert attack.reach(place).lack > 0, (place.face.label, place.point)
