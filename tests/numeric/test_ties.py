"""Numbers that are equal but for rounding."""

import numpy as np

from toolaxis.numeric.rounding import canonical_sign, round_costs, round_significant
from toolaxis.numeric.vectors import perpendicular


def test_sums_in_another_order_are_ties_and_true_differences_are_none():
    terms = np.random.default_rng(0).uniform(0, 1, 3000)
    one, other = terms.sum(), terms[::-1].cumsum()[-1]
    assert one != other and round_costs(one) == round_costs(other)
    assert round_significant(0.1 + 0.2) == round_significant(0.3) and 0.1 + 0.2 != 0.3
    assert round_significant(0.3 + 2e-9) > round_significant(0.3) and round_costs(1e4 + 2e-6) > round_costs(1e4)
    assert round_significant([np.inf, -np.inf]).tolist() == [np.inf, -np.inf]


def test_a_direction_without_sense_has_one():
    for row in ([0.6, -0.8, 0.0], [1e-17, 0.0, -1.0], [-1e-17, -3e-12, 1.0]):
        assert (canonical_sign(row) == canonical_sign(np.negative(row))).all()
    assert canonical_sign([-1e-17, 0.0, 1.0])[2] == 1.0 and canonical_sign([-0.5, 1.0])[0] == 0.5


def test_the_last_digits_of_an_axis_do_not_turn_what_is_perpendicular():
    for noise in ([1e-17, 0, 0], [0, 1e-17, 0], [-1e-16, 1e-16, 0]):
        np.testing.assert_allclose(perpendicular(np.array([0, 0, 1.0]) + noise)[0], [1, 0, 0], atol=1e-12)
