"""Faces with a pole inside: strips that reach it end there, and passes around it are laid and counted once."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.contact.strip.width import step_widths
from toolaxis.numeric.vectors import unit
from toolaxis.path import pass_count as counting
from toolaxis.path.cl_points import trace
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_layout import Layout, lay_out
from toolaxis.path.rest_material import OVERLOOKED, Excess
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

BALL, H = 40.0, 0.1
TOOL = Tool.torus(12, 2)
AXES = unit(np.array([[0.9, 0.1, 0.6], [0.7, 0.4, 0.55], [-0.2, 0.8, 0.5]]))


@pytest.fixture(scope="module", params=[False, True], ids=["north", "south"])
def cap(request) -> Face:
    """Seen from above its normals point outwards; the other one is the same with its pole at the lower end of v."""
    face = Face(SphericalSurface(BALL, (0.0, 2 * np.pi), (1.12, np.pi / 2)).nurbs())
    if not request.param:
        return face
    s = face.surface
    return Face(replace(s, knots_v=(s.knots_v[0] + s.knots_v[-1] - s.knots_v)[::-1].copy(),
                        control=s.control[:, ::-1].copy()), flip=True)


def covered(axis: np.ndarray, theta: float, phi: float, points: np.ndarray) -> np.ndarray:
    """Whether points are inside the cutter at any of many contacts on the circle of latitude theta from the pole."""
    psi = phi + np.linspace(-np.pi, np.pi, 8001)
    n = np.stack([np.sin(theta) * np.cos(psi), np.sin(theta) * np.sin(psi), np.full(len(psi), np.cos(theta))], 1)
    flat, r = TOOL.flat_radius, TOOL.corner_radius
    tip = (BALL + r) * n + flat * unit(n - (n @ axis)[:, None] * axis) - r * axis
    found = []
    for point in points:
        rel = point - tip
        z = rel @ axis
        rho = np.linalg.norm(rel - z[:, None] * axis, axis=1)
        corner = (rho - flat) ** 2 + (z - r) ** 2 <= r * r
        found.append(((z >= 0) & ((rho <= flat) | corner | ((z >= r) & (rho <= flat + r)))).any())
    return np.array(found)


@pytest.mark.parametrize("off", [0.05, 0.4, 0.9, 1.5, 3.0])
@pytest.mark.parametrize("axis", AXES)
def test_strips_towards_the_pole_against_brute_force(cap: Face, axis: np.ndarray, off: float) -> None:
    u0, u1, v0, v1 = cap.bounds
    v = np.linspace(v0, v1, 20001)
    away = BALL * np.arccos(np.clip(cap.evaluate(np.column_stack([np.full(len(v), 1.0), v])).point[:, 2] / BALL, -1, 1))
    order = np.argsort(away)
    place = float(np.interp(off, away[order], v[order]))
    uv = np.array([[(u0 + u1) / 2, place]])
    contact = cap.evaluate(uv).point[0]
    theta, phi = np.arccos(contact[2] / BALL), np.arctan2(contact[1], contact[0])
    pole = 0 if cap.flip else 1
    half = IsoChart(cap, "u").half_widths(Cut(TOOL, axis, H), uv[:, 0], uv[:, 1])[0, pole]
    end = min(max(place + (half if pole else -half), v0), v1)
    reached = BALL * theta - float(np.interp(end, v, away))
    way = np.linspace(0, 1, 401)[1:-1] * theta
    points = (BALL + H) * np.stack([np.sin(way) * np.cos(phi), np.sin(way) * np.sin(phi), np.cos(way)], 1)
    free = ~covered(axis, theta, phi, points)
    if free.any():
        assert reached == pytest.approx(BALL * (theta - way[free].max()), abs=BALL * theta / 200)
    else:
        assert half == pytest.approx(abs((v1 if pole else v0) - place), rel=1e-12)


def area(face: Face, uv: np.ndarray) -> np.ndarray:
    d = face.evaluate(uv)
    return np.linalg.norm(np.cross(d.su, d.sv), axis=1)


def missed(laid: Layout, count: int = 240) -> float:
    """Share of the face's area that lies in no pass's strip, from places on a fine grid."""
    chart, spacing = laid.chart, laid.spacing
    a0, a1, s0, s1 = chart.bounds
    along = a0 + (a1 - a0) * (np.arange(count) + 0.5) / count
    step = s0 + (s1 - s0) * (np.arange(count) + 0.5) / count
    covered = np.zeros((count, count), dtype=bool)
    for number, (place, halves) in enumerate(zip(spacing.steps, spacing.halves, strict=True)):
        low, high = (np.interp(along, spacing.lines.along, side) for side in spacing.lines.spread_widths(halves).T)
        cut = np.zeros(count, dtype=bool)
        for first, last, _ in laid.pieces[laid.owner == number]:
            cut |= (along >= first) & (along <= last)
        band = (step[None] >= (place - low)[:, None]) & (step[None] <= (place + high)[:, None])
        covered |= cut[:, None] & band
    uv = chart.uv(*(part.ravel() for part in np.meshgrid(along, step, indexing="ij")))
    weight = area(chart.face, uv)
    return float(weight[~covered.ravel()].sum() / weight.sum())


@pytest.mark.parametrize("axis", AXES)
def test_no_pass_is_laid_twice_and_none_is_missed(cap: Face, axis: np.ndarray) -> None:
    chart, cut = IsoChart(cap, "u"), Cut(TOOL, axis, H)
    laid = lay_out(chart, cut)
    assert missed(laid) < 5e-5  # as lines between the measured ones are interpolated
    uv = cap.grid(240, 240)
    higher = Excess(cap, TOOL, trace(laid, H / 10), 1.02 * H)(uv) > 0
    assert area(cap, uv)[higher].sum() < OVERLOOKED * area(cap, uv).sum()
    number = counting.measure(chart, cut).passes
    assert number - 0.02 <= len(laid.steps) <= number + 1.1
    off = BALL * np.arccos(np.clip(cap.evaluate(chart.uv(np.zeros(len(laid.steps)), laid.steps)).point[:, 2] / BALL,
                                   -1, 1))
    assert np.sort(np.diff(np.sort(off)))[0] > 0.3  # narrower than any strip there


def test_a_count_takes_few_widths(cap: Face, monkeypatch: pytest.MonkeyPatch) -> None:
    taken = 0
    plain = IsoChart.half_widths

    def counted(self, cut, along, step):
        nonlocal taken
        taken += len(along)
        return plain(self, cut, along, step)

    monkeypatch.setattr(IsoChart, "half_widths", counted)
    counting.measure(IsoChart(cap, "u"), Cut(TOOL, AXES[0], H))
    assert taken < 3000


def test_passes_that_meet_in_a_pole_cover_the_face_too(cap: Face) -> None:
    laid = lay_out(IsoChart(cap, "v"), Cut(TOOL, AXES[0], H))
    assert missed(laid) < 5e-4
    assert len(laid.steps) == 67  # whichever end of v the pole is at


def test_elsewhere_nothing_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    face = Face(SphericalSurface(BALL, (0.0, 2.0), (0.9, 1.4)).nurbs())
    axis = unit(np.array([0.9, 0.1, 0.9]))
    found = [counting.measure(IsoChart(face, feed), Cut(TOOL, axis, H)) for feed in "uv"]
    monkeypatch.setattr(counting, "_off_poles", lambda chart, cut, place, step: step)
    assert found == [counting.measure(IsoChart(face, feed), Cut(TOOL, axis, H)) for feed in "uv"]
    exact = step_widths(face, TOOL, face.grid(5, 5), axis, H)
    assert (IsoChart(face, "u").half_widths(Cut(TOOL, axis, H), *face.grid(5, 5).T) == exact).all()
