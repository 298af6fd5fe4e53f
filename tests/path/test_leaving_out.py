"""Passes without motions that a proof refused."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.path import traced_pieces
from toolaxis.path.cl_points import trace
from toolaxis.path.leaving_out import leave_out
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_layout import lay_out
from toolaxis.path.traced_pieces import TracedPieces

CHORD = 0.002


@pytest.fixture(scope="module")
def laid():
    x, y = np.meshgrid(np.linspace(0, 16, 5), np.linspace(0, 14, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.4 * np.sin(x / 6) * np.cos(y / 7)], axis=-1))
    placed = lay_out(IsoChart(face), Cut(ta.Tool.ball(diameter=6), np.array([0.1, -0.2, 0.97]), 0.02))
    return placed, trace(placed, CHORD)


@pytest.mark.parametrize("seed", range(6))
def test_what_is_left_out_is_cut_no_more_and_all_else_is(laid, seed: int) -> None:
    placed, path = laid
    cutting = np.flatnonzero(path.kind[1:] == Motion.CUT)
    chosen = np.sort(np.random.default_rng(seed).choice(cutting, 7, replace=False))
    fewer, ends = leave_out(placed, path, chosen, CHORD)
    np.testing.assert_array_equal(ends, np.stack([path.cc[chosen], path.cc[chosen + 1]], axis=1))
    made = trace(fewer, CHORD)
    at = np.flatnonzero(made.kind[1:] == Motion.CUT)
    middles = (made.cc[at] + made.cc[at + 1]) / 2
    for first, last in ends:
        way = last - first
        share = (middles - first) @ way / (way @ way)
        off = np.linalg.norm(middles - first - np.clip(share, 0, 1)[:, None] * way, axis=1)
        assert not ((off < 1e-3) & (share > 0) & (share < 1)).any()
    gone = np.linalg.norm(np.diff(path.cl, axis=0), axis=1)[chosen].sum()
    assert path.length(Motion.CUT) - made.length(Motion.CUT) == pytest.approx(gone, rel=0.25)


def test_links_are_not_left_out(laid) -> None:
    placed, path = laid
    links = np.flatnonzero(path.kind[1:] == Motion.LINK)
    same, ends = leave_out(placed, path, links, CHORD)
    assert same is placed and not len(ends)


def test_pieces_that_stay_are_not_traced_again_and_are_as_if_they_were(laid, monkeypatch: pytest.MonkeyPatch) -> None:
    placed, path = laid
    chosen = np.flatnonzero(path.kind[1:] == Motion.CUT)[100:102]
    fewer, _ = leave_out(placed, path, chosen, CHORD)
    follow, asked = traced_pieces.follow, []
    monkeypatch.setattr(traced_pieces, "follow", lambda *given: asked.append(given[2]) or follow(*given))
    made = trace(fewer, CHORD)
    new = [row for row in fewer.pieces.tolist() if row not in placed.pieces.tolist()]
    assert 0 < len(new) < len(fewer.pieces) and np.concatenate(asked).tolist() == new
    afresh = trace(replace(fewer, traced=TracedPieces()), CHORD)
    assert len(asked) == 2 and len(asked[1]) == len(fewer.pieces)
    for name in ("cl", "cc", "kind"):
        np.testing.assert_array_equal(getattr(made, name), getattr(afresh, name))
