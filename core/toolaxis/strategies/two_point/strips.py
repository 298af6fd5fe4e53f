"""Strips that a flat end leaves along iso-parametric passes, and the adjacent pass by [jang2021]'s iteration."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import SMALLER_ONE
from toolaxis.errors import InvalidInput
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.two_point.inputs import TwoPointInputs
from toolaxis.strategies.two_point.lean_field import strip_end
from toolaxis.strategies.two_point.postures import Postures, postures
from toolaxis.strategies.two_point.rings import FRONT, MIDDLE, SIDES

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Places along a face at which strips are measured, and the share of a step by which spacing may miss.
PLACES, CLOSE = 73, 2e-3
#: More passes than this are not made.
MOST = 2000
#: Ways to lean along a pass: towards its end, towards its begin, or away from a place on the pass to both ends.
LEANS = ("ahead", "back", "inward", "outward")


@dataclass(frozen=True, eq=False)
class PassPostures:
    """Postures along a whole pass that lean one way, and what they leave beside it.

    Attributes
    ----------
    sense : int
        1 where the axis leans towards growing parameter, -1 elsewhere.
    along : (k,) array
        Places of the postures, in growing order, beyond the face's ends too.
    postures : Postures
    halves : (t, 2) array
        Half widths towards lower and upper step parameter at the places of the face.
    reach : (t, 2) array
        First and last place along the pass at which the cutter works on the strip there.
    """

    sense: int
    along: Array
    postures: Postures
    halves: Array
    reach: Array


@dataclass(frozen=True, eq=False)
class Strip:
    """One pass and what it leaves.

    Attributes
    ----------
    step : float
    lanes : tuple of PassPostures
        One, or two that share the pass.
    turn : int
        Number of places of the face on which the first lane works.
    halves : (t, 2) array
    """

    step: float
    lanes: tuple[PassPostures, ...]
    turn: int
    halves: Array

    @property
    def shares(self) -> tuple[tuple[PassPostures, slice], ...]:
        """Each lane with the places on which it works."""
        number = len(self.halves)
        if len(self.lanes) == 1:
            return ((self.lanes[0], slice(0, number)),)
        first, second = self.lanes
        return ((first, slice(0, self.turn)), (second, slice(self.turn, number)))


def places(work: TwoPointInputs) -> Array:
    """Places along the face at which strips are measured, (t,).

    Parameters
    ----------
    work : TwoPointInputs
    """
    a0, a1, _, _ = work.span
    return np.linspace(a0, a1, PLACES)


def nodes(work: TwoPointInputs, step: float) -> Array:
    """Places along a pass at which postures are looked for, beyond the ends of the face as far as the ring is deep.

    Parameters
    ----------
    work : TwoPointInputs
    step : float
    """
    a0, a1, _, _ = work.span
    whole = a1 - a0
    d = work.face.evaluate(work.uv(np.array([a0, a1]), step))
    along = d.su if work.feed == "u" else d.sv
    speed = np.linalg.norm(along, axis=1)
    beyond = 0.45 * work.tool.flat_radius / np.maximum(speed, 1e-9 / whole)
    gap = whole / (PLACES - 1)
    before, after = (int(np.ceil(b / gap)) for b in np.minimum(beyond, whole))
    number = np.arange(-before, PLACES + after)
    return np.asarray(a0 + gap * number, dtype=float)


def lane(work: TwoPointInputs, step: float, sense: int, along: Array | None = None) -> PassPostures:
    """Postures along a pass and the half widths that they leave.

    Parameters
    ----------
    work : TwoPointInputs
    step : float
    sense : int
    along : (k,) array, optional
        Where postures are looked for, in growing order; `nodes` unless given.

    Notes
    -----
    Each point of the ring draws a line over the face as it moves; the lines of the front half together are what the
    pass leaves.  A half width ends where it first rises above the tolerance.
    """
    along = nodes(work, step) if along is None else along
    found = postures(work, along, step, sense)
    lines = _lines_of_ring(work, along, found)
    right_side, left_side = SIDES
    one_end, one_number = strip_end(work.scallop, (lines.across, lines.height), right_side)
    other_end, other_number = strip_end(work.scallop, (lines.across, lines.height), left_side)
    halves = np.abs(np.stack([one_end, other_end], axis=1) - step)
    if np.nanmean(one_end - other_end) > 0:
        halves = halves[:, ::-1]
    first = MIDDLE - one_number
    last = MIDDLE + other_number
    number = np.arange(len(FRONT))
    worked = (number >= first[:, None]) & (number <= last[:, None])
    earliest = np.nanmin(np.where(worked, lines.came, np.inf), axis=1)
    latest = np.nanmax(np.where(worked, lines.came, -np.inf), axis=1)
    reach = np.stack([earliest, latest], axis=1)
    return PassPostures(sense, along, found, np.nan_to_num(halves), reach)


class _RingLines(NamedTuple):
    """Lines that the points of the ring's front half draw, at the places of the face, (t, k) each: step parameter,
    height, and where along the pass the cutter draws them; nan where a line does not come."""

    across: Array
    height: Array
    came: Array


def _lines_of_ring(work: TwoPointInputs, along: Array, found: Postures) -> _RingLines:
    """The lines of a pass."""
    uv = found.ring.uv[:, FRONT]
    ahead = uv[..., work.column]
    beside = uv[..., 1 - work.column]
    height = found.ring.height[:, FRONT]
    everywhere = np.broadcast_to(along[:, None], height.shape)
    targets = places(work)
    shape = (len(targets), len(FRONT))
    lines = _RingLines(np.full(shape, np.nan), np.full(shape, np.nan), np.full(shape, np.nan))
    for j in range(len(FRONT)):
        # A line that turns back is followed as long as it goes on.
        farthest = np.maximum.accumulate(ahead[:-1, j])
        on = np.concatenate([[True], ahead[1:, j] > farthest])
        x = ahead[on, j]
        inside = (targets >= x[0]) & (targets <= x[-1])
        for rows, out in zip((beside, height, everywhere), lines, strict=True):
            out[inside, j] = np.interp(targets[inside], x, rows[on, j])
    return lines


def strip(work: TwoPointInputs, step: float, leaning: str = "ahead") -> Strip:
    """One pass, leaning one of `LEANS`.

    Parameters
    ----------
    work : TwoPointInputs
    step : float
    leaning : str

    Notes
    -----
    Where the lean changes along a pass, it does so where the narrowest place of the strip is widest.
    """
    if leaning in ("ahead", "back"):
        one = lane(work, step, 1 if leaning == "ahead" else -1)
        return Strip(step, (one,), len(one.halves), one.halves)
    begin = 1 if leaning == "inward" else -1
    first = lane(work, step, begin)
    second = lane(work, step, -begin)
    wide_first = first.halves.sum(axis=1)
    wide_second = second.halves.sum(axis=1)
    low = np.minimum.accumulate(np.concatenate([[np.inf], wide_first]))
    high = np.minimum.accumulate(np.concatenate([[np.inf], wide_second[::-1]]))[::-1]
    turn = int(np.argmax(np.minimum(low, high)))
    if turn in (0, len(wide_first)):
        one = second if turn == 0 else first
        return Strip(step, (one,), len(one.halves), one.halves)
    halves = np.concatenate([first.halves[:turn], second.halves[turn:]])
    return Strip(step, (first, second), turn, halves)


def left_out(found: Strip) -> Bools:
    """Places of a strip at which the cutter does not come within the tolerance, (t,).

    Parameters
    ----------
    found : Strip
    """
    return np.asarray(found.halves.sum(axis=1) <= 0)


def next_strip(work: TwoPointInputs, covered: Array, guess: float, leaning: str) -> Strip:
    """The strip farthest on that leaves nothing between itself and what is covered.

    Parameters
    ----------
    work : TwoPointInputs
    covered : (t,) array
        Up to which step parameter the face is covered at its places.
    guess : float
        Lower half width to start with, in units of the step parameter.
    leaning : str

    Notes
    -----
    The first guess takes the known strip for the distance of the passes, the following ones its half and the half of
    the strip at the place found, until both meet.

    **Source**: [jang2021] Eq. (11), then Eq. (12), iterated.
    """
    *_, s0, s1 = work.span
    close = CLOSE * (s1 - s0)
    step = float(covered.min()) + guess
    best: Strip | None = None
    for _ in range(12):
        found = strip(work, min(step, s1), leaning)
        ok = ~left_out(found)
        if not ok.any():
            raise InvalidInput(f"the cutter comes within the tolerance nowhere along a pass: {SMALLER_ONE}, or "
                               "another feed")
        lower_ends = covered + found.halves[:, 0]
        ahead = float(lower_ends[ok].min())
        spare = ahead - found.step
        if spare >= 0 and (best is None or found.step > best.step):
            best = found
        if 0 <= spare <= close or (spare > 0 and found.step >= s1):
            return found
        step = ahead
        if spare <= 0:
            step = ahead - 0.25 * CLOSE * (s1 - s0)
    if best is None:
        raise InvalidInput("passes cannot be placed: no strip meets what is covered; take a smaller step of the "
                           "surface, or another feed")
    return best


def lay_strips(work: TwoPointInputs, leaning: str = "ahead", progress: Progress = NO_PROGRESS) -> tuple[Strip, ...]:
    """Passes over a whole face, each as far from the one before as both their strips allow.

    Parameters
    ----------
    work : TwoPointInputs
    leaning : str
        One of `LEANS`.
    progress : Progress

    Raises
    ------
    InvalidInput
        When the cutter comes within the tolerance nowhere along a pass, or passes are far too many.
    """
    *_, s0, s1 = work.span
    width = s1 - s0
    covered = np.full(PLACES, s0)
    found: list[Strip] = []
    guess = 0.0
    while True:
        done = min(covered.min(), s1) - s0
        progress.report("passes", int(1000 * done / width), 1000)
        one = next_strip(work, covered, guess, leaning)
        stands = bool(found) and one.step <= found[-1].step + 1e-6 * width
        if stands or len(found) >= MOST:
            raise InvalidInput("strips are too narrow to place passes: the cutter does not fit the surface; "
                               f"{SMALLER_ONE}, or another feed")
        found.append(one)
        ok = ~left_out(one)
        upper_ends = one.step + one.halves[:, 1]
        covered = np.maximum(covered, np.where(ok, upper_ends, one.step))
        guess = float(one.halves[ok].sum(axis=1).min()) / 2
        if (covered[ok] >= s1 - 1e-9 * width).all():
            return tuple(found)
