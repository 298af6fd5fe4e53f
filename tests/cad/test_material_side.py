"""Faces whose file has the material on the wrong side: which are turned over, and which stay as they are."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cad.material_side import FEW, faces_to_turn
from toolaxis.shape.adjacency import Border
from toolaxis.shape.face import Face

ENDS = np.array([[1.0, 0.0], [1.0, 1.0]]), np.array([[0.0, 0.0], [0.0, 1.0]])


def strips(*widths: float) -> tuple[list[Face], list[Border]]:
    """Flat strips side by side, and where they meet: the right side of each is the left side of the next."""
    at = np.cumsum([0.0, *widths])
    faces = [replace(Face.from_bspline([[[x, y, 0.0] for y in (0, 10)] for x in (at[k], at[k + 1])], degree=(1, 1)),
                     number=k + 1) for k in range(len(widths))]
    borders = [Border((k, k + 1), np.array([[at[k], 0.0, 0.0], [at[k], 10.0, 0.0]]), *ENDS, True, False)
               for k in range(1, len(widths))]
    return faces, borders


def flipped(faces: list[Face], *numbers: int) -> list[Face]:
    return [replace(face, flip=not face.flip) if face.number in numbers else face for face in faces]


@pytest.mark.parametrize("wrong", [(), (1,), (2,), (4,), (1, 4)])
def test_the_few_are_turned(wrong: tuple[int, ...]) -> None:
    faces, borders = strips(3, 2, 20, 1)
    assert faces_to_turn(flipped(faces, *wrong), borders) == set(wrong)


def test_where_the_large_one_is_wrong_the_small_ones_are_turned_to_it() -> None:
    """Nobody knows the right side: the larger area decides."""
    faces, borders = strips(3, 2, 20, 1)
    assert faces_to_turn(flipped(faces, 3), borders) == {1, 2, 4}


def test_with_much_of_the_area_on_either_side_all_stay() -> None:
    faces, borders = strips(10, 10 * FEW / (1 - FEW) + 0.1)
    assert faces_to_turn(flipped(faces, 2), borders) == frozenset()
    faces, borders = strips(10, 10 * FEW / (1 - FEW) - 0.1)
    assert faces_to_turn(flipped(faces, 2), borders) == {2}


def test_a_band_with_one_side_stays_as_it_is() -> None:
    """A Moebius band contradicts itself, whatever is turned."""
    faces, borders = strips(3, 2, 20)
    closing = Border((3, 1), borders[0].points, *ENDS, True, True)
    assert faces_to_turn(flipped(faces, 2), [*borders, closing]) == frozenset()


def test_faces_that_do_not_hang_together_do_not_judge_each_other() -> None:
    faces, borders = strips(3, 2, 20, 1)
    assert faces_to_turn(flipped(faces, 1, 2), [borders[0], borders[2]]) == frozenset()


def test_the_longer_border_counts_where_two_faces_meet_twice() -> None:
    """Found: a trailing edge that runs out to nothing, where its normal says nothing."""
    faces, borders = strips(3, 20)
    short = Border((1, 2), 0.3 * borders[0].points, *ENDS, True, True)
    assert faces_to_turn(flipped(faces, 1), [*borders, short]) == {1}
    assert faces_to_turn(faces, [*borders, short]) == frozenset()
