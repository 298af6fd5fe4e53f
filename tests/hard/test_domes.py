"""A face with a pole inside: the cap of a sphere, where passes shrink to a point and the normal has no bound."""

from math import pi

import pytest

import toolaxis as ta
from toolaxis.contact.strip.scallop import step_from_scallop
from toolaxis.path.parametrization import IsoChart
from toolaxis.shape.analytic import SphericalSurface


def cap(low: float = 0.9) -> ta.Face:
    return ta.Face(SphericalSurface(7.0, v_range=(low, pi / 2)).nurbs())


def test_a_dome_is_planned_and_passes() -> None:
    made = ta.plan(cap(1.1), "ball:6", 0.3, machine="cone:0,0,1,5")
    assert made.outcome == "complete", made.operations[0].orientation.reasons
    assert made.operations[0].orientation.unreached == 0
    assert ta.verify(made).passed


def test_only_passes_around_a_pole_keep_away_from_it() -> None:
    face = cap()
    u0, u1, v0, v1 = face.bounds
    around, through = IsoChart(face, "u").bounds, IsoChart(face, "v").bounds
    assert around[:3] == (u0, u1, v0) and v1 - 0.01 < around[3] < v1
    assert through == (v0, v1, u0, u1)
    strip = float(step_from_scallop(0.05, 3.0, -1 / 7.0)) / 7.0
    assert ta.count(face, ta.Tool.ball(6), [0, 0, 1.0], 0.05, "u") == pytest.approx((v1 - v0) / strip, rel=0.1)
