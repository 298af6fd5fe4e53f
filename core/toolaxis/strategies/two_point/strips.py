"""Strips that a flat end leaves along iso-parametric passes, and the adjacent pass by [jang2021]'s iteration."""

from dataclasses import dataclass

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
        if len(self.lanes) == 1:
            return ((self.lanes[0], slice(0, len(self.halves))),)
        return ((self.lanes[0], slice(0, self.turn)), (self.lanes[1], slice(self.turn, len(self.halves))))


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
    d = work.face.evaluate(work.uv(np.array([a0, a1]), step))
    speed = np.linalg.norm(d.su if work.feed == "u" else d.sv, axis=1)
    beyond = 0.45 * work.tool.flat_radius / np.maximum(speed, 1e-9 / (a1 - a0))
    gap = (a1 - a0) / (PLACES - 1)
    before, after = (int(np.ceil(b / gap)) for b in np.minimum(beyond, a1 - a0))
    return np.asarray(a0 + gap * np.arange(-before, PLACES + after), dtype=float)


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
    uv = found.ring.uv[:, FRONT]
    ahead, beside = uv[..., work.column], uv[..., 1 - work.column]
    lines, targets = found.ring.height[:, FRONT], places(work)
    across, height, came = (np.full((len(targets), len(FRONT)), np.nan) for _ in range(3))
    for j in range(len(FRONT)):
        # A line that turns back is followed as long as it goes on.
        on = np.concatenate([[True], ahead[1:, j] > np.maximum.accumulate(ahead[:-1, j])])
        x = ahead[on, j]
        inside = (targets >= x[0]) & (targets <= x[-1])
        for rows, out in ((beside, across), (lines, height), (np.broadcast_to(along[:, None], lines.shape), came)):
            out[inside, j] = np.interp(targets[inside], x, rows[on, j])
    ends = [strip_end(work.scallop, (across, height), columns) for columns in SIDES]
    halves = np.abs(np.stack([end[0] for end in ends], axis=1) - step)
    if np.nanmean(ends[0][0] - ends[1][0]) > 0:
        halves = halves[:, ::-1]
    first, last = MIDDLE - ends[0][1], MIDDLE + ends[1][1]
    number = np.arange(len(FRONT))
    worked = (number >= first[:, None]) & (number <= last[:, None])
    reach = np.stack([np.nanmin(np.where(worked, came, np.inf), axis=1), np.nanmax(np.where(worked, came, -np.inf),
                                                                                   axis=1)], axis=1)
    return PassPostures(sense, along, found, np.nan_to_num(halves), reach)


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
    first, second = (lane(work, step, sense) for sense in ((1, -1) if leaning == "inward" else (-1, 1)))
    wide = [one.halves.sum(axis=1) for one in (first, second)]
    low = np.minimum.accumulate(np.concatenate([[np.inf], wide[0]]))
    high = np.minimum.accumulate(np.concatenate([[np.inf], wide[1][::-1]]))[::-1]
    least = np.minimum(low, high)
    turn = int(np.argmax(least))
    if turn in (0, len(wide[0])):
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
    step = float(covered.min()) + guess
    low, best = None, None
    for _ in range(12):
        found = strip(work, min(step, s1), leaning)
        ok = ~left_out(found)
        if not ok.any():
            raise InvalidInput(f"the cutter comes within the tolerance nowhere along a pass: {SMALLER_ONE}, or "
                               "another feed")
        ahead = float((covered + found.halves[:, 0])[ok].min())
        spare = ahead - found.step
        if spare >= 0 and (low is None or found.step > low):
            low, best = found.step, found
        if 0 <= spare <= CLOSE * (s1 - s0) or (spare > 0 and found.step >= s1):
            return found
        step = ahead - (0.0 if spare > 0 else 0.25 * CLOSE * (s1 - s0))
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
    covered, found = np.full(PLACES, s0), list[Strip]()
    guess = 0.0
    while True:
        progress.report("passes", int(1000 * (min(covered.min(), s1) - s0) / (s1 - s0)), 1000)
        one = next_strip(work, covered, guess, leaning)
        if (found and one.step <= found[-1].step + 1e-6 * (s1 - s0)) or len(found) >= MOST:
            raise InvalidInput("strips are too narrow to place passes: the cutter does not fit the surface; "
                               f"{SMALLER_ONE}, or another feed")
        found.append(one)
        ok = ~left_out(one)
        covered = np.maximum(covered, np.where(ok, one.step + one.halves[:, 1], one.step))
        guess = float(one.halves[ok].sum(axis=1).min()) / 2
        if (covered[ok] >= s1 - 1e-9 * (s1 - s0)).all():
            return tuple(found)
