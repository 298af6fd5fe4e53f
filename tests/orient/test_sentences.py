"""Sentences of refusals, over seeded ones of every kind: no amount below zero, no -0, no face without a name, no nan.

What stops most axes comes first, and what can be done is said.
"""

import re
from itertools import product
from math import nan

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.clearance.queries import segment_motions
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import OTHER, SKIN, TOUCHING, CheckSurfaces
from toolaxis.feasibility.violations import (
    BACK,
    CUTTER,
    GOUGE,
    HOLDER,
    LIMITS,
    SHANK,
    WANDERS,
    ScreeningResult,
    Violation,
)
from toolaxis.numeric.vectors import unit
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import evaluate_axis
from toolaxis.search.messages import Refusal, format_apart, main_first, sentence, why_none
from toolaxis.search.path_check import worst_motion
from toolaxis.shape.face import Face

HELD = {"stickout": 14, "flute_length": 6, "holder": [(9, 0), (9, 30)]}
TOOLS = (ta.Tool.ball(6, **HELD), ta.Tool.torus(diameter=8, corner_radius=1, **HELD), ta.Tool.flat(diameter=6, **HELD),
         ta.Tool.tapered(4, 1, 20), ta.Tool.ball(20))
#: What no sentence may hold.
ODD = (r"(?<![\w.])-0(?:\.0*)?(?![\d.])", r"\bby -", r"\bwithin -", r"\bonly -", r"-\d[\d.e+-]* mm\b",
       r"face +(?=[,;:. ]|by|at|$)", r"\bnan\b", r"\binf\b", r"\bNone\b", r"\[", r"  ", r"e-\d\d")


def clean(text: str) -> None:
    """That a sentence says nothing odd."""
    without = re.sub(r"\([^()]*\)", "()", text)  # places and directions have signs of their own
    for pattern in ODD:
        assert not re.search(pattern, without), (pattern, text)
    for inside in re.findall(r"\(([^()]*)\)", text):
        assert not re.search(r"(?<![\d.])-0(?![\d.])|nan|inf", inside), text


def wavy(seed: int, height: float) -> Face:
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 16, 6), np.linspace(0, 12, 6), indexing="ij")
    z = height * np.sin(x / rng.uniform(2, 6) + rng.uniform(0, 3)) * np.cos(y / rng.uniform(2, 6))
    return ta.Face.from_bspline(np.stack([x, y, z], axis=-1))


def plate(corner: tuple[float, ...], one: tuple[float, ...], two: tuple[float, ...]) -> Face:
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


@pytest.mark.parametrize("seed", range(8))
def test_of_given_axes(seed: int) -> None:
    """Axes all around at faces of all sorts, with walls and lids, allowances, limits and tools."""
    rng = np.random.default_rng(seed)
    face = wavy(seed, float(rng.choice([0.0, 0.3, 3.0])))
    around = [[], [plate((-1, -5, -5), (0, 30, 0), (0, 0, 20))], [plate((-30, -30, 18), (80, 0, 0), (0, 80, 0))]]
    told = 0
    for k in range(12):
        axis = unit(rng.normal(size=3) * [1, 1, 0.6] + [0, 0, 0.8])
        found = evaluate_axis(face, TOOLS[int(rng.integers(len(TOOLS)))], axis, 0.2, feed="u",
                              obstacles=around[k % 3], allowance=float(rng.choice([0.0, 0.3])),
                              limits=("cone:0,0,1,60" if k % 4 == 0 else None))
        told += found.axis is None
        for why in found.reasons:
            clean(why)
    assert told > 3


@pytest.mark.parametrize("case", range(6))
def test_of_searches_that_find_nothing(case: int) -> None:
    lid = plate((-30, -30, 9), (80, 0, 0), (0, 80, 0))
    held = ta.Tool.ball(6, **HELD)
    face, tool, more = (
        (wavy(1, 0.3), held, {"obstacles": [lid], "limits": "cone:0,0,1,25"}),
        (wavy(2, 4.0), ta.Tool.ball(20), {"limits": "cone:0,0,1,25"}),
        (wavy(3, 0.3), held, {"limits": "cone:0,0,-1,30"}),
        (wavy(4, 0.0), ta.Tool.flat(diameter=6), {"limits": "cone:0,0,1,0.2"}),
        (wavy(5, 6.0), ta.Tool.torus(diameter=12, corner_radius=2), {"limits": "cone:0,0,1,30"}),
        (wavy(6, 9.0), ta.Tool.tapered(8, 1, 30), {}))[case]
    found = ta.best_axis(face, tool, 0.2, **more)
    assert found.axis is None and found.reasons
    for why in found.reasons:
        clean(why)


def feasibility(allowance: float = 0.0) -> Feasibility:
    face, beside = wavy(1, 0.3), plate((16, 0, -9), (0, 12, 0), (0, 0, 9)).trimmed((), "2")
    far = [0.5, 1.0]
    groups = (CheckSurfaces(SKIN, (face,), np.array([allowance - 0.001, *far])),
              CheckSurfaces(TOUCHING, (beside,), np.array([-0.001, *far])),
              CheckSurfaces(OTHER, (plate((-1, -5, -5), (0, 30, 0), (0, 0, 20)).trimmed((), "7"),),
                            np.array([0.1, *far])))
    tool = ta.Tool.torus(diameter=8, corner_radius=1, **HELD)
    return Feasibility(face, tool, groups, ta.Tolerance(gouge=0.002), allowance=allowance)


@pytest.mark.parametrize("allowance", [0.0, 0.3])
def test_of_any_witness(allowance: float) -> None:
    """Whatever a place says of itself, also where it does not know which face, where, or how far."""
    of = feasibility(allowance)
    nowhere, here = np.full(3, nan), np.array([1.0, -2.0, -1e-9])
    for reason, label, point, distance, amount in product(
            (LIMITS, BACK, WANDERS, GOUGE, CUTTER, SHANK, HOLDER), ("", "1", "2", "7"), (nowhere, here),
            (nan, -0.0, 0.0, -1e-9, -4e-3, -2.0, 4e-3, 0.0999999, 0.3, 1.00001, 25.0), (-1e-9, 0.0, 1e-6, 1.3)):
        said = sentence(Violation(reason, amount, label, point, distance=distance), of)
        clean(said)
        assert ("face" in said or "what stands around" in said or "limits" in said) and "(0, 0, 0)" not in said


def test_of_a_search_that_knows_no_place() -> None:
    """Found: "the shank meets face  by -0 mm at (0, 0, 0)", where screening alone had refused the closest axis."""
    job = task(wavy(1, 0.3), TOOLS[0], 0.2)
    for code in (GOUGE, CUTTER, SHANK, HOLDER, BACK, WANDERS, LIMITS):
        ledger = AxisTable(job.feasibility, job.worth)
        axes = unit(np.array([[0.0, 0.05 * k, 1.0] for k in range(4)]))
        ledger._enter(axes, ScreeningResult(np.full(4, code, dtype=np.int8), np.linspace(0.4, 0.1, 4), np.zeros(4)),
                      (np.ones((4, 2)),) * 3)
        said = why_none(ledger)
        clean(said)
        assert said.startswith("all 4 axes") and "(0, 0.1483, 0.9889)" in said, said


def test_what_stops_most_axes_comes_first() -> None:
    """Found: a holder was named where 1,063 of 1,404 axes gouge."""
    job = task(wavy(1, 0.3), TOOLS[0], 0.2)
    ledger = AxisTable(job.feasibility, job.worth)
    reason = np.array([BACK] * 9 + [HOLDER] + [GOUGE] * 3, dtype=np.int8)
    axes = unit(np.array([[0.02 * k, 0.0, 1.0] for k in range(13)]))
    ledger._enter(axes, ScreeningResult(reason, np.array([1e-6] * 9 + [0.001, 0.5, 0.2, 0.3]), np.zeros(13)),
                  (np.ones((13, 2)),) * 3)
    said = why_none(ledger)
    assert said.startswith("3 of the 4 axes that limits and normals allow are refused for a gouge; with the closest")
    assert "(0.2149, 0, 0.9766)" in said and "gouges face 1" in said
    rows = [Refusal(HOLDER, 0.1, "holder"), Refusal(GOUGE, 0.9, "far"), Refusal(GOUGE, 0.2, "near")]
    assert main_first(rows) == ["near", "far", "holder"]


def test_motions_that_were_given_up_name_the_nearest_face_and_no_part_that_the_tool_lacks() -> None:
    bare, wall = ta.Tool.ball(6), plate((10, -9, -9), (0, 18, 0), (0, 0, 18))
    group = CheckSurfaces(OTHER, (wall,), np.array([0.1, 0.5, 1.0]))
    moves = segment_motions(np.array([[0, 0, 0], [1.0, 0, 0]]), [0, 0, 1.0])
    found = worst_motion(bare, group, moves, group.required, group.required)
    assert found.reason == CUTTER and found.label == "1" and found.distance == pytest.approx(6.0, abs=0.01)
    clean(sentence(found, feasibility()))
    far = worst_motion(bare, CheckSurfaces(OTHER, (wall.transformed(np.diag([1.0, 1, 1, 1]) + np.eye(4, k=3) * 900),),
                                           group.required), moves, group.required, group.required)
    assert not far.label and not np.isfinite(far.point).any()
    clean(sentence(far, feasibility()))


def test_a_value_and_the_limit_that_it_misses_differ_in_what_is_read() -> None:
    assert format_apart(0.0123, 0.01, 3) == ("0.012", "0.010")
    assert format_apart(0.01001, 0.01, 3) == ("0.01001", "0.01000")
    assert format_apart(-0.0, 0.5, 2) == ("0.00", "0.50")
    assert format_apart(90.0, 90.0, 1)[0].startswith("90.0")


def test_a_face_of_all_directions_is_told_to_be_divided() -> None:
    x, y = np.meshgrid(np.linspace(-10, 10, 5), np.linspace(-10, 10, 5), indexing="ij")
    dome = ta.Face.from_bspline(np.stack([x, y, -0.5 * (x**2 + y**2)], axis=-1))
    found = ta.best_axis(dome, ta.Tool.tapered(8, 1, 30), 0.2)
    assert found.outcome == "infeasible" and "--regions" in found.reasons[0]
    assert "its normals spread" in found.reasons[0]
    for why in found.reasons:
        clean(why)


def test_the_words_that_this_looks_for_are_found_in_what_was_said_before() -> None:
    for odd in ("the shank meets face  by -0 mm at (0, 0, 0)", "the cutter gouges face 129 by -0.004 mm at (1, 2, 3)",
                "the cutter gouges face 3 by -0.000 mm", "strip width is [0.0, nan] at uv", "comes within inf mm",
                "leaves no strip at (nan, 2, 3)"):
        with pytest.raises(AssertionError):
            clean(odd)
