"""Binary space partition: tiles, tolerance, determinism."""

import numpy as np
import pytest

from toolaxis.numeric.feature_partition import centroid, distances, partition, two_means


def _scene(seed=0, n=500):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 1, (n, 2))
    return xy, (xy * 0.5, np.sin(6 * xy[:, :1]) * 0.3)


def test_two_clear_clusters_are_told_apart():
    points = np.vstack([np.zeros((5, 2)), np.ones((7, 2))]) + np.linspace(0, 0.01, 24).reshape(12, 2)
    second = two_means((points,), np.arange(12))
    assert len({*second[:5]}) == 1 and len({*second[5:]}) == 1 and second[0] != second[-1]


def test_points_that_do_not_differ_are_one_cluster():
    assert not two_means((np.ones((4, 3)),), np.arange(4)).any()


@pytest.mark.parametrize("tolerance", [0.3, 0.1, 0.03])
def test_patches_tile_the_rectangle_and_keep_the_tolerance(tolerance):
    xy, groups = _scene()
    patches = partition(xy, groups, tolerance, np.array([0.0, 1, 0, 1]))
    assert np.sort(np.concatenate([p.members for p in patches])).tolist() == list(range(len(xy)))
    area = sum((p.rectangle[1] - p.rectangle[0]) * (p.rectangle[3] - p.rectangle[2]) for p in patches)
    assert area == pytest.approx(1.0, abs=1e-12)
    for p in patches:
        inside = xy[p.members]
        assert (inside >= p.rectangle[[0, 2]]).all() and (inside <= p.rectangle[[1, 3]]).all()
        assert distances(groups, p.members, centroid(groups, p.members)).max() <= tolerance


def test_a_finer_tolerance_needs_more_patches():
    xy, groups = _scene()
    counts = [len(partition(xy, groups, t, np.array([0.0, 1, 0, 1]))) for t in (0.3, 0.1, 0.03)]
    assert counts[0] < counts[1] < counts[2]


def test_no_points_no_patches():
    assert partition(np.empty((0, 2)), (np.empty((0, 3)),), 0.1, np.array([0.0, 1, 0, 1])) == []
