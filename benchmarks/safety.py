"""Whole plans of parts drawn by seeds, judged twice: by `verify`, and by points of its faces and nothing of ours.

``python -m benchmarks safety [--cases N] [--seed S] [--draws D]``.  A draw is a part (`benchmarks._random_parts`), a
rack of three tools out of a shop's sizes, a scallop height, stock or none, and limits of the axis or none.  A case is
one motion of a path, a cut, an entry, an exit or a link: the tool is put at places along it, and all points of the
part's faces near it are held against the cutter in closed form and against shank and holder.  As points lie on the
exact part and only some places are looked at, what they find is a wrong "safe", and they find no false alarms.

A draw fails where a point lies deeper in the cutter than the machining tolerance, nearer to shank or holder than asked,
with the stock that stands on it, or nearer to a cutter at rapid traverse than the stock; where the axis is outside its
limits; and where the plan says of an operation that it is done and `verify` does not pass it.
"""

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely
from benchmarks._random_parts import RandomPart, draw_part
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Chord tolerance of the mesh, mm; points on an mm^2 of it; how far those are from borders, mm, where a face ends.
_CHORD, _DENSITY, _BORDER = 0.001, 6.0, 0.1
#: Places of the tool along a motion: how far apart, mm, and how many at most.
_STEP, _PLACES = 0.4, 6
#: What points may lie off the exact part and figures may be rounded, mm.
_SLACK = 0.0005
#: Motions of an operation that are looked at, at most.
_MOTIONS = 250
_BULLS, _LARGE, _SMALL = ((8, 1), (10, 1), (12, 2), (16, 3)), (6, 8, 10), (2, 3, 4)


class Draw(NamedTuple):
    """What a seed stands for.

    seed : int
    part : RandomPart
    tools : three of them, the largest first
    scallop, stock : mm
    limits : short form of the axis's limits, or ""
    """

    seed: int
    part: RandomPart
    tools: tuple[Tool, ...]
    scallop: float
    stock: float
    limits: str


class PartPoints(NamedTuple):
    """Points on the faces of a part.

    point : (n, 3) array, mm
    stock : (n,) array, what stands on each of them throughout the plan, mm
    tree : of the points
    """

    point: Array
    stock: Array
    tree: Any


class Finding(NamedTuple):
    """A wrong "safe": what : component or rule;  by : mm;  motion : its number in the path, of which kind."""

    what: str
    by: float
    motion: int
    kind: str


def draw_case(seed: int) -> Draw:
    """The draw of a seed.

    Parameters
    ----------
    seed : int
    """
    rng = np.random.default_rng([seed, 1])
    diameter, corner = _BULLS[int(rng.integers(len(_BULLS)))]
    large, small = int(rng.choice(_LARGE)), int(rng.choice(_SMALL))
    tools = (Tool.torus(diameter, corner, **_held(rng, diameter)), Tool.ball(large, **_held(rng, large)),
             Tool.ball(small, **_held(rng, small)))
    stock = float(rng.choice([0.0, 0.0, 0.3, 1.0]))
    limits = str(rng.choice(["", "", "cone:0,0,1,60", "cone:0,0,1,35"]))
    return Draw(seed, draw_part(seed), tools, float(rng.choice([0.03, 0.06, 0.12])), stock, limits)


def _held(rng: np.random.Generator, diameter: float) -> dict[str, Any]:
    """Flutes, shank, holder and stick-out of a cutter of a diameter, mm."""
    flute = float(np.round(rng.uniform(1.2, 3.0) * diameter + 3, 1))
    stickout = flute + float(np.round(rng.uniform(4, 40), 1))
    neck = float(np.round(diameter / 2 * rng.uniform(0.9, 1.3), 2))
    nose = float(np.round(neck + rng.uniform(2, 9), 1))
    return {"flute_length": flute, "stickout": stickout, "shank": [(neck, 0), (neck, stickout - flute)],
            "holder": [(nose, 0), (nose + 3, 12), (nose + 8, 40)]}


def points_of(draw: Draw, plan: Plan) -> PartPoints:
    """Points all over the part of a draw, by OpenCASCADE.

    Parameters
    ----------
    draw : Draw
    plan : Plan
        Of whose faces stock stands.
    """
    rng = np.random.default_rng([draw.seed, 2])
    carrying = {number for op in plan.operations for number in op.face.numbers} if draw.stock > 0 else set[int]()
    edges = cKDTree(np.concatenate([_points_on_edge(edge) for edge in draw.part.solid.val().Edges()]))
    found: list[Array] = []
    stock: list[Array] = []
    for number, face in enumerate(draw.part.solid.val().Faces(), 1):
        inner = _points_on_face(face, rng)
        far = edges.query(inner)[0] > _BORDER
        some = np.concatenate([[corner.toTuple() for corner in face.tessellate(_CHORD, 0.2)[0]], inner[far]])
        found.append(some)
        stock.append(np.full(len(some), draw.stock if number in carrying else 0.0))
    points = np.concatenate(found)
    return PartPoints(points, np.concatenate(stock), cKDTree(points))


def _points_on_face(face: Any, rng: np.random.Generator) -> Array:
    """Points of the exact surface, drawn evenly in triangles of its parameters; beyond borders by a chord's sag."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopLoc import TopLoc_Location

    BRepMesh_IncrementalMesh(face.wrapped, _CHORD, False, 0.2, False)
    mesh = BRep_Tool.Triangulation_s(face.wrapped, TopLoc_Location())
    uv = np.array([mesh.UVNode(k).Coord() for k in range(1, mesh.NbNodes() + 1)])
    triangles = np.array([mesh.Triangle(k).Get() for k in range(1, mesh.NbTriangles() + 1)]) - 1
    surface = BRepAdaptor_Surface(face.wrapped)
    point = np.array([surface.Value(*map(float, place)).Coord() for place in uv])
    corner = point[triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
    picked = rng.choice(len(triangles), size=int(_DENSITY * area.sum()) + 1, p=area / area.sum())
    places = np.einsum("ni,nix->nx", rng.dirichlet((1, 1, 1), size=len(picked)), uv[triangles[picked]])
    return np.array([surface.Value(*map(float, place)).Coord() for place in places])


def _points_on_edge(edge: Any) -> Array:
    count = 2 + int(edge.Length() / _BORDER)
    return np.array([place.toTuple() for place in edge.positions(np.linspace(0, 1, count))])


class Judge:
    """Points against the tool of an operation.

    Parameters
    ----------
    plan : Plan
    tool : Tool
    points : PartPoints
    """

    def __init__(self, plan: Plan, tool: Tool, points: PartPoints) -> None:
        self._points, self._tool = points, tool
        self._asked = plan.inputs.tolerance.for_cutter(tool.radius)
        self._least = {"shank": self._asked.shank_clearance, "holder": self._asked.holder_clearance}
        #: Cross-sections through the axis, both sides of it.
        self._sections = {name: shapely.Polygon(np.concatenate([line, line[::-1] * [-1, 1]]))
                          for name, line in tool.outlines.items()}
        self._high = max(line[:, 1].max() for line in tool.outlines.values())
        self._wide = max(line[:, 0].max() for line in tool.outlines.values()) + 3.0 + float(points.stock.max())
        shapely.prepare(list(self._sections.values()))

    def look(self, path: ToolPath, motion: int) -> list[Finding]:
        """What is wrong on the motion that arrives at a point of a path.

        Parameters
        ----------
        path : ToolPath
        motion : int
        """
        ends, axes = path.cl[motion - 1:motion + 1], path.axis[motion - 1:motion + 1]
        count = min(1 + int(np.ceil(np.linalg.norm(ends[1] - ends[0]) / _STEP)), _PLACES)
        share = np.linspace(0, 1, count)[:, None]
        kind = Motion(int(path.kind[motion]))
        worst: dict[str, float] = {}
        for tip, axis in zip(ends[0] + share * (ends[1] - ends[0]), axes[0] + share * (axes[1] - axes[0]), strict=True):
            for what, by in self._at(tip, axis / np.linalg.norm(axis), kind):
                worst[what] = max(by, worst.get(what, 0.0))
        return [Finding(what, by, motion, kind.name.lower()) for what, by in worst.items()]

    def _at(self, tip: Array, axis: Array, kind: Motion) -> Iterator[tuple[str, float]]:
        """By how much what is exceeded with the tip at a place, mm."""
        middle = tip + 0.5 * self._high * axis
        near = self._points.tree.query_ball_point(middle, float(np.hypot(0.5 * self._high, self._wide)))
        rows = self._points.point[near] - tip
        stock = self._points.stock[near]
        height = rows @ axis
        aside = np.linalg.norm(rows - height[:, None] * axis, axis=1)
        tool = self._tool
        inside = _depth(tool, aside, height)
        # At rapid traverse the cutter keeps off what roughing left; finished faces it may touch.
        rapid = (stock > 0) & (kind == Motion.LINK)
        yield from self._exceeded("cutter", inside + np.where(rapid, stock, -self._asked.gouge))
        for name, section in self._sections.items():
            asked = self._least[name] + stock
            low, high = tool.outlines[name][:, 1].min(), tool.outlines[name][:, 1].max()
            some = (height > low - asked) & (height < high + asked) & (aside < tool.outlines[name][:, 0].max() + asked)
            if some.any():
                away = shapely.distance(section, shapely.points(aside[some], height[some]))
                yield from self._exceeded(name, asked[some] - away)

    @staticmethod
    def _exceeded(what: str, by: Array) -> Iterator[tuple[str, float]]:
        most = float(by.max(initial=-np.inf))
        if most > _SLACK:
            yield what, most


def _depth(tool: Tool, aside: Array, height: Array) -> Array:
    """How deep places lie in a cutter with a round corner, mm, negative outside; above the flutes nothing does."""
    corner = tool.corner_radius
    low = corner - np.hypot(np.maximum(aside - (tool.radius - corner), 0.0), corner - height)
    deep = np.where(height < corner, low, tool.radius - aside)
    return np.where(height <= tool.flute_length, deep, -np.inf)


class Planned(NamedTuple):
    """plan : of a draw;  operation : one of it that is done."""

    plan: Plan
    operation: Operation

    @staticmethod
    def of(draw: Draw, folder: Path) -> "Planned":
        """The first operation of the plan of a draw.

        Parameters
        ----------
        draw : Draw
        folder : Path
            For the part's file.
        """
        plan = plan_draw(draw, folder)
        return Planned(plan, next(op for op in plan.operations if op.done))

    @property
    def path(self) -> ToolPath:
        """The operation's."""
        assert self.operation.path is not None
        return self.operation.path

    def with_path(self, path: ToolPath) -> "Planned":
        """The same with another path.

        Parameters
        ----------
        path : ToolPath
        """
        return self._replace(operation=replace(self.operation, path=path))

    def with_tool(self, tool: Tool) -> "Planned":
        """The same with another tool.

        Parameters
        ----------
        tool : Tool
        """
        return self._replace(operation=replace(self.operation, tool=tool))


def wrong_of(planned: Planned, points: PartPoints, limits: str, most: int = _MOTIONS) -> tuple[int, list[Finding]]:
    """How many motions of an operation were looked at, and what is wrong on them.

    Parameters
    ----------
    planned : Planned
    points : PartPoints
    limits : str
    most : int
        Motions that are looked at.
    """
    path = planned.path
    motions = np.unique(np.linspace(1, len(path.cl) - 1, most).round().astype(int))
    judge, found = Judge(planned.plan, planned.operation.tool, points), list[Finding]()
    for motion in motions:
        found += judge.look(path, int(motion))
    if limits:
        angle = float(limits.rpartition(",")[2])
        over = float(np.degrees(np.arccos(np.clip(path.axis[:, 2], -1, 1))).max()) - angle
        if over > 1e-6:
            found.append(Finding("limits of the axis, deg", over, 0, "axis"))
    return len(motions), found


def plan_draw(draw: Draw, folder: Path) -> Plan:
    """The plan of a draw.

    Parameters
    ----------
    draw : Draw
    folder : Path
        For the part's file.
    """
    import cadquery

    file = str(folder / "part.step")
    cadquery.exporters.export(draw.part.solid, file)
    return ta.plan(file, draw.tools, draw.scallop, stock=draw.stock, limits=draw.limits or None, workers=1)


def judge_draw(draw: Draw) -> tuple[int, int, str]:
    """Plan a draw and judge it: cases, wrong ones, and a line for the table.

    Parameters
    ----------
    draw : Draw
    """
    with tempfile.TemporaryDirectory() as folder:
        began = time.process_time()
        plan = plan_draw(draw, Path(folder))
        spent = time.process_time() - began
        verdict = ta.verify(plan)
    done = [op for op in plan.operations if op.done]
    refused = [op.name for op in verdict.operations if not op.passed]
    points, cases, found = points_of(draw, plan), 0, list[Finding]()
    for op in done:
        count, wrong = wrong_of(Planned(plan, op), points, draw.limits)
        cases, found = cases + count, found + wrong
    account = plan.account
    told = (f"{draw.seed:6} {draw.part.kind:9} {', '.join(tool.name for tool in draw.tools):34} {draw.scallop:5.2f} "
            f"{draw.stock:4.1f} {draw.limits:14} {len(done):3}/{len(plan.operations):<3} "
            f"{100 * account.machined / account.area:5.1f} {100 * account.unreachable / account.area:5.1f} "
            f"{len(plan.used_tools):2} {spent:6.1f} {cases:6} {len(found):5}")
    for one in sorted(found, key=lambda one: -one.by)[:3]:
        told += f"\n       WRONG: {one.what} by {one.by:.4f} at motion {one.motion}, {one.kind}"
    if refused:
        told += f"\n       REFUSED by verify: {', '.join(refused)}"
    return cases, len(found) + len(refused), told


def run_with(words: Sequence[str]) -> int:
    """Draws until there are enough cases; 1 where one is wrong.

    Parameters
    ----------
    words : sequence of str
        Of the command line.
    """
    parser = argparse.ArgumentParser(prog="python -m benchmarks safety", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--cases", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=0, help="of the first draw")
    parser.add_argument("--draws", type=int, default=10**6, help="at most")
    asked = parser.parse_args(words)
    print(f"{'seed':>6} {'part':9} {'tools':34} {'h':>5} {'st.':>4} {'limits':14} {'done':>7} {'% ok':>5} {'% out':>5} "
          f"{'T':>2} {'plan s':>6} {'cases':>6} {'wrong':>5}")
    cases, wrong, kinds = 0, 0, Counter[str]()
    for seed in range(asked.seed, asked.seed + asked.draws):
        draw = draw_case(seed)
        some, bad, told = judge_draw(draw)
        cases, wrong = cases + some, wrong + bad
        kinds[draw.part.kind] += 1
        print(told, flush=True)
        if cases >= asked.cases:
            break
    print(f"{cases} cases on {sum(kinds.values())} parts ({', '.join(f'{n} {kind}' for kind, n in kinds.items())}): "
          f"{wrong} wrong")
    return 1 if wrong else 0


def main() -> None:
    """10,000 cases."""
    run_with([])


def short() -> None:
    """Two draws."""
    run_with(["--draws", "2"])
