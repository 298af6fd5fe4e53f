"""Passes without the motions that a proof refused: the pieces end before each of them and go on behind it."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.path.pass_layout import Layout

Array = NDArray[np.float64]
Index = NDArray[np.intp]

#: How far apart a point of a path and the place on a pass that it was traced from may be, mm.
_SAME = 1e-6
#: How far pieces end before what is left out, as a share of its length.
_ASIDE = 0.05
#: What is shorter than this share of a piece is none.
_SHORT = 1e-6


def leave_out(layout: Layout, path: ToolPath, motions: Index, chord: float) -> tuple[Layout, Array]:
    """Passes without some of their cutting motions.

    Parameters
    ----------
    layout : Layout
    path : ToolPath
        Traced from it.
    motions : (k,) array of int
        Motion i goes from point i to point i + 1; those that do not cut change nothing.
    chord : float
        With which the path was traced, mm.

    Returns
    -------
    layout : Layout
    ends : (m, 2, 3) array
        Contacts at both ends of each motion that was left out, mm.
    """
    cutting = motions[path.kind[motions + 1] == Motion.CUT]
    ends = np.stack([path.cc[cutting], path.cc[cutting + 1]], axis=1)
    if not len(cutting):
        return layout, ends
    traced = layout.traced.trace(layout.chart, layout.cut, layout.pieces, chord)
    piece = np.repeat(np.arange(len(traced)), [len(one.along) for one in traced])
    along = np.concatenate([one.along for one in traced])
    near = cKDTree(np.concatenate([one.move.contact for one in traced]))
    gaps: dict[int, list[tuple[float, float]]] = {}
    for pair in ends:
        starts, stops = near.query_ball_point(pair, _SAME)
        for k in starts:
            for other in (k - 1, k + 1):
                if other in stops and piece[other] == piece[k]:
                    gap = sorted((float(along[k]), float(along[other])))
                    gaps.setdefault(int(piece[k]), []).append((gap[0], gap[1]))
    rows: list[tuple[float, float, float]] = []
    owners: list[int] = []
    for number, (low, high, step) in enumerate(layout.pieces):
        for stretch in _without(float(low), float(high), sorted(gaps.get(number, []))):
            rows.append((*stretch, float(step)))
            owners.append(int(layout.owner[number]))
    return replace(layout, pieces=np.array(rows).reshape(-1, 3), owner=np.array(owners, dtype=np.intp)), ends


def _without(low: float, high: float, gaps: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """What is left of a piece without gaps, sorted by their begins."""
    found: list[tuple[float, float]] = []
    whole = high - low
    for first, last in gaps:
        aside = _ASIDE * (last - first)
        found.append((low, first - aside))
        low = max(low, last + aside)
    found.append((low, high))
    return [(start, end) for start, end in found if end - start > _SHORT * whole]
