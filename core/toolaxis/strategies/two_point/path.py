"""From strips of a flat end to a tool path with an axis for each point, and its proof."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.common.links import MovingCuttingMove
from toolaxis.strategies.two_point.inputs import TwoPointInputs
from toolaxis.strategies.two_point.postures import postures
from toolaxis.strategies.two_point.strips import PassPostures, Strip, left_out, places

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Places across a strip at which it is looked whether the face is there.
_ACROSS = 15
#: Parts of a stroke shorter than this share of it are none.
_SAME = 1e-9


def strokes(work: TwoPointInputs, strips: tuple[Strip, ...], direction: str = "zigzag",
            progress: Progress = NO_PROGRESS) -> list[list[MovingCuttingMove]]:
    """Cutting motions of passes in the order of cutting.

    Parameters
    ----------
    work : TwoPointInputs
    strips : tuple of Strip
    direction : str
        "zigzag" (every other pass back), "climb" or "conventional" (all one way, for a cutter that turns clockwise).
    progress : Progress
    """
    climbs = _climbs(work)
    found: list[list[MovingCuttingMove]] = []
    for number, one in enumerate(strips):
        progress.report("postures", number, len(strips))
        onward = number % 2 == 0 if direction == "zigzag" else climbs == (direction == "climb")
        pieces = [_stroke(work, one, lane, span) for lane, where in one.shares
                  for span in _spans(work, one, lane, where)]
        if pieces:
            found.append(pieces if onward else [_back(piece) for piece in reversed(pieces)])
    return found


def _climbs(work: TwoPointInputs) -> bool:
    """Whether travel in growing parameter climbs: passes proceed in growing step parameter, where material is left."""
    a0, a1, s0, s1 = work.span
    uv = work.uv(np.array([(a0 + a1) / 2]), (s0 + s1) / 2)
    d = work.face.evaluate(uv)
    normal = work.face.normal(uv)[0]
    along = d.su[0]
    across = d.sv[0]
    if work.feed == "v":
        along, across = across, along
    return bool(np.cross(along, normal) @ across >= 0)


def _spans(work: TwoPointInputs, one: Strip, lane: PassPostures, where: slice) -> list[tuple[float, float]]:
    """From where to where along a pass a lane works: as far as its strip holds some of the face."""
    along = places(work)
    low = one.step - one.halves[:, 0]
    high = one.step + one.halves[:, 1]
    share = np.linspace(0.0, 1.0, _ACROSS)
    steps = np.clip(low[:, None] + (high - low)[:, None] * share, *work.span[2:])
    pair = np.stack(np.broadcast_arrays(along[:, None], steps), axis=-1).reshape(-1, 2)
    inside = work.face.contains(pair if work.feed == "u" else pair[:, ::-1])
    on = inside.reshape(steps.shape).any(axis=1) & ~left_out(one)
    on[1:-1] |= on[2:] | on[:-2]
    own = np.zeros(len(on), dtype=bool)
    own[where] = True
    works = np.concatenate([[0], (on & own).astype(int), [0]])
    changes = np.flatnonzero(np.diff(works))
    found = []
    for first, after in changes.reshape(-1, 2):
        reach = lane.reach[max(first - 1, 0):after + 1]
        reach = reach[np.isfinite(reach).all(axis=1)]
        if len(reach) and reach[:, 1].max() > reach[:, 0].min():
            found.append((float(reach[:, 0].min()), float(reach[:, 1].max())))
    return found


def _stroke(work: TwoPointInputs, one: Strip, lane: PassPostures, span: tuple[float, float]) -> MovingCuttingMove:
    """Points of a pass, so close that straight motions keep the chord tolerance, at tip, rim and twice that high."""
    begin, end = span
    on = (lane.along >= begin) & (lane.along <= end)
    along = np.unique(np.concatenate([[begin], lane.along[on], [end]]))
    # An end may lie beside a posture by the last digit: points there would coincide, and have no way between them.
    along = along[np.append(np.diff(along) > _SAME * (end - begin), True)]
    middles = (along[1:] + along[:-1]) / 2
    parts = np.interp(middles, lane.along[1:-1], _parts(work, lane)).round().astype(np.int64)
    pieces = [np.linspace(low, high, count, endpoint=False)
              for (low, high), count in zip(pairwise(along), parts, strict=True)]
    along = np.concatenate([*pieces, along[-1:]])
    found = postures(work, along, one.step, lane.sense, (lane.along, lane.postures.stand))
    stroke = MovingCuttingMove(work.face.evaluate(found.uv).point, found.ring.tip, found.normal, found.ring.axis)
    deeper = _rises(work, stroke, along)
    return replace(stroke, tip=stroke.tip - deeper[:, None] * stroke.normal)


def _rises(work: TwoPointInputs, stroke: MovingCuttingMove, along: Array) -> Array:
    """How deep points are set so that no straight motion between them stays above the pass, (n,) mm.

    As `toolaxis.path.chord_tolerance.rises`, but from how the poses bend at their neighbours: what tip and rim rise by.
    """
    if len(along) < 3:
        return np.zeros(len(along))
    gap = np.diff(along)
    tip, rim = _bends(stroke.tip, stroke.axis, gap, work.tool.radius)
    bend = (tip * stroke.normal[1:-1]).sum(axis=1) + np.linalg.norm(rim - tip, axis=1)
    bend = np.concatenate([bend[:1], bend, bend[-1:]])
    above = np.maximum(np.maximum(bend[1:], bend[:-1]), 0.0) * gap**2 / 8
    above = np.minimum(above, work.chord)  # corners of the way lie at points: between them there are none
    return np.asarray(np.maximum(np.append(above, 0.0), np.append(0.0, above)))


def _bends(tip: Array, axis: Array, gap: Array, radius: float) -> tuple[Array, Array]:
    """Second derivatives of the ways of tip and rim at all points but the first and the last, (n - 2, 3) each."""
    both = []
    for height in (0.0, radius):
        way = np.diff(tip + height * axis, axis=0) / gap[:, None]
        both.append(2 * np.diff(way, axis=0) / (gap[1:] + gap[:-1])[:, None])
    return both[0], both[1]


def _parts(work: TwoPointInputs, lane: PassPostures) -> NDArray[np.int64]:
    """Into how many parts the gaps around a posture must be cut, at all but the first and the last."""
    ring = lane.postures.ring
    gap = np.diff(lane.along)
    wider = np.maximum(gap[1:], gap[:-1])
    sag = np.zeros(len(gap) - 1)
    for height in (0.0, work.tool.radius):
        way = np.diff(ring.tip + height * ring.axis, axis=0) / gap[:, None]
        bend = 2 * np.linalg.norm(np.diff(way, axis=0), axis=1) / (gap[1:] + gap[:-1])
        sag = np.maximum(sag, bend * wider**2 / 8)
    behind = np.append(sag[1:], 0.0)
    before = np.append(0.0, sag[:-1])
    greatest = np.maximum(np.maximum(sag, behind), before)
    return np.asarray(np.clip(np.ceil(np.sqrt(greatest / work.chord)), 1, 12).astype(np.int64))


def _back(stroke: MovingCuttingMove) -> MovingCuttingMove:
    return MovingCuttingMove(stroke.contact[::-1], stroke.tip[::-1], stroke.normal[::-1], stroke.axis[::-1])
