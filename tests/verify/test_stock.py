"""Stock that roughing left: planner and judge against distances that are sampled all over tool and faces."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.search.messages import sentence
from toolaxis.search.path_check import prove
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.strategies.common.path_check import prove_moving
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import AT_RAPID, judge

KEPT = Tolerance(gouge=0.1, cutter_clearance=0.05, shank_clearance=0.05, holder_clearance=0.1)
NEED = {"shank": KEPT.shank_clearance, "holder": KEPT.holder_clearance, AT_RAPID: KEPT.cutter_clearance}
LINK, ENTRY, CUT, EXIT = Motion.LINK, Motion.ENTRY, Motion.CUT, Motion.EXIT


def plate(corner, one, two):
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def plane_and_wall():
    """A floor z = 0 (1) and a wall x = 0 that faces it (2), apart from each other; both are known exactly."""
    return Part.from_faces([plate((2, 0, 0), (10, 0, 0), (0, 12, 0)), plate((0, -20, 8), (0, 60, 0), (0, 0, 40))])


def path_over(tips, kind, axis=(0.0, 0, 1)):
    tips, axis = np.asarray(tips, dtype=float), np.asarray(axis, dtype=float)
    axes = np.tile(axis / np.linalg.norm(axis), (len(tips), 1)) if axis.ndim == 1 else axis
    return ToolPath(tips, tips, axes, axes, np.array(kind, dtype=np.int8), np.array([0, len(tips)]))


def ordinary_path(tips, axis, approach, top=90.0):
    """Down at rapid traverse to so far above the first tip, along the tips, and up again."""
    first, last = tips[0], tips[-1]
    rows = [first + top * axis, first + approach * axis, *tips, last + approach * axis, last + top * axis]
    return path_over(rows, [LINK, LINK, ENTRY, *[CUT] * (len(tips) - 1), EXIT, LINK], axis)


def witness_of(part, path, tool, proof=prove):
    groups = group_surroundings(part.faces[0], KEPT, part=part)
    found = proof(path, tool, groups).witness
    return found, "" if found is None else sentence(found, Feasibility(part.faces[0], tool, groups, KEPT))


def task_of(part, path, tool):
    stock = part.stock
    return VerificationTask("op", path.cl, path.axis, path.kind, tool.profile, part.faces[:1], 0.5,
                            surroundings=part.faces[1:], outlines=tool.outlines, tolerance=KEPT,
                            stock=0.0 if stock is None else stock.height,
                            proud=() if stock is None else tuple(f for f in part.faces if f.number in stock.faces))


def of_stock(verdict):
    return [why for why in verdict.reasons if "mm of stock may stand" in why]


# Closed forms: a shank of radius 4 passes a plane wall at x = 0 with its axis at x = 4.2.

SHANK = Tool.ball(6, flute_length=7, stickout=80, shank=[(4, 7), (4, 80)])


def beside_wall():
    return ordinary_path(np.array([[4.2, y, 0.0] for y in np.linspace(0, 12, 7)]), np.array([0.0, 0, 1]), 3.0)


@pytest.mark.parametrize("proof", [prove, prove_moving])
def test_a_shank_that_clears_the_wall_by_a_fifth_of_a_millimetre(proof):
    part, path = plane_and_wall(), beside_wall()
    assert witness_of(part, path, SHANK, proof)[0] is None
    assert witness_of(part.with_stock(0.1, [1, 2]), path, SHANK, proof)[0] is None
    assert witness_of(part.with_stock(0.149, [2]), path, SHANK, proof)[0] is None
    assert witness_of(part.with_stock(0.3, [1]), path, SHANK, proof)[0] is None  # the wall is finished
    found, said = witness_of(part.with_stock(0.3, [1, 2]), path, SHANK, proof)
    assert found.label == "2" and found.distance == pytest.approx(0.2, abs=2e-3)
    assert found.amount == pytest.approx(0.15, abs=2e-3) and abs(found.point[0]) < 1e-9
    assert said.startswith("the shank comes within 0.2") and "face 2 (finished; 0.3 mm of stock on it)" in said
    assert "0.35 mm is required" in said


def test_the_judge_finds_the_same_without_the_planner():
    part, path = plane_and_wall(), beside_wall()
    for stock, faces, passes in ((0.1, [1, 2], True), (0.149, [2], True), (0.3, [1], True), (0.3, [2], False)):
        found = judge(task_of(part.with_stock(stock, faces), path, SHANK), spacing=2.0)
        assert (not of_stock(found)) == passes
        if 2 in faces:
            assert found.from_stock["shank"].distance == pytest.approx(0.2, abs=1e-3)
    why, = of_stock(found)
    assert why.startswith("shank is 0.2") and "from face 2 at (0.000, " in why
    assert "0.3 mm of stock may stand, needed 0.35 mm, on the" in why
    assert not of_stock(judge(task_of(part, path, SHANK), spacing=2.0))


@pytest.mark.parametrize("over, free", [(0.02, True), (-0.02, False)])
def test_a_holder_above_a_step_with_stock(over, free):
    """The holder's lower face stands 30 mm above the floor, over a step that is as high but for stock and clearance."""
    tool = Tool.ball(6, flute_length=7, stickout=30, holder=[(10, 0), (10, 40)])
    height = 30.0 - 0.8 - KEPT.holder_clearance - over
    step = plate((-12, -20, height), (9, 0, 0), (0, 60, 0))
    part, path = Part.from_faces([plane_and_wall().faces[0], step]), beside_wall()
    assert witness_of(part, path, tool)[0] is None
    part = part.with_stock(0.8, [2])
    found, said = witness_of(part, path, tool)
    assert (found is None) == free and (free or ("the holder" in said and "face 2 (finished; 0.8 mm" in said))
    told = of_stock(judge(task_of(part, path, tool), spacing=2.0))
    assert (not told) == free and (free or told[0].startswith("holder is "))


@pytest.mark.parametrize("stock, free", [(3.0, True), (6.94, True), (6.96, False)])
def test_the_cutting_edge_may_cut_stock_and_what_is_above_it_may_not(stock, free):
    """The flutes end 7 mm above the floor that they machine."""
    part = plane_and_wall().with_stock(stock, [1])
    path = ordinary_path(beside_wall().cl[2:-2], np.array([0, 0, 1.0]), 9.0)
    found, said = witness_of(part, path, SHANK)
    assert (found is None) == free and (free or said.startswith("the shank comes within 7.00 mm of face 1 (finished"))
    assert (not of_stock(judge(task_of(part, path, SHANK), spacing=2.0))) == free


@pytest.mark.parametrize("proof", [prove, prove_moving])
def test_rapid_moves_end_above_stock_and_feed_goes_through_it(proof):
    """A ball over a plane is as far from it as its tip is high."""
    for height, planned, judged in ((2.07, True, True), (2.055, False, True), (2.04, False, False)):
        part = plane_and_wall().with_stock(2.0, [1])
        path = ordinary_path(beside_wall().cl[2:-2], np.array([0, 0, 1.0]), height)
        found, said = witness_of(part, path, SHANK, proof)
        assert (found is None) == planned
        assert planned or "a rapid move is not proven to clear the stock of 2 mm on face 1 at (" in said
        told = of_stock(judge(task_of(part, path, SHANK), spacing=2.0))
        assert (not told) == judged
        assert judged or (told[0].startswith("cutter at rapid traverse is 2.04") and "link motion to point" in told[0])


def test_stock_of_a_task_is_a_number():
    task = task_of(plane_and_wall().with_stock(0.3, [1]), beside_wall(), SHANK)
    for wrong in (np.nan, np.inf, -0.1):
        with pytest.raises(InvalidInput, match="stock of operation op is"):
            replace(task, stock=wrong)


# Seeded scenes against sampled distances.

def from_polygon(rho, z, rows):
    """Signed distances from what lies between the axis and a line (radius, z), turned about the axis."""
    line = np.vstack([[0.0, rows[0][1]], rows, [0.0, rows[-1][1]]])
    least = np.full(rho.shape, np.inf)
    for (r0, z0), (r1, z1) in pairwise(line):
        length = (r1 - r0) ** 2 + (z1 - z0) ** 2
        if length > 0:
            share = np.clip(((rho - r0) * (r1 - r0) + (z - z0) * (z1 - z0)) / length, 0, 1)
            least = np.minimum(least, np.hypot(rho - r0 - share * (r1 - r0), z - z0 - share * (z1 - z0)))
    levels, radii = np.asarray(rows)[:, 1], np.asarray(rows)[:, 0]
    within = (z >= levels[0]) & (z <= levels[-1]) & (rho <= np.interp(z, levels, radii))
    return np.where(within, -least, least)


def from_component(name, tool, rho, z):
    """Signed distances of places from shank, holder or cutter."""
    if name != AT_RAPID:
        return from_polygon(rho, z, tool.outlines[name])
    r = tool.corner_radius
    ring = np.hypot(np.maximum(rho - tool.radius + r, 0.0), z - r) - r
    return np.minimum(ring, from_polygon(rho, z, [(tool.radius, r), (tool.radius, tool.flute_length)]))


def places_on(face, count=31):
    s, t = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count), indexing="ij")
    return face.evaluate(np.column_stack([s.ravel(), t.ravel()])).point


def sampled_distance(name, tool, path, points, step=0.7):
    """The least distance of points from a component at places along the motions that count for it."""
    least = np.inf
    for k in range(1, len(path.cl)):
        if name == AT_RAPID and path.kind[k] != LINK:
            continue
        count = max(int(np.ceil(np.linalg.norm(path.cl[k] - path.cl[k - 1]) / step)), 1)
        for share in np.linspace(0, 1, min(count, 25) + 1):
            tip = path.cl[k - 1] + share * (path.cl[k] - path.cl[k - 1])
            axis = path.axis[k - 1] + share * (path.axis[k] - path.axis[k - 1])
            axis = axis / np.linalg.norm(axis)
            z = (points - tip) @ axis
            rho = np.sqrt(np.maximum(((points - tip) ** 2).sum(axis=1) - z**2, 0.0))
            least = min(least, float(from_component(name, tool, rho, z).min()))
    return least


def scene(seed):
    """A wavy floor, a wall and a step beside it, stock on some of them, a tool, and a path over the floor."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 16, 5), np.linspace(0, 12, 5), indexing="ij")
    floor = Face.from_bspline(np.stack([x, y, rng.uniform(0, 0.1) * rng.normal(size=x.shape)], axis=-1))
    u, lean = rng.uniform(0.05, 0.6), rng.uniform(-0.1, 0.35, 2)
    wall = plate((16 * u - rng.uniform(3.2, 5.5), -20, rng.uniform(2, 9)), (0, 52, 0),
                 40 * np.array([-lean[0], lean[1] / 3, 1]))
    step = plate((4, 15, rng.uniform(6, 22)), (30, 0, 0), (0, 15, rng.uniform(-4, 4)))
    faces = [int(n) for n in np.flatnonzero(rng.random(3) < 0.7) + 1] or [2]
    part = Part.from_faces([floor, wall, step]).with_stock(float(10 ** rng.uniform(-1.3, 0.5)), faces)
    flute = rng.uniform(7, 10)
    body = {"flute_length": flute, "stickout": 26.0, "holder": [(rng.uniform(5, 9), 0), (rng.uniform(9, 14), 25)],
            "shank": [(rng.uniform(2, 3.6), flute), (rng.uniform(3, 4.5), 26)]}
    tool = (Tool.ball(6, **body), Tool.torus(6, 1, **body), Tool.torus(7, 2.5, **body))[seed % 3]
    axis = np.array([0.08, 0.0, 1.0])
    axis[:2] += rng.uniform(-0.22, 0.22, 2)
    axis /= np.linalg.norm(axis)
    uv = np.column_stack([np.full(5, u), np.linspace(0.1, 0.8, 5)])
    path = ordinary_path(place(floor, tool, uv, axis), axis, rng.uniform(0.3, 6.0))
    return part, tool, path


def check_scene(seed):
    """Whether planner and judge let a scene pass, and whether the planner does without stock."""
    part, tool, path = scene(seed)
    proud = np.concatenate([places_on(face) for face in part.faces if face.number in part.stock.faces])
    spare = {name: sampled_distance(name, tool, path, proud) - need - part.stock.height for name, need in NEED.items()}
    planned = [witness_of(part, path, tool, proof)[0] is None for proof in (prove, prove_moving)]
    verdict = judge(task_of(part, path, tool), spacing=8.0)
    judged = not of_stock(verdict)
    if any(planned):
        assert min(spare.values()) >= -1e-9, (seed, spare)
        assert judged, (seed, verdict.reasons)
    if judged:  # it measures to a thousandth of the distance
        assert min(spare.values()) >= -1e-3 - 2e-3 * part.stock.height, (seed, spare)
    for name, room in verdict.from_stock.items():
        needed = NEED[name] + part.stock.height
        if room.distance < 4 * needed:  # farther away it is known roughly
            sampled = spare[name] + needed
            assert room.distance <= sampled + 0.002 * abs(sampled) + 1e-3, (seed, name)
    bare = witness_of(replace(part, stock=None), path, tool)[0] is None
    return planned[0], judged, bare


def check_many(seeds):
    found = np.array([check_scene(seed) for seed in seeds])
    planned, judged, bare = found.T
    assert planned.sum() > len(found) / 20 and (bare & ~planned).sum() > len(found) / 20
    assert not (planned & ~judged).any() and not (planned & ~bare).any()
    # What the judge lets pass and the planner does not comes too near without stock, or in the margin of links.
    assert (judged & bare & ~planned).sum() <= len(found) / 20


@pytest.mark.parametrize("first", [0, *(pytest.param(k, marks=pytest.mark.long) for k in (24, 48, 72))])
def test_no_scene_is_safe_that_is_not(first):
    check_many(range(first, first + 24))


@pytest.mark.long
def test_no_scene_of_many_is_safe_that_is_not():
    check_many(range(96, 4000))
