"""Passes over a skin whose curvature jumps: strips are told from a smooth spline, and laid closer where it misleads."""

from collections.abc import Sequence

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.path.mending import FurtherPasses
from toolaxis.path.rest_material import FACTOR, OVERLOOKED
from toolaxis.plan.zone import Zone
from toolaxis.search import candidate_check
from toolaxis.search.face_problem import FaceProblem
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.skin.join import with_skins
from toolaxis.skin.unite import unite

cq = pytest.importorskip("cadquery")

RADIUS, SCALLOP = 3.0, 0.1
#: The profile: flats, and between them a rounding and a hollow, mm, that turn by as much, rad.
FLAT, ROUNDED, HOLLOW, TURN, WIDE = 6.0, 5.0, 8.0, np.radians(35.0), 10.0


def step() -> Part:
    """A block with a smooth step across its top, the four faces of which are one skin."""
    sin, cos = np.sin(TURN), np.cos(TURN)
    half_sin, half_cos = np.sin(TURN / 2), np.cos(TURN / 2)
    edge = np.array([FLAT + ROUNDED * sin, -ROUNDED * (1 - cos)])
    above = edge + HOLLOW * np.array([sin, cos])
    end = above - [0.0, HOLLOW]
    sketch = cq.Workplane("XZ").moveTo(0, -15).lineTo(0, 0).lineTo(FLAT, 0)
    sketch = sketch.threePointArc((FLAT + ROUNDED * half_sin, -ROUNDED * (1 - half_cos)), tuple(edge))
    sketch = sketch.threePointArc(tuple(above - HOLLOW * np.array([half_sin, half_cos])), tuple(end))
    part = ta.load(sketch.lineTo(end[0] + FLAT, end[1]).lineTo(end[0] + FLAT, -15).close().extrude(WIDE))
    top = [face for face in part.faces if face.normal(face.grid(5, 5))[:, 2].min() > 0.3]
    assert len(top) == 4
    return with_skins(part, [unite(top)])


def share_high(face: Face, path: ToolPath) -> float:
    """Share of a face over which a ball leaves more than may count, from its distance to random places."""
    u0, u1, v0, v1 = face.bounds
    uv = np.array([u0, v0]) + np.random.default_rng(5).random((60_000, 2)) * np.array([u1 - u0, v1 - v0])
    d = face.evaluate(uv)
    raised = d.point + FACTOR * SCALLOP * face.normal(uv)
    at = np.flatnonzero(path.kind[1:] == Motion.CUT)
    centre = path.cl + RADIUS * path.axis[0]
    least = np.full(len(uv), np.inf)
    for first, last in zip(centre[at], centre[at + 1], strict=True):
        way = last - first
        share = np.clip((raised - first) @ way / max(float(way @ way), 1e-30), 0.0, 1.0)
        np.minimum(least, np.linalg.norm(raised - first - share[:, None] * way, axis=1), out=least)
    area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    return float(area[least > RADIUS].sum() / area.sum())


def test_passes_lie_closer_where_a_skin_would_stay_high(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: samples on a grid lay between the ridges of straight passes, and twice too much stayed."""
    tried: list[float] = []
    whole = candidate_check._find_closer_share

    def _watched(job: FaceProblem, made: FurtherPasses, left: Sequence[Zone]) -> float | None:
        tried.append(job.laid_for)
        return whole(job, made, left)

    monkeypatch.setattr(candidate_check, "_find_closer_share", _watched)
    part = step()
    skin = next(face for face in part.faces if face.members)
    made = ta.plan(part, ta.Tool.ball(2 * RADIUS), SCALLOP, faces=[skin.number], passes="planes", method="normal",
                   workers=1)
    (op,) = made.operations
    assert op.path is not None and not op.zones and op.orientation.pattern == "planes"
    assert share_high(op.face, op.path) <= OVERLOOKED
    assert tried[0] == 1.0 and len(tried) == 2, "as laid at first more would stay than may; the next are close enough"
    assert ta.verify(made).passed


def test_places_on_two_crumbs_far_apart_take_little_memory() -> None:
    """Found: what was left at two ends of a skin was looked at with so many places that memory ran out."""
    skin = next(face for face in step().faces if face.members)
    u0, u1, v0, v1 = skin.bounds
    corner = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 0.01 * (u1 - u0)
    low, high = np.array([u0 + 0.1, v0 + 0.1]), np.array([u1 - 0.5, v1 - 0.5])
    crumbs = skin.trimmed((corner + low, corner + high))
    found = candidate_check._scatter_places(crumbs, 40_000)
    assert 0 < len(found) < 2000 and crumbs.contains(found).all()
    many = candidate_check._scatter_places(skin, 40_000)
    assert len(many) == 40_000 and len(np.unique(many, axis=0)) == 40_000
