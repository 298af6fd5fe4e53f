"""Cells of faces that other processes make are those that this one would make, and are not made again."""

from dataclasses import fields
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import Cancelled
from toolaxis.job.planning.pipeline import _in_cells
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.bounding import bounding_tree
from toolaxis.shape.bounding.bounding_tree import cells

EXAMPLES = Path(__file__).parents[2] / "examples"


def _job(part: ta.Part) -> SimpleNamespace:
    return SimpleNamespace(part=part, bodies=(), workers=2)


def test_they_are_the_same_and_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    part = ta.load(EXAMPLES / "bosses.step")
    expected = [cells(face) for face in ta.load(EXAMPLES / "bosses.step").faces]
    with monkeypatch.context() as only_children:
        made_here: list[str] = []
        build = bounding_tree.build_tree
        only_children.setattr(bounding_tree, "build_tree",
                              lambda face, fineness: made_here.append(face.label) or build(face, fineness))
        _in_cells(_job(part), NO_PROGRESS)  # type: ignore[arg-type]
        found = [cells(face) for face in part.faces]
        assert not made_here, "what children do is not seen here"
    for one, other, face in zip(found, expected, part.faces, strict=True):
        assert one.faces == (face,)
        for each in fields(one):
            value = getattr(one, each.name)
            if isinstance(value, np.ndarray):
                assert np.array_equal(value, getattr(other, each.name)), each.name


def test_a_stop_is_heard() -> None:
    part = ta.load(EXAMPLES / "bosses.step")
    with pytest.raises(Cancelled):
        _in_cells(_job(part), Progress(cancelled=lambda: True))  # type: ignore[arg-type]
