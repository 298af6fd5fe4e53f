"""Nothing of a face is forgotten: sub-surfaces of every example are the face, zones and the rest the sub-surface."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import Polygon
from shapely.ops import unary_union

import toolaxis as ta
from toolaxis.partition.bosses import bosses_of, distances
from toolaxis.partition.ring_division import divide_in_rings
from toolaxis.partition.uv_grid import Lattice
from toolaxis.path.rest_material import RestFinder, machined_regions
from toolaxis.plan.plan import Plan
from toolaxis.search.face_problem import task

pytest.importorskip("OCP")
EXAMPLES = Path(__file__).parents[2] / "examples"
ONE_FACE = ("freeform", "saddle", "trimmed", "hyperbolic_paraboloid", "hyperbolic_paraboloid_rules", "manta",
            "biquintic", "waves", "outline", "boss", "bosses")
TOOL = ta.Tool.torus(10, 1, stickout=70, holder=[(16, 0), (16, 40), (25, 40), (25, 80)])


def read(name: str) -> tuple[ta.Part, ta.Face]:
    from toolaxis.cad import load
    from toolaxis.cad.step.worker import read_shape

    part = load(read_shape(str(EXAMPLES / f"{name}.step"))[0])
    return part, max(part.sculptured, key=lambda face: face.area)


def polygon(loops: tuple[np.ndarray, ...]) -> Polygon:
    return Polygon(loops[0], loops[1:])


def is_made_of(face: ta.Face, pieces: list[ta.Face]) -> None:
    """Areas on the surface add up to 1e-6 of the face; in the parameter plane there is neither gap nor overlap."""
    assert sum(piece.area for piece in pieces) == pytest.approx(face.area, rel=1e-6)
    whole, parts = polygon(face.outline), [polygon(piece.outline) for piece in pieces]
    assert whole.is_valid and all(part.is_valid and part.area > 0 for part in parts)
    twice = sum(one.intersection(other).area for one, other in combinations(parts, 2))
    assert twice <= 1e-9 * whole.area
    assert unary_union(parts).symmetric_difference(whole).area <= 1e-9 * whole.area


def cut(seed: int, boxes: int = 15) -> list[tuple[int, int, int, int]]:
    """Rectangles of a 16 x 16 lattice by random cuts from side to side."""
    rng, found = np.random.default_rng(seed), [(0, 16, 0, 16)]
    while len(found) < boxes:
        u0, u1, v0, v1 = found.pop(int(rng.integers(len(found))))
        if rng.random() < 0.5 and u1 - u0 > 1:
            c = int(rng.integers(u0 + 1, u1))
            found += [(u0, c, v0, v1), (c, u1, v0, v1)]
        elif v1 - v0 > 1:
            c = int(rng.integers(v0 + 1, v1))
            found += [(u0, u1, v0, c), (u0, u1, c, v1)]
        else:
            found.append((u0, u1, v0, v1))
    return found


@pytest.mark.parametrize("name", ONE_FACE)
def test_sub_surfaces_of_every_example_are_the_face(name: str) -> None:
    part, face = read(name)
    bosses = distances(face, TOOL, part)
    assert len(bosses) == len(bosses_of(part, face.number)) == {"boss": 1, "bosses": 3}.get(name, 0)
    divisions = [divide_in_rings(face, bosses, radius) for radius in (10.0, 17.5, np.inf)] if len(bosses) > 1 else (
        [divide_in_rings(face, bosses, 10.0)] if bosses else [(face,)])
    for seed, parts in enumerate(divisions):
        assert len(parts) > 1 or not bosses
        lattice = Lattice(face)
        pieces = []
        for one in parts:
            own = Lattice(one)
            own.__dict__["lines"] = lattice.lines
            pieces += [face.trimmed(loops) for box in cut(seed + 3) for loops in own.rectangle(box)]
        is_made_of(face, list(parts))
        is_made_of(face, pieces)


@pytest.mark.parametrize("name", ["trimmed", "outline", "boss", pytest.param("bosses", marks=pytest.mark.long)])
def test_zones_and_machined_area_are_the_sub_surface(name: str) -> None:
    part, face = read(name)
    box = {"trimmed": (3, 11, 2, 12), "outline": (5, 16, 0, 9), "boss": (4, 10, 3, 12), "bosses": (9, 16, 2, 9)}[name]
    (loops, *_) = Lattice(face).rectangle(box)
    piece = face.trimmed(loops)
    job = task(piece, TOOL, 0.2, part=part)
    axis = piece.normal(piece.grid(9, 9)).mean(axis=0) + np.array([0.15, 0.1, 0.0])
    path = job.made(axis / np.linalg.norm(axis), "u")
    zones = RestFinder(piece, TOOL, 0.2).find(path)
    assert zones or name not in ("boss", "bosses")
    rest = machined_regions(piece, zones)
    is_made_of(piece, [*rest, *(piece.trimmed(zone.loops) for zone in zones)])
    assert sum(zone.area for zone in zones) + sum(one.area for one in rest) == pytest.approx(piece.area, rel=1e-6)


def is_whole(part: ta.Part, plan: Plan, numbers: set[int]) -> None:
    """The sub-surfaces of a plan are the faces with these numbers, and zones and the rest each sub-surface."""
    assert numbers == {op.face.number for op in plan.operations}
    for number in numbers:
        is_made_of(part.faces[number - 1], [op.face for op in plan.operations if op.face.number == number])
    for op in plan.operations:
        is_made_of(op.face, [*machined_regions(op.face, op.zones), *(op.face.trimmed(zone.loops) for zone in op.zones)])


@pytest.mark.long
def test_a_plan_of_a_whole_blisk_leaves_nothing_out() -> None:
    tool = ta.Tool.torus(10, 1, stickout=70, holder=[(10, 0), (10, 40), (25, 40), (25, 80)])
    plan = ta.plan(EXAMPLES / "blisk.step", tool, 0.02, workers=2)
    part, _ = read("blisk")
    assert sum(not op.done for op in plan.operations) == 4 * 16, "fillets"
    is_whole(part, plan, {face.number for face in part.sculptured})


@pytest.mark.long
def test_a_plan_of_a_skin_and_of_a_blade_of_the_impeller_leaves_nothing_out() -> None:
    skin = ta.plan(EXAMPLES / "skin.step", TOOL, 0.2, faces="skins", regions=3)
    assert len(skin.operations) > 1
    numbers = skin.operations[0].face.numbers
    joined = ta.join(ta.load(EXAMPLES / "skin.step"), numbers)
    is_made_of(joined.faces[numbers[0] - 1], [op.face for op in skin.operations])
    part, _ = read("impeller")
    side = max(part.sculptured, key=lambda face: face.area)
    tool = ta.Tool.torus(6, 1, stickout=50, holder=[(10, 0), (10, 40), (25, 40), (25, 80)])
    is_whole(part, ta.plan(part, tool, 0.1, faces=[side.number], regions=3), {side.number})


@pytest.mark.long
@pytest.mark.parametrize(("name", "regions"), [("waves", 6), ("boss", 4), ("bosses", 6), ("outline", 3)])
def test_a_plan_leaves_nothing_out(name: str, regions: int) -> None:
    part, face = read(name)
    plan = ta.plan(part, TOOL, 0.1, faces=[face.number], regions=regions)
    assert plan.outcome == "complete"
    is_made_of(face, [op.face for op in plan.operations])
    for op in plan.operations:
        is_made_of(op.face, [*machined_regions(op.face, op.zones), *(op.face.trimmed(zone.loops) for zone in op.zones)])
        left = sum(zone.area for zone in op.zones if zone.at_wall)
        assert op.orientation.unreached == pytest.approx(left / op.face.area, abs=1e-9)
