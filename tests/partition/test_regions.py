"""Sub-surfaces of one face: whole, without overlap, and no dearer than the face undivided."""

import itertools

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.strip.width import step_widths
from toolaxis.machine.limits import Cone
from toolaxis.numeric.polygons import signed_area
from toolaxis.numeric.vectors import unit
from toolaxis.partition import cost_grid
from toolaxis.partition.face_division import LINK, Divider
from toolaxis.partition.partition import regions
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import evaluate_axis

TOOL = ta.Tool.torus(diameter=12, corner_radius=1)


def waved(height: float = 10.0, size: float = 60.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, size, 7), np.linspace(0, size, 7), indexing="ij")
    z = height * np.sin(2 * np.pi * x / size) * np.cos(2 * np.pi * y / size)
    return ta.Face.from_bspline(np.stack([x, y, z], axis=-1))


@pytest.fixture(scope="module")
def divider() -> Divider:
    return Divider(task(waved(), TOOL, 0.05), cells=(10, 10), most=6)


def test_more_sub_surfaces_take_less_length(divider: Divider) -> None:
    curve = divider.curve
    assert np.isfinite(curve[1]) and (np.diff(curve[1:]) < 0).all()
    assert curve[6] < 0.95 * curve[1]


@pytest.mark.parametrize("dense", [0.0, 2.0])
def test_prices_are_the_same_whether_widths_are_taken_node_by_node_or_pair_by_pair(
        dense: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the definition of a rate: passes for a unit of the step at each node, from its own half widths."""
    monkeypatch.setattr(cost_grid, "_DENSE", dense)
    job = task(waved(2.0, 30.0), TOOL, 0.05)
    lattice, axes = Divider(job, cells=(3, 2)).lattice, unit(np.array([[0.1, 0, 1.0], [0, 0.2, 1.0], [0.3, 0.2, 1.0]]))
    prices = cost_grid.compute_cost_grid(lattice, job.worth, job.feasibility, axes)
    free = (prices.rates[:, 0] < cost_grid.FORBIDDEN) & ~prices.left
    assert free.sum() > 12 and len(np.unique(prices.rates[free[:, None].repeat(2, 1)].round(9))) > 12
    for k, feed in itertools.product(range(len(axes)), range(2)):
        for i, j in np.argwhere(free[k]):
            width = step_widths(job.worth.face, TOOL, lattice.uv[i, j], axes[k], 0.05, "uv"[feed]).sum()
            assert prices.rates[k, feed, i, j] == pytest.approx(1 / width, rel=1e-8)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_sub_surfaces_are_the_face(divider: Divider, count: int) -> None:
    found = divider.regions(count)
    face = divider.job.worth.face
    assert len(found) == count
    assert sum(piece.area for piece in found) == pytest.approx(face.area, rel=1e-6)
    uv = np.random.default_rng(count).random((500, 2))
    assert (sum(piece.contains(uv).astype(int) for piece in found) == 1).all()
    assert [piece.label for piece in found] == (["1"] if count == 1 else [f"1{letter}" for letter in "abcde"[:count]])


def test_reckoned_length_is_about_what_the_passes_take(divider: Divider) -> None:
    found = divider.regions(3)
    whole = divider.job.worth.face
    real = [evaluate_axis(piece, TOOL, axis, 0.05, feed=feed, skin=(whole,))
            for piece, axis, feed in zip(found, found.axes, found.feeds, strict=True)]
    assert [one.outcome for one in real] == ["feasible"] * 3, [one.reasons for one in real]
    assert [one.length + LINK * one.passes for one in real] == pytest.approx(found.lengths, rel=0.06)


def test_links_count_so_that_long_passes_are_kept(divider: Divider, monkeypatch: pytest.MonkeyPatch) -> None:
    from importlib import import_module

    monkeypatch.setattr(import_module("toolaxis.partition.face_division"), "LINK", 40.0)
    dear = Divider(divider.job, divider.lattice.cells, divider.most)
    passes = []
    for one in (divider, dear):
        found = one.regions(4)
        real = [evaluate_axis(piece, TOOL, axis, 0.05, feed=feed, skin=(divider.job.worth.face,))
                for piece, axis, feed in zip(found, found.axes, found.feeds, strict=True)]
        passes.append(sum(one.passes for one in real))
    assert passes[1] < 0.95 * passes[0], passes


def test_holes_and_slanting_borders_are_kept() -> None:
    hole = np.array([[0.45, 0.4], [0.45, 0.6], [0.6, 0.6], [0.6, 0.4]])
    border = np.array([[0.0, 0.1], [0.9, 0.0], [1.0, 0.95], [0.1, 1.0]])
    face = waved().trimmed((border, hole))
    found = regions(task(face, TOOL, 0.05), 4)
    assert sum(piece.area for piece in found) == pytest.approx(face.area, rel=1e-6)
    uv = np.random.default_rng(0).random((800, 2))
    assert (sum(piece.contains(uv).astype(int) for piece in found) == face.contains(uv)).all()


def test_a_flat_face_is_left_whole() -> None:
    x, y = np.meshgrid(np.linspace(0, 50, 4), np.linspace(0, 50, 4), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.001 * x * y], axis=-1))
    assert len(ta.partition(face, ta.Tool.ball(diameter=8), 0.05, machine="cone:0,0,1,60")) == 1


@pytest.mark.parametrize("count", [0, 17, 2.5, "many", True])
def test_an_impossible_number_is_refused(count: object) -> None:
    with pytest.raises(ta.InvalidInput, match="sub-surfaces"):
        ta.partition(waved(), TOOL, 0.05, count)  # type: ignore[arg-type]


def test_no_corner_of_a_face_is_forgotten() -> None:
    spike = np.array([[0.0, 0.0], [0.5, 0.0], [0.52, 0.97], [0.54, 0.0], [1.0, 0.0], [1.0, 0.3], [0.0, 0.3]])
    face = waved(2.0).trimmed((spike,))
    found = regions(task(face, TOOL, 0.05), 3)
    area = sum(abs(signed_area(loop)) for piece in found for loop in piece.trims)
    assert area == pytest.approx(abs(signed_area(spike)), rel=1e-9)


def test_pieces_narrower_than_the_cutter_are_refused() -> None:
    job = task(waved(0.3, 20.0), TOOL, 0.05, Cone((0.0, 0.0, 1.0), np.radians(20)))
    with pytest.raises(ta.InvalidInput, match="wider than the cutter"):
        regions(job, 9)


def test_the_user_can_stop() -> None:
    from toolaxis.progress import Progress

    with pytest.raises(ta.Cancelled):
        ta.partition(waved(), TOOL, 0.05, progress=Progress(cancelled=lambda: True))
