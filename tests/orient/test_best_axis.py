"""The best axis as users ask for it: results, proofs, reasons, walls, cancelling."""

from math import radians

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.clearance.branch_and_bound import BUDGET
from toolaxis.contact.clearance.gouge import segment_penetration
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import OTHER
from toolaxis.feasibility.violations import BACK, FREE, GOUGE, WANDERS, Violation
from toolaxis.machine.limits import Cone
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.path.pass_count import count
from toolaxis.plan.orientation import OUTCOMES, REASONS
from toolaxis.progress import Progress
from toolaxis.search import infeasibility as impossible
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import best_axis, evaluate_axis
from toolaxis.search.hemisphere import CountedAxis, next_in_lobe, search
from toolaxis.search.path_check import PathCheck, prove
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(8, 1)
HELD = Tool.torus(8, 1, stickout=40, holder=[(12, 0), (12, 30)])
H = 0.05
#: Few axes to choose from, where the search is not what is looked at.
NEAR = "cone:0.2,0.2,1,12"


@pytest.mark.parametrize("tolerance", [0.002, pytest.param(0.01, marks=pytest.mark.long)])
def test_result_is_made_proven_and_filled(make, tolerance):
    face = make.seeded(71)
    found = best_axis(face, HELD, H, limits=NEAR, tolerance=tolerance)
    assert found.outcome == "feasible" and abs(np.linalg.norm(found.axis) - 1) < 1e-12
    path = task(face, HELD, H, tolerance=tolerance).made(found.axis, found.feed)
    assert found.passes == path.passes
    assert abs(found.length - path.length(Motion.CUT)) < 1e-9
    assert abs(found.count - count(face, HELD, found.axis, H, found.feed)) < 1e-9
    assert found.count - 0.02 <= found.passes <= found.count + 1.1
    assert abs(found.average_strip_width - face.area / found.length) < 1e-9
    assert found.gouge <= tolerance
    assert segment_penetration(HELD, path.cl, found.axis, (face,)).max() <= found.gouge + 1e-9
    assert set(found.clearance) == {"shank", "holder"}
    assert found.clearance["shank"] >= 0.5 and found.clearance["holder"] >= 1.0


def test_map_and_lobes_tell_what_was_looked_at(make):
    found = best_axis(make.seeded(72), TOOL, H)
    table = found.map
    assert np.count_nonzero(table.reason != BACK) <= found.evaluations < 1650
    assert set(np.unique(table.reason)) <= set(range(len(REASONS)))
    free = table.reason == FREE
    assert np.isfinite(table.length[free]).any() and np.isinf(table.length[~free]).all()
    assert (table.amount[free] == 0).all() and (table.amount[~free] > 0).all()
    for lobe in found.lobes:
        assert lobe.outcome == "feasible" and angle_between(lobe.axis, found.axis) > radians(6)
        assert lobe.count > 0.99 * found.count or lobe.feed != found.feed


@pytest.fixture(scope="module")
def searched(make):
    """The axis that is found on the face on which methods are compared."""
    return best_axis(make.seeded(73), TOOL, H, method="sphere")


@pytest.mark.parametrize("method", ["sphere", pytest.param("sectors", marks=pytest.mark.long)])
def test_both_methods_beat_the_mean_normal_side(make, searched, method):
    face = make.seeded(73)
    found = searched if method == "sphere" else best_axis(face, TOOL, H, method=method)
    plain = evaluate_axis(face, TOOL, unit([0.5, 0.3, 1.0]), H)
    assert found.outcome == plain.outcome == "feasible"
    assert found.length <= plain.length
    assert found.outcome in OUTCOMES


def test_rules_name_one_axis_and_stay_with_it(make, searched):
    face = make.seeded(73)
    ruled = best_axis(face, TOOL, H, method="roman")
    assert ruled.outcome == "feasible" and ruled.count > searched.count
    again = evaluate_axis(face, TOOL, ruled.axis, H)
    assert (again.length, again.passes, again.feed) == (ruled.length, ruled.passes, ruled.feed)
    mean = best_axis(face, Tool.ball(8), H, method="normal")
    assert mean.outcome == "feasible" and mean.axis @ face.normal(face.grid(40, 40)).mean(axis=0) > 0.99 * 0.9
    refused = best_axis(face, TOOL, H, method="normal")
    assert refused.outcome == "not_found" and refused.axis is None and "needs a lead" in refused.reasons[0]


def test_a_given_axis_is_judged_the_same_way(make):
    face = make.seeded(74)
    found = best_axis(face, TOOL, H, limits=NEAR)
    again = evaluate_axis(face, TOOL, found.axis, H, feed=found.feed)
    assert (again.passes, again.length, again.gouge) == (found.passes, found.length, found.gouge)
    refused = evaluate_axis(face, TOOL, face.normal(np.array([[0.5, 0.5]]))[0], H)
    assert refused.outcome == "infeasible" and refused.axis is None
    assert "needs a lead" in refused.reasons[0] and "face 1" in refused.reasons[0]


def test_normals_all_around_are_proven_infeasible(make):
    x = np.linspace(-10, 10, 5)
    dome = make.patch(-0.5 * (x[:, None] ** 2 + x[None] ** 2), size=10)
    found = best_axis(dome, Tool.tapered(8, 1, 30), H)
    assert found.outcome == "infeasible" and found.axis is None
    assert "the cutter reaches 60.0 deg" in found.reasons[0] and "--regions" in found.reasons[0]


def test_a_corner_too_large_is_proven_infeasible(make):
    found = best_axis(make.bowl(3.0, size=5), Tool.ball(8), H)
    assert found.outcome == "infeasible" and "corner radius 4 mm gouges" in found.reasons[0]
    assert best_axis(make.bowl(9.0, size=5), Tool.ball(8), H).outcome == "feasible"


def test_a_corner_that_an_allowance_keeps_off_the_bottom_gouges_nothing(make):
    found = [impossible.corner_too_large(task(make.bowl(3.5, size=2), Tool.ball(8), H, allowance=stock).feasibility)
             for stock in (0.0, 0.3)]
    assert "corner radius 4 mm gouges" in found[0] and found[1] == ""


def test_no_proof_is_drawn_from_a_search_that_was_given_up(make, monkeypatch):
    measured = impossible.lower_bounds

    def given_up(*asked):
        found = measured(*asked)
        return found._replace(lower=found.lower - 5.0, looked=found.looked + BUDGET)

    monkeypatch.setattr(impossible, "lower_bounds", given_up)
    assert impossible.corner_too_large(task(make.bowl(9.0, size=5), Tool.ball(8), H).feasibility) == ""


def test_limits_without_an_axis_are_proven_infeasible(make):
    found = best_axis(make.seeded(75), TOOL, H, machine="cone:0,0,-1,30")
    assert found.outcome == "infeasible" and found.reasons[0].startswith("infeasible: limits and normals leave no axis")
    assert "outside the limits" in found.reasons[0]


def test_a_lid_over_the_face_is_not_found_and_says_what_meets_it(make):
    face = make.seeded(76, 0.3)
    lid = make.flat([-90, -90, 20], [0, 180, 0], [180, 0, 0])
    found = best_axis(face, HELD, H, obstacles=lid, limits="cone:0,0,1,40")
    assert found.outcome == "not_found" and found.axis is None
    assert "collides with face 1 by" in found.reasons[0] and "with the closest of them" in found.reasons[0]
    assert "collision" in found.reasons[-1]


def test_machine_limits_are_kept_and_checked(make):
    face = make.seeded(77)
    found = best_axis(face, TOOL, H, machine=Cone(np.array([0, 0.4, 1.0]), radians(15)), limits="cone:0,0,1,30")
    assert angle_between(found.axis, unit([0, 0.4, 1.0])) <= radians(15) + 1e-8
    with pytest.raises(InvalidInput, match="limits"):
        best_axis(face, TOOL, H, machine=3.0)


@pytest.mark.parametrize("wrong, text", [({"method": "luck"}, "method"), ({"objective": "time"}, "objective"),
                                         ({"scallop": 0.0}, "scallop"), ({"allowance": -9.0}, "allowance")])
def test_wrong_arguments_are_refused(make, wrong, text):
    with pytest.raises(InvalidInput, match=text):
        best_axis(make.seeded(1), TOOL, **{"scallop": H, **wrong})


def test_next_to_a_wall_a_clean_up_zone_stays_and_is_told(make):
    part = make.floor_and_wall()
    found = best_axis(part.faces[0], HELD, H, part=part)
    assert found.outcome == "feasible"
    job = task(part.faces[0], HELD, H, part=part)
    path = job.made(found.axis, found.feed)
    zones = job.left_by(path)
    assert found.unreached == pytest.approx(sum(zone.area for zone in zones) / part.faces[0].area, abs=1e-12)
    assert found.unreached == pytest.approx(job.feasibility.unreached(found.axis), rel=0.1)
    assert found.clearance["cutter"] >= 0.1 - 0.006 and found.clearance["holder"] >= 1.0 - 0.006
    assert (found.unreached > 0) == any("rest material" in reason for reason in found.reasons)
    wall = next(group for group in job.groups if group.role == OTHER)
    assert path.cl[:, 1].max() < wall.faces[0].box[1, 1]
    assert prove(path, HELD, job.groups).witness is None


def test_a_tool_without_shank_comes_out_between_walls_higher_than_it_is_known(make):
    part, tool = make.slot(), Tool.torus(8, 2)
    assert tool.height < 25
    found = best_axis(part.faces[0], tool, H, part=part, limits="cone:0,0,1,60")
    assert found.outcome == "feasible", found.reasons
    job = task(part.faces[0], tool, H, part=part)
    assert prove(job.made(found.axis, found.feed), tool, job.groups).witness is None


def test_the_proof_sees_one_bad_motion(make):
    part = make.floor_and_wall()
    job = task(part.faces[0], HELD, H, part=part, tolerance=0.002)
    axis = unit([0.35, -0.3, 1.0])
    path = job.made(axis, "u")
    assert prove(path, HELD, job.groups).witness is None
    path.cl[len(path.cl) // 2] -= 0.01 * axis
    bad = prove(path, HELD, job.groups).witness
    assert bad is not None and bad.reason == 4 and abs(bad.distance + 0.01) < 0.002
    path.cl[len(path.cl) // 2] += [0, 30.0, 0]
    assert prove(path, HELD, job.groups).witness is not None


def test_a_refused_axis_is_left_for_another(make):
    job = task(make.seeded(78), TOOL, H)
    ledger = AxisTable(job.feasibility, job.worth)
    best = search(ledger)[0]
    other = next_in_lobe(ledger, best, Violation(WANDERS, 0.1))
    assert isinstance(other, CountedAxis) and angle_between(other.axis, best.axis) > radians(0.1)
    assert other.value >= best.value * 0.999


def test_what_the_proof_refuses_is_not_given(make, monkeypatch):
    face, calls = make.seeded(78), []

    def strict(path, *rest, **more):
        calls.append(path.axis[0])
        return PathCheck(Violation(GOUGE, 0.001, "1", distance=-0.003)) if len(calls) == 1 else prove(path, *rest,
                                                                                                      **more)

    monkeypatch.setattr("toolaxis.search.candidate_check.prove", strict)
    found = best_axis(face, TOOL, H, limits=NEAR)
    assert found.outcome == "feasible" and len(calls) == 2
    np.testing.assert_allclose(found.axis, calls[1])
    assert angle_between(calls[0], calls[1]) > radians(0.1)
    assert any(reason.startswith("refused") and "0.003 mm" in reason for reason in found.reasons)


def test_few_motions_that_the_proof_refuses_are_left_out(make, monkeypatch):
    face, refused, kept = make.seeded(78), [], []

    def strict(path, *rest, **more):
        cutting = np.flatnonzero(path.kind[1:] == Motion.CUT)
        if not refused:
            some = cutting[[40, 41]]
            refused.extend(((path.cc[some] + path.cc[some + 1]) / 2).tolist())
            return PathCheck(Violation(GOUGE, 0.001, "1", distance=-0.003), blocked=some)
        kept.append(path.cc[cutting])
        return prove(path, *rest, **more)

    plain = best_axis(face, TOOL, H, limits=NEAR)
    monkeypatch.setattr("toolaxis.search.candidate_check.prove", strict)
    found = best_axis(face, TOOL, H, limits=NEAR)
    np.testing.assert_array_equal(found.axis, plain.axis)
    assert found.outcome == "feasible" and not any(reason.startswith("refused") for reason in found.reasons)
    away = np.linalg.norm(kept[0][:, None] - np.array(refused)[None], axis=2).min(axis=0)
    assert (away > 0.01).all()


def test_cancelling_gives_what_is_known(make):
    seen = []

    def stop():
        return len(seen) > 3

    found = best_axis(make.seeded(79), TOOL, H, progress=Progress(lambda *report: seen.append(report), stop))
    assert found.outcome == "cancelled" and found.axis is None and found.map is not None
    # a total of 0 says that it is not known yet
    assert len(seen) >= 4 and all(0 <= done <= total or total == 0 for _, done, total in seen)


def test_allowance_leaves_stock(make):
    face = make.seeded(80)
    found = best_axis(face, TOOL, H, limits=NEAR, allowance=0.3)
    assert found.outcome == "feasible"
    job = task(face, TOOL, H, allowance=0.3)
    path = job.made(found.axis, found.feed)
    assert segment_penetration(TOOL, path.cl, found.axis, (face,), allowance=0.298).max() <= 0.0005


def test_how_far_a_cutter_reaches_is_told_in_tenths_where_no_spread_is_told():
    t, s = np.meshgrid(np.linspace(0, 5.2, 12), np.linspace(-1.2, 1.2, 7), indexing="ij")
    drop = Face.from_bspline(20 * np.stack([np.cos(s) * np.cos(t), np.cos(s) * np.sin(t), np.sin(s)], axis=-1))
    found = best_axis(drop, Tool.ball(6), H)
    assert "over more than a hemisphere" in found.reasons[0] and "reaches 90.0 deg" in found.reasons[0]
