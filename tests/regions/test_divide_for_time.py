"""Faces that one axis machines, divided where several axes take less time."""

from functools import cache

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.numeric.vectors import unit
from toolaxis.partition.cost_grid import FORBIDDEN, compute_cost_grid
from toolaxis.partition.face_division import PIECE_COST
from toolaxis.partition.uv_grid import Lattice
from toolaxis.regions.divide_for_time import WORTH_SECONDS, WORTH_SHARE, WholeCut, _StripTable, divide_for_time
from toolaxis.regions.scene import ReachScene
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

UP = np.array([0.0, 0.0, 1.0])
FEED, MOVE = 20.0, 6.0


def barrel(half: float = 0.7) -> Face:
    """A part of a tube of 60 mm radius, 50 mm long, over an angle to either side of its top, from outside."""
    turn, along = np.meshgrid(np.linspace(-half, half, 13), np.linspace(0, 50, 7), indexing="ij")
    return Face.from_bspline(np.stack([60 * np.sin(turn), along, 60 * np.cos(turn)], axis=-1))


@cache
def problem(half: float = 0.7, tool: str = "torus:16x2") -> tuple[FaceProblem, ReachScene]:
    """What decides about axes for a barrel alone."""
    part = Part.from_faces([barrel(half)])
    return task(part.face(1), ta.Tool.parse(tool), 0.02, part=part), ReachScene.of(part)


def whole(seconds: float = 600.0, move: float = MOVE) -> WholeCut:
    return WholeCut(unit(np.array([0.012, 0.0, 1.0])), seconds, FEED, move)


def test_a_bent_face_is_divided_into_pieces_that_take_less_together() -> None:
    """The strip of a bull nose is widest where its axis is nearly normal."""
    job, scene = problem()
    found = divide_for_time(job, scene, whole())
    assert found is not None and len(found) >= 2
    assert sum(piece.area for piece in found) == pytest.approx(job.worth.face.area, rel=1e-6)
    undivided = float(found.curve[0, 1])
    assert found.curve[0, 0] == 1 and 600.0 * (1 - sum(found.costs) / undivided) >= max(WORTH_SECONDS, 60.0)
    for piece, axis in zip(found, found.axes, strict=True):
        middle = piece.normal(piece.grid(8, 8)).mean(axis=0)
        assert np.degrees(np.arccos(unit(middle) @ axis)) < np.degrees(np.arccos(unit(middle) @ UP)) + 10.0


def test_every_further_piece_pays_for_its_index_move() -> None:
    job, scene = problem()
    counts = []
    for move in (6.0, 60.0, 1000.0):
        found = divide_for_time(job, scene, whole(move=move))
        counts.append(1 if found is None else len(found))
        if found is not None:
            least = dict(found.curve.tolist())
            assert least[len(found) - 1.0] - least[float(len(found))] >= PIECE_COST + move * FEED
    assert counts[0] > counts[1] >= counts[2] == 1


@pytest.mark.parametrize("seconds, half, tool", [(WORTH_SECONDS / 2, 0.7, "torus:16x2"), (600.0, 0.02, "torus:16x2"),
                                                 (600.0, 0.7, "ball:16")])
def test_what_cannot_save_enough_is_not_reckoned(seconds: float, half: float, tool: str,
                                                 monkeypatch: pytest.MonkeyPatch) -> None:
    """Short cuts, flat faces, and ball ends, whose strips hardly depend on the axis."""
    monkeypatch.setattr("toolaxis.regions.divide_for_time.regions", lambda *given, **named: 1 / 0)
    assert divide_for_time(*problem(half, tool), whole(seconds)) is None


def test_a_saving_has_to_be_worth_a_share_of_a_long_cut() -> None:
    one = WholeCut(UP, 6000.0, FEED, MOVE)
    assert not one.saves(0.99 * WORTH_SHARE * 6000.0) and one.saves(WORTH_SHARE * 6000.0)
    assert not WholeCut(UP, 100.0, FEED, MOVE).saves(WORTH_SECONDS - 0.1)


def test_axes_to_begin_with_are_those_with_the_widest_strips_somewhere() -> None:
    job, scene = problem()
    strips = _StripTable.of(job, scene, whole().axis)
    begin = strips.promising
    assert (begin[0] == whole().axis).all() and 2 < len(begin) < 0.6 * len(strips.axes)
    assert (begin @ UP > np.cos(0.7 + np.radians(25))).all()
    assert 0.2 < strips.share_saved < 1.0


def test_the_axis_that_machines_the_face_counts_where_the_screen_refuses_it() -> None:
    """Found: one node at the tip of a wing was refused under every axis, and no division was known."""
    job, _ = problem()
    lattice = Lattice(job.worth.face, (8, 8))
    farthest = np.arccos((lattice.normals @ UP).min())
    turn = np.pi / 2 - farthest - np.radians(0.5)  # half a degree less than square to the farthest normal
    steep = np.array([np.sin(turn), 0.0, np.cos(turn)])
    axes = np.stack([steep, UP])
    screened = compute_cost_grid(lattice, job.worth, job.feasibility, axes)
    proven = compute_cost_grid(lattice, job.worth, job.feasibility, axes, proven=steep)
    assert (screened.rates[0] == FORBIDDEN).any()
    assert (proven.rates[0] < FORBIDDEN).any(axis=0).sum() > (screened.rates[0] < FORBIDDEN).any(axis=0).sum()
    assert (proven.rates[1] == screened.rates[1]).all(), "other axes stay as they are"
