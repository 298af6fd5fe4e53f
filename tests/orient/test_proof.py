"""What the proof of a path says in figures."""

import numpy as np
import pytest

from toolaxis import Tolerance, Tool
from toolaxis.search import fixed_axis as indexed
from toolaxis.search import path_check as proof


@pytest.fixture
def loosely(monkeypatch):
    """Measuring that gives up early: true bounds, 1.5 mm below the distances."""
    measured = proof.lower_bounds

    def loose(*asked):
        found = measured(*asked)
        return found._replace(lower=found.lower - 1.5)

    monkeypatch.setattr(proof, "lower_bounds", loose)


def test_figures_are_never_worse_than_what_is_proven(loosely, make):
    part, tolerance = make.floor_and_wall(), Tolerance()
    tool = Tool.torus(10, 2, stickout=40, holder=[(12, 0), (12, 20)])
    job = indexed.task(part.faces[0], tool, 0.1, part=part, tolerance=tolerance)
    axis = np.array([0.1, -0.5, 1.0])
    found = proof.prove(job.made(axis / np.linalg.norm(axis), "u"), tool, job.groups)
    assert found.witness is None
    assert 0.0 <= found.gouge <= tolerance.gouge
    assert found.clearance["cutter"] >= tolerance.cutter_clearance
