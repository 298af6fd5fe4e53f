"""What is claimed to be out of reach of a whole rack, attacked by brute force.

``python -m benchmarks out_of_reach [FOLDER|PART ...] [--points N] [--axes N] [--seed S]`` takes the faces and skins
that `toolaxis plan` would plan with the general rack, and asks for the proof of what no tool of it reaches.  Then
random places of what is claimed, half of them on the borders of its cells, are touched with every tool under
thousands of axes and with a search around the best of them, and the tool is held against points of the whole part
(`benchmarks._part_samples`, `benchmarks._postures`): nothing of that is shared with the proof.

A claim is contradicted where a tool keeps all that a plan asks for: 0.01 mm deep at most in the face and those that go
on from it, 0.1, 0.5 and 1 mm of cutter, shank and holder from others.  It is asked once more with denser points before
that counts.  ``closer`` counts places that a tool reaches that nowhere enters the part deeper than 0.01 mm, nearer than
the clearances: no contradiction, but what clearances cost.  ``miss`` is the least of what any posture lacked.  Of
random places that are not claimed ``reached`` says how many a tool reaches: the rest could be claimed, and is not.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks._part_samples import DENSE, DENSER, Density, PartSamples, numbers_around
from benchmarks._postures import OTHER, OWN, TOUCHING, Points, Rule, hemisphere, outline_of, try_axes
from benchmarks.real_parts import ENDINGS, FOLDER
from numpy.typing import NDArray

from toolaxis.cad.load import load
from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.spec import choose_faces, with_joined
from toolaxis.job.inputs.tool_library import load_library
from toolaxis.job.planning.pipeline import WIDE
from toolaxis.job.planning.sub_surfaces import smooth_pieces
from toolaxis.plan.choices import SCALLOP
from toolaxis.regions.out_of_reach import prove_out_of_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

ROOT = Path(__file__).resolve().parent.parent
POINTS, AXES = 60, 2000
#: Postures that lack more than this, mm, and more than another tool's best, are not followed up.
_WORTH = 1.0
#: Pairs of a cell and a cone for a part and for a face at least, as plans spend them.
_PAIRS, _FEWEST = 3_000_000, 30_000
_COLUMNS = (f"{'part':24} {'mm2':>9} {'claimed':>9} {'%':>5} {'places':>6} {'postures':>10} {'against':>7} "
            f"{'closer':>6} {'miss mm':>8} {'open':>5} {'reached':>7} {'proof s':>7} {'force s':>7}")


class Claim(NamedTuple):
    """What of a face is claimed: face, area in mm^2 and (m, 4) rectangles of the parameters."""

    face: Face
    area: float
    rectangles: Array


class Place(NamedTuple):
    """A place of a face: its face, point (3,) in mm and normal (3,)."""

    face: Face
    point: Array
    normal: Array


class Reach(NamedTuple):
    """What brute force found of a place.

    lack : float, mm, what the best posture lacks, 0 or less where nothing;  tool : int, its number;  axis : (3,) array;
    tried : int, postures.
    """

    lack: float
    tool: int
    axis: Array
    tried: int


@dataclass(eq=False)
class Attack:
    """A part with the tools that are held against it.

    Attributes
    ----------
    part : Part
        As it was read.
    tools : tuple of Tool
    tolerance : Tolerance
    axes : int
        How many are tried of each tool at a place.
    """

    part: Part
    tools: tuple[Tool, ...]
    tolerance: Tolerance = field(default_factory=Tolerance)
    axes: int = AXES

    def __post_init__(self) -> None:
        self._samples = PartSamples.of(self.part)
        # Slim tools first: where anything fits they do.
        order = sorted(range(len(self.tools)), key=lambda k: (self.tools[k].radius, self.tools[k].corner_radius))
        self._outlines = [(k, outline_of(self.tools[k], 2 * self.part.diagonal)) for k in order]
        self._roles: dict[tuple[int, ...], NDArray[np.int64]] = {}

    def rule(self, clear: bool, tool: Tool) -> Rule:
        """What a tool has to keep: all clearances, or only that nothing is entered."""
        t = self.tolerance.for_cutter(tool.radius)
        least = np.full((3, 4), -t.gouge)
        least[:, 3] = -np.inf
        if clear:
            least[:, 1:3] = t.shank_clearance, t.holder_clearance
            least[OTHER, 0] = t.cutter_clearance
        least[OTHER, 3] = t.holder_clearance if clear else -t.gouge
        return Rule(np.vstack([least, least.max(axis=0)]), t.min_lead)

    def reach(self, place: Place, clear: bool = True) -> Reach:
        """The best posture at a place; one that lacks nothing stands up to denser points.

        Parameters
        ----------
        place : Place
        clear : bool
            Whether clearances are kept.
        """
        found = self._touch(place, clear, DENSE, hemisphere(place.normal, self.axes))
        if found.lack > 0:
            return found
        # From the axis that seemed to fit on, among axes all around it.
        near = hemisphere(found.axis, 20 * self.axes)[:200]
        again = self._touch(place, clear, DENSER, np.vstack([found.axis, near]))
        return again._replace(tried=found.tried + again.tried)

    def _touch(self, place: Place, clear: bool, density: Density, axes: Array) -> Reach:
        samples = self._samples.around(place.point, density)
        points = Points.of(samples.point, self._role(place.face)[samples.face], samples.step, place.point)
        contact = np.ascontiguousarray(place.point), np.ascontiguousarray(place.normal)
        least, tool, axis, tried = np.inf, -1, place.normal, 0
        for k, outline in self._outlines:
            best = np.array([max(least, _WORTH), *place.normal])
            tried += try_axes(outline, self.rule(clear, self.tools[k]), points, contact, axes, best)
            if best[0] < least:
                least, tool, axis = best[0], k, best[1:].copy()
            if least <= 0:
                break
        return Reach(float(least), tool, axis, tried)

    def _role(self, face: Face) -> NDArray[np.int64]:
        """Roles of the part's faces beside one, or a skin of several."""
        if face.numbers not in self._roles:
            own, touching = numbers_around(self.part, face.numbers)
            self._roles[face.numbers] = np.array([OWN if one.number in own else TOUCHING if one.number in touching
                                                  else OTHER for one in self.part.faces])
        return self._roles[face.numbers]


def rack() -> tuple[Tool, ...]:
    """The general rack, the large tools first, without those that are too small for the scallop height."""
    tools = [tool for tool in load_library(None).tools if tool.radius > SCALLOP]
    return tuple(sorted(tools, key=lambda tool: (-tool.radius, tool.corner_radius, tool.half_angle, tool.number)))


def claims_of(part: Part, tools: Sequence[Tool], most: int = _PAIRS) -> list[Claim]:
    """What the proof says of the faces and skins that a plan of the part begins with.

    Parameters
    ----------
    part : Part
    tools : sequence of Tool
        The large ones first.
    most : int
        Pairs of a cell and a cone that are tried for the whole part, about.
    """
    joined, numbers = with_joined(part, "skins", width=WIDE * tools[len(tools) // 2].radius, asked=False)
    try:
        faces = choose_faces(joined, numbers)
    except InvalidInput:  # nothing is sculptured
        faces = joined.faces
    whole, scene = sum(face.area for face in faces), ReachScene.of(joined)
    pieces = [target.face for target in smooth_pieces(faces, tools[-1]) if target.ended is None]
    rows = []
    for face in pieces:
        found = prove_out_of_reach(face, tools, scene, max(_FEWEST, int(face.area / whole * most)))
        rows.append(Claim(face, found.area, found.rectangles))
    return rows


def draw_places(claim: Claim, count: int, rng: np.random.Generator, claimed: bool = True) -> list[Place]:
    """Places of what is claimed of a face, every second one on the border of a cell, or of what is not.

    Parameters
    ----------
    claim : Claim
    count : int
    rng : numpy.random.Generator
    claimed : bool
        Else places that are not claimed are drawn, evenly by area.
    """
    return _draw_claimed(claim, count, rng) if claimed else _draw_unclaimed(claim, count, rng)


def _draw_claimed(claim: Claim, count: int, rng: np.random.Generator) -> list[Place]:
    face, rows = claim.face, claim.rectangles
    middle, half = (rows[:, [0, 2]] + rows[:, [1, 3]]) / 2, (rows[:, [1, 3]] - rows[:, [0, 2]]) / 2
    d = face.evaluate(middle)
    weight = np.linalg.norm(np.cross(d.su, d.sv), axis=1) * half.prod(axis=1) + 1e-300
    found: list[Place] = []
    for _ in range(20):
        pick = rng.choice(len(rows), 4 * count, p=weight / weight.sum())
        way = rng.uniform(-1, 1, (4 * count, 2))
        side = rng.integers(2)
        way[::2, side] = np.where(way[::2, side] < 0, -1.0, 1.0)
        uv = middle[pick] + way * half[pick]
        found += _places(face, uv[face.contains(uv)])
        if len(found) >= count:
            break
    return found[:count]


def _draw_unclaimed(claim: Claim, count: int, rng: np.random.Generator) -> list[Place]:
    face, rows = claim.face, claim.rectangles
    u0, u1, v0, v1 = face.bounds
    uv = np.array([u0, v0]) + rng.random((40 * count + 200, 2)) * [u1 - u0, v1 - v0]
    uv = uv[face.contains(uv)]
    d = face.evaluate(uv)
    size = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    uv = uv[rng.random(len(uv)) * size.max(initial=0.0) < size]
    for u_low, u_high, v_low, v_high in rows:
        uv = uv[~((uv[:, 0] >= u_low) & (uv[:, 0] <= u_high) & (uv[:, 1] >= v_low) & (uv[:, 1] <= v_high))]
    return _places(face, uv)[:count]


def _places(face: Face, uv: Array) -> list[Place]:
    normal = face.normal(uv)
    return [Place(face, *one) for one in zip(face.evaluate(uv).point, normal, strict=True)
            if np.linalg.norm(one[1]) > 0.5]


def draw_from_part(claims: Sequence[Claim], count: int, rng: np.random.Generator, claimed: bool) -> list[Place]:
    """Places of all faces of a part, shared out by area, one at least of each that has any; so many in any order.

    Parameters
    ----------
    claims : sequence of Claim
    count : int
    rng : numpy.random.Generator
    claimed : bool
        Whether of what is claimed, or of the rest.
    """
    areas = [one.area if claimed else max(one.face.area - one.area, 0.0) for one in claims]
    whole = sum(areas)
    places: list[Place] = []
    for claim, area in zip(claims, areas, strict=True):
        if area > 0 and (len(claim.rectangles) or not claimed):
            places += draw_places(claim, int(np.ceil(count * area / whole)), rng, claimed)
    return [places[k] for k in rng.permutation(len(places))[:count]]


def measure(path: Path, asked: argparse.Namespace) -> int:
    """Print the line of a part and its contradictions; how many there are."""
    part, tools, rng = load(path), rack(), np.random.default_rng(asked.seed)
    begun = time.process_time()
    claims = claims_of(part, tools, asked.pairs)
    proven = time.process_time()
    attack = Attack(part, tools, axes=asked.axes)
    against: list[tuple[Place, Reach]] = []
    places = draw_from_part(claims, asked.points, rng, claimed=True)
    closer, tried, miss = 0, 0, np.inf
    for place in places:
        found = attack.reach(place)
        tried += found.tried
        miss = min(miss, found.lack)
        if found.lack <= 0:
            against.append((place, found))
        else:
            entered = attack.reach(place, clear=False)
            tried += entered.tried
            closer += entered.lack <= 0
    others = draw_from_part(claims, asked.points, rng, claimed=False)
    reached = sum(attack.reach(place).lack <= 0 for place in others)
    area, claimed = sum(one.face.area for one in claims), sum(one.area for one in claims)
    print(f"{path.name[:24]:24} {area:9.1f} {claimed:9.2f} {100 * claimed / area:5.1f} {len(places):6} {tried:10} "
          f"{len(against):7} {closer:6} {miss:8.4f} {len(others):5} {reached:7} {proven - begun:7.1f} "
          f"{time.process_time() - proven:7.1f}", flush=True)
    for place, found in against:
        where, axis = (" ".join(f"{x:.3f}" for x in row) for row in (place.point, found.axis))
        print(f"  CONTRADICTED: face {place.face.label} at ({where}) is reached by {tools[found.tool].shop_name} with "
              f"the axis ({axis}), lack {found.lack:.4f}", flush=True)
    return len(against)


def _parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(prog="python -m benchmarks out_of_reach",
                                   description=(__doc__ or "").split("\n\n")[0])
    made.add_argument("sources", nargs="*", type=Path, metavar="FOLDER|PART",
                      help=f"default: the examples, and {FOLDER} (TOOLAXIS_SHARED names another place)")
    made.add_argument("--points", type=int, default=POINTS, metavar="N", help=f"places of a part (default: {POINTS})")
    made.add_argument("--axes", type=int, default=AXES, metavar="N", help=f"of each tool (default: {AXES})")
    made.add_argument("--pairs", type=int, default=_PAIRS, metavar="N",
                      help="of a cell and a cone that the proof of a part may try (default: as a plan)")
    made.add_argument("--seed", type=int, default=1, metavar="S")
    return made


def run_with(words: Sequence[str]) -> int:
    """Measure as words of the command line say: 1 where a claim is contradicted, 2 where there is no part."""
    asked = _parser().parse_args(words)
    sources = asked.sources or [ROOT / "examples", *([FOLDER] if FOLDER.is_dir() else [])]
    files = [path for source in sources for path in ([source] if source.is_file() else sorted(
        path for path in source.glob("*") if path.suffix.lower() in ENDINGS))]
    if not files:
        print(f"no STEP file in {sources[0]}: name a folder that has some, or a STEP file", file=sys.stderr)
        return 2
    print(_COLUMNS, flush=True)
    return int(sum(measure(path, asked) for path in files) > 0)


def main() -> None:
    """The examples, and parts made by others where they are."""
    run_with([])
    if not FOLDER.is_dir():
        print(f"not measured: no parts in {FOLDER}; TOOLAXIS_SHARED names the folder that has parts/")


def short() -> None:
    """One example, fewer places and axes."""
    run_with([str(ROOT / "examples" / "bosses.step"), "--points", "10", "--axes", "500"])
