"""Passes of a flat end: strips on a trough against the formula, no gouge between points, and the judge's word."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.search.face_problem import task
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.strategies.two_point.contact import BRIDGE, circle_strip_width, match_lead, two_point_lead
from toolaxis.strategies.two_point.inputs import TwoPointInputs
from toolaxis.strategies.two_point.lean_field import field_of
from toolaxis.strategies.two_point.path import strokes
from toolaxis.strategies.two_point.postures import BEHIND, CONVEX, REASONS, TWO, postures
from toolaxis.strategies.two_point.search import describe_contacts, gouging, two_point
from toolaxis.strategies.two_point.strips import lane, lay_strips, next_strip, places, strip
from toolaxis.tools.tool import Tool
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge

TOOL, H, RHO = Tool.flat(20), 0.03, 40.0


def trough(hollow=True, half=0.45, trims=()):
    """Part of a cylinder along v, 36 mm wide, seen from inside or from outside."""
    return Face(CylindricalSurface(RHO, (-half, half), (0.0, 30.0)).nurbs(), trims, flip=hollow)


def basin():
    """A bent sheet, 40 mm by 36 mm, hollow across u and more and more so along it."""
    x, y = np.meshgrid(np.linspace(-20.0, 20.0, 4), np.linspace(-18.0, 18.0, 4), indexing="ij")
    height = np.array([0.0, 0.0, 2.0, 12.0])[:, None] + np.array([4.0, -1.0, -1.0, 4.0])
    return Face.from_bspline(np.stack([x, y, height], axis=-1), (3, 3))


@pytest.mark.parametrize("posture, lean, lift", [("two-point", two_point_lead, H), ("one-point", match_lead, 0.0)])
def test_strips_on_a_trough_are_the_formulas(posture, lean, lift):
    work = TwoPointInputs(trough(), TOOL, H, "v", posture)
    found = strip(work, 0.0)
    lead = lean(10.0, RHO, H) if posture == "two-point" else lean(10.0, RHO)
    chord = float(circle_strip_width(10.0, RHO, H, lead, lift))
    # Heights are counted along the normal here and along x in the formula, and widths along the arc.
    arc = 2 * RHO * np.arcsin(chord / (2 * RHO))
    point = work.face.evaluate(work.uv(np.full(2, 15.0), 0.0)).point[0]
    ends = [work.face.evaluate(work.uv(np.array([15.0]), float(found.step + s * h))).point[0]
            for s, h in zip((-1, 1), found.halves[36], strict=True)]
    angles = [2 * np.arcsin(np.linalg.norm(end - point) / (2 * RHO)) for end in ends]
    assert RHO * sum(angles) == pytest.approx(arc, rel=0.03)
    np.testing.assert_allclose(found.halves[:, 0], found.halves[:, 1], rtol=2e-3)


def test_a_pass_may_end_beside_a_posture_by_the_last_digit():
    """Found: points between both coincided, and a path on the biquintic surface was lost with what is no number."""
    work = TwoPointInputs(basin(), TOOL, H, "u")
    one = strip(work, 0.4)
    own = one.lanes[0]
    first, last = own.along[8], own.along[-8]
    reach = np.tile([np.nextafter(first, -np.inf), np.nextafter(last, np.inf)], (len(own.reach), 1))
    ((made,),) = strokes(work, (replace(one, lanes=(replace(own, reach=reach), *one.lanes[1:])),))
    assert np.isfinite(made.tip).all() and np.isfinite(made.axis).all()
    assert np.linalg.norm(np.diff(made.tip, axis=0), axis=1).min() > 0


def test_reasons_for_one_contact():
    along = np.array([15.0])
    assert postures(TwoPointInputs(trough(), TOOL, H, "v"), along, 0.0, 1).reason[0] == TWO
    ridge = postures(TwoPointInputs(trough(hollow=False), TOOL, H, "v"), along, 0.0, 1)
    assert ridge.reason[0] == CONVEX and ridge.contacts[0] == 1
    crosswise = postures(TwoPointInputs(trough(half=0.8), TOOL, H, "u", "one-point"), np.array([0.0]), 15.0, 1)
    assert crosswise.reason[0] == CONVEX and REASONS[CONVEX].endswith("not concave across the feed")
    assert np.degrees(crosswise.stand.lean[0]) == pytest.approx(np.degrees(np.arcsin(10 / RHO)), abs=0.05)


@pytest.mark.parametrize("posture, share", [("matched", 0.5), ("formula", 0.5)])
def test_leans_are_raised_until_nothing_gouges(posture, share):
    """Along the feed the basin is as hollow as across it from its middle on, which the paper's leans leave out."""
    face = basin()
    along = np.linspace(0.1, 0.9, 9)
    printed = postures(TwoPointInputs(face, TOOL, H, "u", posture, share=share), along, 0.4, 1)
    free = postures(TwoPointInputs(face, TOOL, H, "u", f"{posture}-raised", share=share), along, 0.4, 1)
    assert printed.ring.least.min() < -0.01 and free.ring.least.min() >= -2e-5
    assert (free.stand.lean >= printed.stand.lean - 1e-12).all()
    assert (free.stand.lean - printed.stand.lean).max() > 1e-3
    lift = BRIDGE * share * H if posture == "formula" else 0.0
    np.testing.assert_allclose(printed.stand.lift, lift)
    assert (free.stand.lift <= lift + 1e-12).all()


def test_next_strip_meets_what_is_covered():
    work = TwoPointInputs(trough(), TOOL, H, "v", "one-point")
    first = strip(work, -0.3)
    covered = first.step + first.halves[:, 1]
    beside = next_strip(work, covered, 0.05, "ahead")
    gap = beside.step - beside.halves[:, 0] - covered
    assert gap.max() <= 0 and gap.max() > -0.01
    strips = lay_strips(work)
    assert strips[0].step - strips[0].halves[:, 0].min() <= work.span[2] + 1e-9
    assert (strips[-1].step + strips[-1].halves[:, 1]).min() >= work.span[3] - 1e-9
    wide = strips[1].halves.sum(axis=1).min()
    assert len(strips) == np.ceil((work.span[3] - work.span[2]) / wide)


def test_ways_to_lean_and_their_mirror():
    work = TwoPointInputs(trough(), TOOL, H, "v")
    ahead, back = lane(work, 0.1, 1), lane(work, 0.1, -1)
    np.testing.assert_allclose(ahead.halves[10:-10], back.halves[10:-10], rtol=0.02)
    assert (ahead.reach[5:-5, 1] > places(work)[5:-5]).all() and (back.reach[5:-5, 0] < places(work)[5:-5]).all()
    np.testing.assert_allclose(field_of(work, 1).direction, 0.0)
    assert strip(work, 0.1, "inward").halves.sum(axis=1).min() >= 0.99 * ahead.halves.sum(axis=1).min()


@pytest.fixture(scope="module")
def planned():
    hole = np.array([[-0.1, 10.0], [0.1, 10.0], [0.1, 20.0], [-0.1, 20.0]])[::-1]
    rim = np.array([[-0.45, 0.0], [0.45, 0.0], [0.45, 30.0], [-0.45, 30.0]])
    face = trough(trims=(rim, hole))
    job = task(face, TOOL, H, allowance=0.1, tolerance=0.002)
    return face, job, *two_point(job)


def test_the_judge_passes_two_point_contact(planned):
    face, job, found, path = planned
    assert found.outcome == "feasible" and path is not None, found.reasons
    assert found.passes == path.passes and any("two contacts" in why for why in found.reasons)
    verdict = judge(VerificationTask("trough", path.cl, path.axis, path.kind, TOOL.profile, (face,), H, 0.1))
    assert verdict.passed and verdict.gouge_max < 0.002 and verdict.scallop_max < 1.03 * H, verdict.reasons
    assert len(gouging(job, path)) == 0


def test_lower_tips_are_not_proven(planned):
    """The proof between points can fail: 0.003 mm deeper it does."""
    _, job, _, path = planned
    cut = path.kind == Motion.CUT
    low = replace(path, cl=path.cl - np.where(cut[:, None], 0.003 * path.normal, 0.0))
    assert len(gouging(job, low)) > 0.5 * cut.sum()


def test_two_contacts_take_fewer_passes_than_one(planned):
    _, _, found, _ = planned
    work = TwoPointInputs(trough(), TOOL, H, "v", "one-point", allowance=0.1)
    assert found.feed == "v" and found.passes < len(lay_strips(work))
    assert describe_contacts(work, (strip(work, 0.0),)) == (f"{REASONS[BEHIND]} on 100.0 % of the passes",)


def test_bad_input_is_refused():
    with pytest.raises(InvalidInput, match="posture is 'three'"):
        TwoPointInputs(trough(), TOOL, H, "v", "three")
    with pytest.raises(InvalidInput, match="feed is 'w'"):
        TwoPointInputs(trough(), TOOL, H, "w")
    with pytest.raises(InvalidInput, match=r"share of the tolerance is 1\.5"):
        TwoPointInputs(trough(), TOOL, H, "v", "formula", share=1.5)
    with pytest.raises(InvalidInput, match="lead is 90"):
        TwoPointInputs(trough(), TOOL, H, "v", "sturz", np.pi / 2)
    with pytest.raises(InvalidInput, match="flat bottom"):
        TwoPointInputs(trough(), Tool.ball(8), H)
    with pytest.raises(InvalidInput, match=r"comes within|too narrow"):
        lay_strips(TwoPointInputs(Face(CylindricalSurface(8.0, (-0.8, 0.8), (0.0, 30.0)).nurbs(), flip=True), TOOL, H,
                                  "v", "one-point"))
