"""A pass whose orientations keep strip width and roughness: what is asked of them, and where to begin.

At every place of a pass the cutter must not gouge by curvature, its section strip width must lie in a range, and what
the cutter sweeps must be flat enough across the feed that scallops between neighbouring passes keep the roughness.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import SMALLER_CUTTER
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.placement import tips
from toolaxis.contact.strip.cutter_parameters import cutter_parameters
from toolaxis.contact.strip.scallop import RA_SHARE
from toolaxis.contact.strip.second_order import contact_forms, relative_forms
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.kinematics import tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.rotary_spline import RotarySpline, basis, even_knots
from toolaxis.strategies.roughness.section_width import Sections, sections
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: What is asked of an orientation, in the order of `Lane.margins`.
CONDITIONS = ("it gouges by curvature", "its strip is narrower than expected", "its strip is wider than expected",
              "its scallops are rougher than allowed", "it leans too little", "it leans too much")
GOUGE, NARROW, WIDE, ROUGH, UPRIGHT, LEANING = range(6)
#: Greatest lean, rad, and the least, where no other is given.
MOST_LEAN, LEAST_LEAN = np.radians(60.0), np.radians(0.5)
#: Leans and directions, rad, among which a way to begin is looked for.
_LEANS, DIRECTIONS = 60, (0.0, 0.4, -0.4, 0.8, -0.8, 1.3, -1.3, np.pi)
#: A margin that binds nothing, and the turn that tells the slopes of margins, rad.
_FREE, _PROBE = 1e3, 1e-5


@dataclass(frozen=True)
class OrientationRequirements:
    """What is asked of orientations along passes; lengths in mm.

    Attributes
    ----------
    scallop : float
        Height at which the section strip width is taken.
    widths : (float, float)
        Range of the section strip width.
    roughness : float
        Greatest Ra across the feed; infinite where it does not matter.
    leans : (float, float)
        Least and greatest angle between axis and normal, rad.

    Raises
    ------
    InvalidInput
        When a range is empty or the roughness is not above zero.
    """

    scallop: float
    widths: tuple[float, float]
    roughness: float
    leans: tuple[float, float] = (LEAST_LEAN, MOST_LEAN)

    def __post_init__(self) -> None:
        for name, (low, high) in (("strip width", self.widths), ("lean", self.leans)):
            if not 0 <= low < high:
                raise InvalidInput(f"range of the {name} is {low} to {high}: the lower one comes first, not below zero")
        if not self.roughness > 0:
            raise InvalidInput(f"roughness is {1000 * self.roughness:g} um: it must be above zero")


@dataclass(frozen=True, eq=False)
class PassConstraints:
    """A pass whose rotary axes are sought.

    Attributes
    ----------
    face, tool, machine
    turn : (3, 3) array
        From the part's directions to the table's.
    wish : OrientationRequirements
    feed : str
        "u" or "v".
    places : (n,) array
        Values of the along parameter, growing.
    uv : (n, 2) array
    inside : (n,) array of bool
        Where strips count: not where the pass runs out beyond the face.
    apart : (n,) array
        Greater distance to the neighbouring passes, mm; 0 where there is none.
    floor : (n,) array
        Least lean, rad.
    speed : float
        Feed rate, mm/s.
    knots : (c + 4,) array
    allowance : float
        mm
    paced : bool
        Whether rotary axes must keep their velocities at the feed rate too.
    """

    face: Face
    tool: Tool
    machine: Machine
    turn: Array
    wish: OrientationRequirements
    feed: str
    places: Array
    uv: Array
    inside: Bools
    apart: Array
    floor: Array
    speed: float
    knots: Array
    allowance: float = 0.0
    paced: bool = False

    @cached_property
    def forms(self) -> Array:
        """Frames and curvatures as `contact_forms` gives."""
        return contact_forms(self.face, self.uv, self.feed, False)

    @cached_property
    def bench(self) -> Sections:
        """What section strip widths are measured on."""
        return sections(self.face, self.tool, self.uv, self.wish.scallop, self.feed, self.allowance,
                        1.2 * self.wish.widths[1])

    @cached_property
    def durations(self) -> Array:
        """Times between places, (n - 1,) s."""
        point = self.bench.point
        return np.asarray(np.linalg.norm(np.diff(point, axis=0), axis=1) / self.speed)

    @cached_property
    def values(self) -> Array:
        """Basis functions at the places, (n, c)."""
        return basis(self.knots, self.places)

    @cached_property
    def sharpest(self) -> Array:
        """Greatest relative curvature across the feed of what is swept, 1/mm, that keeps the roughness, (n,)."""
        with np.errstate(divide="ignore"):
            most = 8 * self.wish.roughness / (RA_SHARE * self.apart**2)
        return np.where(self.inside, most, np.inf)

    def axes(self, control: Array) -> Array:
        """Unit axes on the part at the places, (n, 3).

        Parameters
        ----------
        control : (c, 2) array
        """
        return np.asarray(tool_axes(self.machine, self.values @ control) @ self.turn)

    def swept(self, axis: Array) -> tuple[Array, Array]:
        """Relative curvature across the feed of what is swept, and the least relative one in any plane, 1/mm, (n,).

        Parameters
        ----------
        axis : (n, 3) array
        """
        cutter = cutter_parameters(self.tool, self.wish.scallop, self.allowance)
        feed, left = self.forms[:, 0:3], self.forms[:, 3:6]
        along_feed = (axis * feed).sum(axis=1)
        along_left = (axis * left).sum(axis=1)
        ff, fk, kk = relative_forms(self.forms, (along_feed, along_left), cutter)
        least = (ff + kk) / 2 - np.hypot((ff - kk) / 2, fk)
        swept = kk - fk**2 / np.maximum(ff, 1e-3 / self.tool.radius)
        return swept, least

    def leans(self, axis: Array) -> Array:
        """Angles between axis and normal, (n,) rad.

        Parameters
        ----------
        axis : (n, 3) array
        """
        normal = self.forms[:, 6:9]
        across = np.linalg.norm(np.cross(axis, normal), axis=1)
        return np.asarray(np.arctan2(across, (axis * normal).sum(axis=1)))

    def widths(self, axis: Array) -> Array:
        """Section strip widths, (n,) mm.

        Parameters
        ----------
        axis : (n, 3) array
        """
        return np.asarray(self.bench.widths(axis).sum(axis=1))

    def roughness(self, axis: Array) -> Array:
        """Ra of parabolic scallops as high as the greater distance to a neighbour makes them, (n,) mm.

        Parameters
        ----------
        axis : (n, 3) array
        """
        return np.asarray(RA_SHARE * self.apart**2 * np.maximum(self.swept(axis)[0], 0.0) / 8)

    def margins(self, axis: Array) -> Array:
        """What is left of each of `CONDITIONS`, (n, 6), each in a unit of its own; negative where it is not kept.

        Parameters
        ----------
        axis : (n, 3) array
        """
        low, high = self.wish.widths
        scale = (high - low) / 2
        wide, lean = self.widths(axis), self.leans(axis)
        across, least = self.swept(axis)
        with np.errstate(invalid="ignore"):
            rough = np.where(np.isfinite(self.sharpest), 1 - across / self.sharpest, _FREE)
        rows = np.stack([least * self.tool.radius, (wide - low) / scale, (high - wide) / scale, rough,
                         10 * (lean - self.floor), 10 * (self.wish.leans[1] - lean)], axis=1)
        rows[~self.inside, NARROW:ROUGH + 1] = _FREE
        return rows

    def slopes(self, control: Array) -> Array:
        """How margins change with the rotary angles, (n, 6, 2) 1/rad.

        Parameters
        ----------
        control : (c, 2) array
        """
        angles = self.values @ control
        found = []
        for i in range(angles.shape[1]):
            probe = _PROBE * np.eye(angles.shape[1])[i]
            ahead, behind = (self.margins(tool_axes(self.machine, angles + s * probe) @ self.turn) for s in (1, -1))
            found.append((ahead - behind) / (2 * _PROBE))
        return np.stack(found, axis=2)


def leaning(lane: PassConstraints, lean: Array, direction: float = 0.0) -> Array:
    """Axes that lean in a direction from the feed, (n, 3).

    Parameters
    ----------
    lane : PassConstraints
    lean : (n,) array
        rad
    direction : float
        rad, from the feed to the left.
    """
    f, k, n = (lane.forms[:, 3 * c:3 * c + 3] for c in range(3))
    a = np.broadcast_to(np.asarray(lean, dtype=float), len(f))[:, None]
    return np.asarray(np.cos(a) * n + np.sin(a) * (np.cos(direction) * f + np.sin(direction) * k))


def windows(lane: PassConstraints, direction: float = 0.0) -> tuple[Array, Bools]:
    """Leans from the least to the greatest, (k,), and at which of them each place keeps all conditions, (k, n).

    Parameters
    ----------
    lane : PassConstraints
    direction : float
        rad
    """
    lean = np.linspace(*lane.wish.leans, _LEANS)
    return lean, np.array([(lane.margins(leaning(lane, one, direction)) >= 0).all(axis=1) for one in lean])


def best_roughness(lane: PassConstraints) -> Array:
    """The least Ra that each place can have while it keeps all else, (n,) mm; inf where it cannot.

    Parameters
    ----------
    lane : PassConstraints
    """
    best = np.full(len(lane.places), np.inf)
    for direction in DIRECTIONS:
        for one in np.linspace(*lane.wish.leans, _LEANS):
            axis = leaning(lane, one, direction)
            rows = lane.margins(axis)
            rows[:, ROUGH] = _FREE
            best = np.where((rows >= 0).all(axis=1), np.minimum(best, lane.roughness(axis)), best)
    return best


def beginnings(lane: PassConstraints) -> list[RotarySpline]:
    """Splines to begin with, each near a lean in one direction that keeps what it can; the one that turns least first.

    Parameters
    ----------
    lane : PassConstraints

    Raises
    ------
    InvalidInput
        When some place has no orientation, with the best Ra that it can have; or the machine can follow none.
    """
    free = np.zeros(len(lane.places), dtype=bool)
    found, why = [], ""
    for direction in DIRECTIONS:
        lean, kept = windows(lane, direction)
        free |= kept.any(axis=0)
        for common in np.unique(_common(lean, kept)):
            off = np.where(kept, np.abs(lean[:, None] - common), np.inf)
            nearest = np.where(kept.any(axis=0), lean[off.argmin(axis=0)], common)
            try:
                found.append(spline_along_axes(lane, leaning(lane, nearest, direction)))
            except InvalidInput as reason:
                why = why or str(reason)
        if free.all() and found and direction != DIRECTIONS[0]:
            break
    if not free.all():
        raise InvalidInput(_impossible(lane, int(np.argmin(free))))
    if not found:
        raise InvalidInput(why)
    return sorted(found, key=lambda one: one.cost(lane.places, lane.durations))


def _common(lean: Array, kept: Bools) -> Array:
    """Leans that most places can have: the least, the middle and the greatest of them."""
    count = kept.sum(axis=1)
    most = lean[count >= 0.98 * count.max()] if count.any() else lean[:0]
    return most[[0, len(most) // 2, -1]] if len(most) else most


def _impossible(lane: PassConstraints, k: int) -> str:
    best = best_roughness(lane)
    where = np.round(lane.bench.point[k], 2).tolist()
    if np.isfinite(best[k]) and best[k] > lane.wish.roughness:
        worst = float(best[np.isfinite(best)].max())
        return (f"Ra {1000 * lane.wish.roughness:.3g} um is asked for, and near {where} passes {lane.apart[k]:.3g} mm "
                f"apart leave {1000 * best[k]:.3g} um at best ({1000 * worst:.3g} um along the pass) with strips of "
                f"{lane.wish.widths[0]:.3g} to {lane.wish.widths[1]:.3g} mm: lay passes closer, allow wider strips, or "
                "take a larger cutter")
    return (f"no orientation near {where} of face {lane.face.label} is free of gouging with a strip of "
            f"{lane.wish.widths[0]:.3g} to {lane.wish.widths[1]:.3g} mm: take {SMALLER_CUTTER}, or another range")


def spline_along_axes(lane: PassConstraints, axes: Array) -> RotarySpline:
    """The spline nearest to the rotary angles that take axes at the places without a jump.

    Parameters
    ----------
    lane : PassConstraints
    axes : (n, 3) array

    Raises
    ------
    InvalidInput
        When the machine cannot follow them.
    """
    count = len(axes)
    place = np.eye(4)
    place[:3, :3] = lane.turn
    tip = tips(lane.bench.point, lane.bench.normal, axes, lane.tool, lane.allowance)
    path = ToolPath(lane.bench.point, tip, axes, lane.bench.normal, np.full(count, Motion.CUT, dtype=np.int8),
                    np.array([0, count], dtype=np.int64))
    along = following(lane.machine, path, place)
    last = np.searchsorted(along.arrival, np.arange(count), side="right") - 1
    return RotarySpline(lane.knots, np.asarray(np.linalg.lstsq(lane.values, along.rotary[last], rcond=None)[0]))


def knots_of(places: Array, count: int | None = None) -> Array:
    """Even knots over places: one gap for about every third place, unless a number of coefficients is given.

    Parameters
    ----------
    places : (n,) array
    count : int, optional
    """
    return even_knots(float(places[0]), float(places[-1]), count or max(10, len(places) // 3))
