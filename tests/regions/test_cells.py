"""Cells of faces: areas add up, contacts lie on the face, and forms are those of the surface."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.numeric.vectors import dot, rotation
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.shape.face import Face

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def cup(radius: float = 20.0) -> Face:
    """A quarter of a tube about y, hollow to a tool inside."""
    turn, along = np.meshgrid(np.linspace(-0.8, 0.8, 33), np.linspace(0, 30, 5), indexing="ij")
    return Face.from_bspline(np.stack([radius * np.sin(turn), along, -radius * np.cos(turn)], axis=-1))


def test_areas_add_up_and_contacts_lie_in_their_cells(scenes) -> None:
    for face in scenes.pocket().faces:
        cells = FaceCells.of(face, 2.0)
        assert cells.area.sum() == pytest.approx(face.area, rel=1e-9) and (cells.area > 0).all()
        assert face.contains(cells.uv).all()
        assert np.allclose(cells.point, face.evaluate(cells.uv).point)
        assert np.allclose(np.linalg.norm(cells.normal, axis=1), 1)
        assert np.allclose(dot(cells.normal, cells.tangent), 0, atol=1e-12)
        assert (cells.index.min(axis=0) == 0).all() and (cells.index.max(axis=0) < cells.shape).all()
        assert len(np.unique(cells.index @ [cells.shape[1], 1])) == len(cells)


def test_areas_of_cells_follow_a_trim() -> None:
    """A disc in a square: no cell holds much more than the disc has there."""
    turn = np.linspace(0, 2 * np.pi, 201)[:-1]
    disc = 0.5 + 0.4 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    face = Face.from_bspline(np.array([[[0.0, 0, 0], [0, 40, 0]], [[40, 0, 0], [40, 40, 0]]]), (1, 1), trims=(disc,))
    cells = FaceCells.of(face, 0.5)
    middle = (cells.point[:, :2] * cells.area[:, None]).sum(axis=0) / cells.area.sum()
    assert middle == pytest.approx([20, 20], abs=0.01)
    second = (np.sum((cells.point[:, :2] - 20) ** 2, axis=1) * cells.area).sum() / cells.area.sum()
    assert second == pytest.approx(16**2 / 2, rel=0.02)


def test_forms_are_the_curvatures_of_a_tube() -> None:
    cells = FaceCells.of(cup(), 2.0)
    mean, twist = (cells.form[:, 0] + cells.form[:, 2]) / 2, cells.form[:, 1]
    spread = np.hypot((cells.form[:, 0] - cells.form[:, 2]) / 2, twist)
    inner = np.abs(cells.point[:, 0]) < 10
    assert (mean + spread)[inner] == pytest.approx(1 / 20, rel=0.05)
    assert (mean - spread)[inner] == pytest.approx(0, abs=1e-4)
    assert np.abs(cells.tangent[:, 1]).max() < 1e-9  # Su runs around
    assert cells.form[inner, 0] == pytest.approx(1 / 20, rel=0.05)
    # Normals turn by 5 degrees over a cell at most, so by half of that to its sides.
    assert 0 < np.degrees(cells.spread).max() <= 2.8


def test_moving_a_face_moves_its_cells(scenes) -> None:
    face = scenes.pocket().faces[0]
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation([1.0, 0.3, 0.2], 0.7), [5.0, 6.0, 7.0]
    one, other = FaceCells.of(face, 2.0), FaceCells.of(face.transformed(matrix), 2.0)
    assert one.shape == other.shape and np.array_equal(one.index, other.index)
    assert np.allclose(other.point, one.point @ matrix[:3, :3].T + matrix[:3, 3], atol=1e-9)
    assert np.allclose(other.normal, one.normal @ matrix[:3, :3].T, atol=1e-9)
    assert np.allclose(other.form, one.form, atol=1e-9) and np.allclose(other.area, one.area)


def test_smaller_cutters_make_more_cells(scenes) -> None:
    counts = [len(FaceCells.of(scenes.pocket().faces[0], radius)) for radius in (10.0, 2.0, 0.5)]
    assert counts == sorted(counts) and counts[0] >= 144 and counts[-1] == 32 * 32


def test_a_narrow_sliver_across_the_lattice_has_cells() -> None:
    line = np.linspace(0.01, 0.95, 40)
    width = 0.0006
    loop = np.concatenate([np.stack([line, line], 1), np.stack([line[::-1], line[::-1] + width], 1)])
    face = Face.from_bspline(np.array([[[0.0, 0, 0], [0, 40, 0]], [[40, 0, 0], [40, 40, 0]]]), (1, 1), trims=(loop,))
    cells = FaceCells.of(face, 5.0)
    assert len(cells) > 5 and cells.area.sum() == pytest.approx(face.area)


def test_axes_see_some_cell_and_are_evenly_apart() -> None:
    cells = FaceCells.of(cup(), 2.0)
    axes = screening_axes([cells])
    assert np.allclose(np.linalg.norm(axes, axis=1), 1)
    assert ((axes @ cells.normal.T).max(axis=1) > 0).all()
    directions = np.random.default_rng(1).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    seen = directions[(directions @ cells.normal.T).max(axis=1) > 0.3]
    nearest = np.degrees(np.arccos(np.clip((seen @ axes.T).max(axis=1), -1, 1)))
    assert nearest.max() < 12


@pytest.mark.parametrize("name", ["blisk", "bosses"])
def test_every_sculptured_face_of_an_example_has_cells(name: str) -> None:
    pytest.importorskip("OCP")
    for face in ta.load(EXAMPLES / f"{name}.step").sculptured[::7]:
        cells = FaceCells.of(face, 2.0)
        assert 100 < len(cells) <= 1024 and cells.area.sum() == pytest.approx(face.area)
        assert np.isfinite(cells.form).all()
