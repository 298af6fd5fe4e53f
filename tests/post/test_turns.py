"""Three turns and back, against scipy, at and near the singular planes."""

from math import pi

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toolaxis.errors import InvalidInput
from toolaxis.post.plane_angles import ORDERS, matrix_from_turns, turns_from_matrix


@pytest.mark.parametrize("order", ORDERS)
def test_the_matrix_is_scipys(order: str) -> None:
    rng = np.random.default_rng(1)
    for angles in rng.uniform(-pi, pi, (200, 3)):
        wanted = Rotation.from_euler(order, angles).as_matrix()
        assert np.abs(matrix_from_turns(order, angles.tolist()) - wanted).max() < 1e-14


@pytest.mark.parametrize("order", ORDERS)
def test_there_and_back(order: str) -> None:
    """Random planes, planes of the coordinate axes, and planes 1e-15 to 1e-3 rad from singular ones."""
    rng = np.random.default_rng(2)
    matrices = list(Rotation.random(1000, random_state=3).as_matrix())
    square = [0.0, pi / 2, pi, -pi / 2]
    matrices += [matrix_from_turns(order, [a, b, c]) for a in square for b in square for c in square]
    for size in 10.0 ** np.arange(-15, -2):
        for middle in (0.0, pi / 2, -pi / 2, pi):
            a, c = rng.uniform(-pi, pi, 2)
            matrices.append(matrix_from_turns(order, [a, middle + size, c]))
    for matrix in matrices:
        assert np.abs(matrix_from_turns(order, turns_from_matrix(order, matrix).tolist()) - matrix).max() < 1e-12


@pytest.mark.parametrize("order", ORDERS)
def test_a_plane_level_with_the_system_has_no_turns(order: str) -> None:
    assert np.array_equal(turns_from_matrix(order, np.eye(3)), np.zeros(3))


def test_an_unknown_order_is_refused() -> None:
    with pytest.raises(InvalidInput, match="'XYX' is not known"):
        matrix_from_turns("XYX", [0, 0, 0])
