"""Operations on other blades: turned where faces are the same, laid anew where they differ, searched where refused."""

import os
import signal
from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import Cancelled
from toolaxis.job.planning import blade_copies as turned
from toolaxis.job.planning.blade_copies import spread_out
from toolaxis.job.planning.blade_pattern import find_pattern
from toolaxis.job.planning.parallel import check_workers
from toolaxis.job.planning.planner import went_on
from toolaxis.machine.limits import parse_limits
from toolaxis.plan.orientation import Orientation
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.search.face_problem import task
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.part import Part

COUNT = 4
TOOL = ta.Tool.torus(diameter=6, corner_radius=1, stickout=40, holder=[(8, 0), (8, 30)])
SCALLOP = 0.3


def turn(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def sides(how=""):
    """The two sides of a thin blade along +x; they are thicker, or run along x with another speed, where asked for."""
    along = 10 * np.array([0, 1 / 6, 1 / 2, 1.0]) if how == "warped" else np.linspace(0, 10, 4)
    z, x = np.meshgrid(np.linspace(-6, 6, 5), 20 + along, indexing="ij")
    bend = (1 - (z / 6) ** 2) * (1.01 if how == "thick" else 1.0)
    return [Face.from_bspline(np.dstack([x, bulge * bend + 0.02 * (x - 20) * z, z]), flip=flip)
            for bulge, flip in ((2.0, False), (0.5, True))]


def wheel(change="", *further):
    """Four blades around a cylinder, the second another one; further faces stand around."""
    faces = [Face(CylindricalSurface(12.0, (0.0, 2 * np.pi), (-8.0, 8.0)).nurbs(), kind="cylinder")]
    for k in range(COUNT):
        move = turn(2 * np.pi * k / COUNT)
        if k == 1 and change == "moved":
            move = move @ np.array([[1, 0, 0, 0.02], [0, 1, 0, 0], [0, 0, 1, 0.05], [0, 0, 0, 1.0]])
        faces += [face.transformed(move) for face in sides(change if k == 1 else "")]
    return Part.from_faces([*faces, *further])


class Planner:
    """Proves as planning does; what it would search anew it only notes."""

    workers = 1

    def __init__(self):
        self.asked = []

    def task(self, part, face, tool, progress):
        return task(face, tool, SCALLOP, None, (), part=part, progress=progress)

    def search(self, part, op, progress):
        self.asked.append(op.face.number)
        return replace(op, orientation=Orientation(None, reasons=("searched",)), path=None, frame=None)


@pytest.fixture(scope="module")
def first():
    """The first side of the first blade, machined."""
    made = ta.plan(wheel(), TOOL, SCALLOP, faces=[2], limits="cone:0.93,0.33,0.17,6")
    assert made.outcome == "complete"
    return made


def spread(first, part):
    pattern, warnings = find_pattern(part)
    assert pattern is not None and warnings == ()
    planner = Planner()
    return spread_out(pattern, replace(first, part=part), planner, NO_PROGRESS), planner, pattern


def on_second(found):
    """Operation 1 on the blade that was changed: found by its face, whatever way the blades are counted."""
    return next(op for op in found.operations if op.face.number == 4)


def test_blades_alike_take_the_very_path(first):
    found, planner, pattern = spread(first, wheel())
    assert found.blades.copies == {2: 1, 3: 1, 4: 1} and planner.asked == []
    assert all(op.orientation.evaluations == 1 for op in found.operations[1:])
    assert not any("alike" in text for text in pattern.part.warnings)


def test_a_blade_that_stands_a_little_elsewhere_is_followed(first):
    found, planner, _ = spread(first, wheel("moved"))
    made, source = on_second(found), found.operations[0]
    assert planner.asked == [] and made.orientation.evaluations == 1
    move = turn(np.pi / 2) @ np.array([[1, 0, 0, 0.02], [0, 1, 0, 0], [0, 0, 1, 0.05], [0, 0, 0, 1.0]])
    assert made.path.cl == pytest.approx(source.path.cl @ move[:3, :3].T + move[:3, 3], abs=1e-6)


@pytest.mark.parametrize("change", ["thick", "warped"])
def test_a_blade_with_other_faces_gets_passes_of_its_own_under_the_turned_axis(change, first):
    found, planner, pattern = spread(first, wheel(change))
    made, source = on_second(found), found.operations[0]
    assert planner.asked == [] and made.done and found.blades.copies[made.number] == 1
    assert "passes laid anew: the faces differ" in made.orientation.reasons[0]
    assert made.orientation.axis == pytest.approx(turn(np.pi / 2)[:3, :3] @ source.orientation.axis, abs=2e-3)
    cut = made.path.kind == 0
    away = nearest(pattern.part.face(4), made.path.cc[cut][::7]).distance  # some contacts lie beyond the border
    assert np.mean(away < 1e-6) > 0.6
    told = [text for text in pattern.part.warnings if "alike to within" in text]
    assert len(told) == (change == "thick")


def test_where_the_proof_refuses_the_copy_the_axis_is_searched_anew_and_it_is_said_why(first):
    at = first.operations[0]
    stand = at.path.cl.mean(axis=0) + 8 * at.orientation.axis  # in the way of the cutter's flutes
    across = np.linalg.svd(at.orientation.axis[None])[2][1:] * 2
    corner = stand - across.sum(axis=0) / 2
    corners = corner + np.array([[0 * corner, across[1]], [across[0], across.sum(axis=0)]])
    wall = Face.from_bspline(corners, degree=(1, 1))
    found, planner, _ = spread(first, wheel("", replace(wall.transformed(turn(np.pi / 2)), kind="plane")))
    made = on_second(found)
    assert planner.asked == [4] and not made.done and made.number not in found.blades.copies
    assert made.orientation.reasons[-1] == "searched"
    assert "the turned axis of op01-face2 was refused here" in made.orientation.reasons[0]
    assert "with face 10" in made.orientation.reasons[0] or "of face 10" in made.orientation.reasons[0]
    assert sorted(found.blades.copies.values()) == [1, 1]


def test_where_passes_laid_anew_are_refused_the_axis_is_searched_too(first):
    def _shut(part, face, tool, progress):
        limits = parse_limits("cone:" + ",".join(map(str, -first.operations[0].orientation.axis)) + ",5")
        return task(face, tool, SCALLOP, limits, (), part=part, progress=progress)

    pattern, _ = find_pattern(wheel("thick"))
    planner = Planner()
    planner.task = _shut
    found = spread_out(pattern, replace(first, part=pattern.part), planner, NO_PROGRESS)
    assert sorted(planner.asked) == [4, 6, 8]
    assert not found.blades.copies


def test_a_stop_keeps_the_blades_that_were_finished(first):
    pattern, _ = find_pattern(wheel())
    planner, seen = Planner(), []

    def _report(stage, done, total):
        seen.append(stage)
        if stage.startswith("blade 4"):
            raise Cancelled("cancelled by the user")

    found = spread_out(pattern, replace(first, part=pattern.part), planner, Progress(_report))
    assert found.outcome == "cancelled" and len(found.operations) == 3


@pytest.mark.parametrize("stage", ["proof of turned operations", "rest material"])
def test_a_stop_keeps_the_blades_that_are_finished(first, stage, monkeypatch):
    """Found: what was finished was put together by code that hears the stop too, and was lost with it."""
    asked = []

    def _report(name, *_):
        if name.startswith("blade 4") and stage in name:
            asked.append(name)

    pattern, _ = find_pattern(wheel("thick"))
    stop = Progress(_report, lambda: bool(asked))
    whole = turned.with_zones
    if stage == "rest material":
        def _zones(plan, op):
            asked.append(stage)
            return whole(plan, op)

        monkeypatch.setattr(turned, "with_zones", _zones)
    with activate_progress(stop):
        found = went_on(replace(first, part=pattern.part), lambda plan: spread_out(pattern, plan, Planner(), stop))
    assert found.outcome == "cancelled" and all(op.done for op in found.operations)
    assert len(found.operations) == (3 if stage.startswith("proof") else 4)
    assert len(found.blades.blades) == COUNT and all(blade.area >= 0 for blade in found.blades.blades)


def test_a_stop_in_the_last_stage_keeps_all(first):
    def _stage(plan):
        raise Cancelled("cancelled by the user")

    found = went_on(first, _stage)
    assert found.outcome == "cancelled" and found.operations == first.operations
    assert went_on(found, lambda plan: 1 // 0) is found


def test_a_fault_on_one_blade_costs_that_operation_there(first, monkeypatch):
    whole = turned._proven

    def _proven(op, *rest):
        if op.face.number == 4:
            raise IndexError("planted")
        return whole(op, *rest)

    monkeypatch.setattr(turned, "_proven", _proven)
    found, _, _ = spread(first, wheel())
    lost = on_second(found)
    assert lost.failed and lost.orientation.reasons[0].startswith("failed: IndexError: planted")
    assert "Traceback" in lost.traceback and lost.face.number == 4
    assert [op.done for op in found.operations].count(True) == 3 and found.outcome == "incomplete"


@pytest.mark.skipif(check_workers(2) == 1, reason="processes are only forked on Linux")
def test_a_process_that_dies_over_a_blade_costs_that_blade(first, monkeypatch):
    whole, here = turned._proven, os.getpid()

    def _proven(op, *rest):
        if op.face.number == 4 and os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return whole(op, *rest)

    monkeypatch.setattr(turned, "_proven", _proven)
    pattern, _ = find_pattern(wheel())
    planner = Planner()
    planner.workers = 2
    found = spread_out(pattern, replace(first, part=pattern.part), planner, NO_PROGRESS)
    assert "SIGKILL" in on_second(found).orientation.reasons[0] and found.outcome == "incomplete"
    assert [op.done for op in found.operations].count(True) == 3
