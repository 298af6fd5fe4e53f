"""Golden section over many functions at once."""

import numpy as np
import pytest

from toolaxis.numeric.golden_section import least_between


def test_minima_inside_and_at_both_ends() -> None:
    centre = np.array([0.3, -5.0, 7.0, 1.0])
    argument, value = least_between(lambda t: (t - centre) ** 2 + centre, np.zeros(4), np.full(4, 2.0))
    assert argument == pytest.approx([0.3, 0.0, 2.0, 1.0], abs=1e-7)
    assert value == pytest.approx(centre + np.array([0, 25, 25, 0]), abs=1e-12)


def test_never_above_the_ends() -> None:
    rng = np.random.default_rng(0)
    phase = rng.uniform(0, 6, 200)
    argument, value = least_between(lambda t: np.sin(9 * t + phase), np.zeros(200), np.ones(200))
    assert (value <= np.minimum(np.sin(phase), np.sin(9 + phase))).all()
    assert value == pytest.approx(np.sin(9 * argument + phase), abs=1e-12)
