"""Heights beyond an outline, from the tangent planes along it."""

import numpy as np
import pytest

from toolaxis.skin.tangent_planes import TangentPlanes, heights_beyond, mean_heights_numpy


def planes(seed: int, count: int = 300) -> tuple[TangentPlanes, np.ndarray]:
    rng = np.random.default_rng(seed)
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    border = 20 * np.column_stack([np.cos(turn), np.sin(turn)])
    made = TangentPlanes(border, rng.normal(size=count), rng.normal(size=(count, 2)), 1e-4, 0.8)
    return made, np.concatenate([rng.uniform(-30, 30, (5000, 2)), border[:5]])


@pytest.mark.parametrize("seed", range(4))
def test_the_kernel_agrees_with_its_plain_twin(seed: int) -> None:
    made, places = planes(seed)
    plain = np.empty(len(places))
    mean_heights_numpy(made, places, plain)
    np.testing.assert_allclose(heights_beyond(made, places), plain, rtol=1e-10, atol=1e-10)


def test_at_the_border_the_height_is_its_own_and_one_plane_is_kept() -> None:
    made, places = planes(7)
    np.testing.assert_allclose(heights_beyond(made, places[-5:]), made.height[:5], atol=1e-6)
    border = made.places
    slope = np.array([0.01, -0.02])
    level = made._replace(height=3 + border @ slope, slope=np.tile(slope, (len(border), 1)), rise=1e9)
    np.testing.assert_allclose(heights_beyond(level, places), 3 + places @ slope, atol=1e-9)
