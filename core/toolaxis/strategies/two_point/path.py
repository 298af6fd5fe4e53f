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
        if direction == "zigzag":
            onward = number % 2 == 0
        else:
            onward = climbs == (direction == "climb")
        pieces = _strokes_of_strip(work, one)
        if not onward:
            pieces = [_back(piece) for piece in reversed(pieces)]
        if pieces:
            found.append(pieces)
    return found


def _strokes_of_strip(work: TwoPointInputs, one: Strip) -> list[MovingCuttingMove]:
    """Cutting motions of one pass, all in growing parameter."""
    pieces = []
    for lane, where in one.shares:
        spans = _spans(work, one, lane, where)
        pieces += [_stroke(work, one, lane, span) for span in spans]
    return pieces


def _climbs(work: TwoPointInputs) -> bool:
    """Whether travel in growing parameter climbs: passes proceed in growing step parameter, where material is left."""
    a0, a1, s0, s1 = work.span
    middle = np.array([(a0 + a1) / 2])
    uv = work.uv(middle, (s0 + s1) / 2)
    d = work.face.evaluate(uv)
    normal = work.face.normal(uv)[0]
    along = d.su[0]
    across = d.sv[0]
    if work.feed == "v":
        along, across = across, along
    leftwards = np.cross(along, normal)
    return bool(leftwards @ across >= 0)


def _spans(work: TwoPointInputs, one: Strip, lane: PassPostures, where: slice) -> list[tuple[float, float]]:
    """From where to where along a pass a lane works: as far as its strip holds some of the face."""
    on = _meets_face(work, one) & ~left_out(one)
    on[1:-1] |= on[2:] | on[:-2]
    own = np.zeros(len(on), dtype=bool)
    own[where] = True
    works = (on & own).astype(int)
    padded = np.concatenate([[0], works, [0]])
    changes = np.flatnonzero(np.diff(padded))
    found = []
    for first, after in changes.reshape(-1, 2):
        begin = max(first - 1, 0)
        reach = lane.reach[begin:after + 1]
        is_known = np.isfinite(reach).all(axis=1)
        reach = reach[is_known]
        if not len(reach):
            continue
        low = reach[:, 0].min()
        high = reach[:, 1].max()
        if high > low:
            found.append((float(low), float(high)))
    return found


def _meets_face(work: TwoPointInputs, one: Strip) -> Bools:
    """At which places along a pass its strip holds some of the face."""
    along = places(work)
    low = one.step - one.halves[:, 0]
    high = one.step + one.halves[:, 1]
    share = np.linspace(0.0, 1.0, _ACROSS)
    width = high - low
    steps = low[:, None] + width[:, None] * share
    steps = np.clip(steps, *work.span[2:])
    everywhere = np.broadcast_to(along[:, None], steps.shape)
    pair = np.stack([everywhere, steps], axis=-1).reshape(-1, 2)
    if work.feed == "v":
        pair = pair[:, ::-1]
    inside = work.face.contains(pair)
    return np.asarray(inside.reshape(steps.shape).any(axis=1))


def _stroke(work: TwoPointInputs, one: Strip, lane: PassPostures, span: tuple[float, float]) -> MovingCuttingMove:
    """Points of a pass, so close that straight motions keep the chord tolerance, at tip, rim and twice that high."""
    along = _places_of_stroke(work, lane, span)
    found = postures(work, along, one.step, lane.sense, (lane.along, lane.postures.stand))
    contact = work.face.evaluate(found.uv).point
    stroke = MovingCuttingMove(contact, found.ring.tip, found.normal, found.ring.axis)
    deeper = _rises(work, stroke, along)
    lowered = stroke.tip - deeper[:, None] * stroke.normal
    return replace(stroke, tip=lowered)


def _places_of_stroke(work: TwoPointInputs, lane: PassPostures, span: tuple[float, float]) -> Array:
    """Along parameters of a stroke's points: those of its postures, and as many between them as the chord asks for."""
    begin, end = span
    on = (lane.along >= begin) & (lane.along <= end)
    along = np.concatenate([[begin], lane.along[on], [end]])
    along = np.unique(along)
    # An end may lie beside a posture by the last digit: points there would coincide, and have no way between them.
    is_apart = np.diff(along) > _SAME * (end - begin)
    along = along[np.append(is_apart, True)]
    middles = (along[1:] + along[:-1]) / 2
    parts = np.interp(middles, lane.along[1:-1], _parts(work, lane))
    parts = parts.round().astype(np.int64)
    pieces = []
    for (low, high), number in zip(pairwise(along), parts, strict=True):
        pieces.append(np.linspace(low, high, number, endpoint=False))
    return np.concatenate([*pieces, along[-1:]])


def _rises(work: TwoPointInputs, stroke: MovingCuttingMove, along: Array) -> Array:
    """How deep points are set so that no straight motion between them stays above the pass, (n,) mm.

    As `toolaxis.path.chord_tolerance.rises`, but from how the poses bend at their neighbours: what tip and rim rise by.
    """
    if len(along) < 3:
        return np.zeros(len(along))
    gap = np.diff(along)
    tip = _second_derivative(stroke.tip, gap)
    rim = _second_derivative(stroke.tip + work.tool.radius * stroke.axis, gap)
    inward = (tip * stroke.normal[1:-1]).sum(axis=1)
    bend = inward + np.linalg.norm(rim - tip, axis=1)
    bend = np.concatenate([bend[:1], bend, bend[-1:]])
    sharper = np.maximum(bend[1:], bend[:-1])
    above = np.maximum(sharper, 0.0) * gap**2 / 8
    above = np.minimum(above, work.chord)  # corners of the way lie at points: between them there are none
    before = np.append(0.0, above)
    behind = np.append(above, 0.0)
    return np.asarray(np.maximum(behind, before))


def _second_derivative(points: Array, gap: Array) -> Array:
    """How a way of points bends at all of them but the first and the last, (n - 2, 3)."""
    speed = np.diff(points, axis=0) / gap[:, None]
    change = 2 * np.diff(speed, axis=0)
    between = gap[1:] + gap[:-1]
    return np.asarray(change / between[:, None])


def _parts(work: TwoPointInputs, lane: PassPostures) -> NDArray[np.int64]:
    """Into how many parts the gaps around a posture must be cut, at all but the first and the last."""
    ring = lane.postures.ring
    gap = np.diff(lane.along)
    wider = np.maximum(gap[1:], gap[:-1])
    between = gap[1:] + gap[:-1]
    sag = np.zeros(len(gap) - 1)
    for height in (0.0, work.tool.radius):
        points = ring.tip + height * ring.axis
        speed = np.diff(points, axis=0) / gap[:, None]
        change = np.linalg.norm(np.diff(speed, axis=0), axis=1)
        bend = 2 * change / between
        sag = np.maximum(sag, bend * wider**2 / 8)
    behind = np.append(sag[1:], 0.0)
    before = np.append(0.0, sag[:-1])
    greatest = np.maximum(sag, behind)
    greatest = np.maximum(greatest, before)
    parts = np.ceil(np.sqrt(greatest / work.chord))
    return np.asarray(np.clip(parts, 1, 12).astype(np.int64))


def _back(stroke: MovingCuttingMove) -> MovingCuttingMove:
    contact = stroke.contact[::-1]
    tip = stroke.tip[::-1]
    normal = stroke.normal[::-1]
    axis = stroke.axis[::-1]
    return MovingCuttingMove(contact, tip, normal, axis)
