"""What an axis is worth: passes and cutting length of a face, screened or counted exactly."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.path.estimate import Estimates, Estimator
from toolaxis.path.field.direction_table import tabulate_directions
from toolaxis.path.parametrization import Cut
from toolaxis.path.pass_count import Count
from toolaxis.path.pass_pattern import PassPattern, patterns_of
from toolaxis.path.sampling import Samples
from toolaxis.plan.choices import FEEDS, ISO, PLANES
from toolaxis.search.time_estimate import TimeEstimate
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool
from toolaxis.work import OutOfWork

Array = NDArray[np.float64]

OBJECTIVES = ("length", "passes", "time")
#: What a mm of the clean-up tool's passes is worth in mm of this tool's: a ball a quarter as large takes about half the
#: feed rate.  With 3, the example with one boss took a fifth more cutting length for a tenth less to clean up, dearer
#: even by that measure; with 1, a narrow strip of this tool costs no more than the clean-up tool's, which comes with a
#: seam, so that reachable area would be left.
CLEAN_UP = 2.0
#: What is too little to be searched for: cutting length, mm, and time, s; as a share of the value not less than the
#: first and not more than the second.
_LITTLE, _LITTLE_TIME, _SHARES = 1.5, 0.1, (5e-5, 3e-4)
#: The same where axes are indexed: as a share of an index move, and of the value not more than the second.
_LITTLE_OF_INDEX, _MOST_OF_INDEX = 1 / 6, 0.003
#: Places each way from which the ideal length of an axis is told.
_IDEAL = 16


@dataclass(frozen=True, eq=False)
class MachiningCost:
    """The price of machining a face with a tool.

    Attributes
    ----------
    face : Face
    tool : Tool
    scallop : float
        Scallop height, mm.
    allowance : float
        Stock left on the face, mm.
    objective : str
        "length", "passes" or "time": what is to be least.
    pace : TimeEstimate, optional
        How fast the machine goes; needed for the objective "time".
    feed : "u" or "v", optional
        The only feed that may be chosen, where one is asked for.
    passes : str
        One of `toolaxis.plan.choices.PASSES`.
    greatest_step_over : float
        Greatest distance of neighbouring passes, mm; infinite for none.
    index_length : float
        Length of a cut that takes as long as an index move, mm: where more axes than one are indexed, less than a
        small part of it is not worth a search.  0 where the best axis is to be found in any case.

    Raises
    ------
    InvalidInput
        When the objective is none of these or lacks a pace, or scallop or allowance are out of range.
    """

    face: Face
    tool: Tool
    scallop: float
    allowance: float = 0.0
    objective: str = "length"
    pace: TimeEstimate | None = None
    feed: str | None = None
    passes: str = ISO
    greatest_step_over: float = np.inf
    index_length: float = 0.0
    _of_ball: dict[tuple[str, str], Count] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        if self.objective == "time" and self.pace is None:
            raise InvalidInput("objective 'time' needs a machine with known limits and a feed: give both")
        if self.objective not in OBJECTIVES:
            raise InvalidInput(f"objective is {self.objective!r}: it must be one of {', '.join(OBJECTIVES)}")
        Cut(self.tool, np.array([0.0, 0.0, 1.0]), self.scallop, self.allowance, self.greatest_step_over)

    @property
    def timed(self) -> TimeEstimate | None:
        """The pace where the least time is asked for; None for other objectives."""
        return self.pace if self.objective == "time" else None

    @cached_property
    def estimator(self) -> Estimator:
        """The face made ready for estimates with many axes."""
        return Estimator.of(self.face, self.tool, self.scallop, self.allowance,
                            greatest_step_over=self.greatest_step_over)

    @cached_property
    def patterns(self) -> tuple[PassPattern, ...]:
        """The patterns of passes of which the shortest is taken."""
        return patterns_of(self.estimator, self.passes)

    def cut(self, axis: Array) -> Cut:
        """What cuts with an axis.

        Parameters
        ----------
        axis : (3,) array
        """
        made = Cut(self.tool, axis, self.scallop, self.allowance, self.greatest_step_over)
        made.__dict__["leans"] = self.estimator.leans
        return made

    def ideal_length(self, axis: Array) -> float:
        """What passes with an axis tend to as the scallop height goes to zero, mm; 0 where it is not known, as where
        the axis leaves no strip at one of the places that are looked at, or the work that is allowed does not suffice.

        Parameters
        ----------
        axis : (3,) array
        """
        try:
            table = tabulate_directions(self.face, self.cut(axis), _IDEAL, only_inside=True)
            return table.ideal_length if table.cut_everywhere else 0.0
        except (OutOfWork, UnsupportedGeometry):
            return 0.0

    @property
    def samples(self) -> Samples:
        """Sample points of the face."""
        return self.estimator.samples

    def screen(self, axes: Array) -> Estimates:
        """Passes and length of axes in both feed directions, from second-order widths corrected for the lean.

        Parameters
        ----------
        axes : (k, 3) array
            Unit vectors.
        """
        found = [pattern.screen(axes) for pattern in self.patterns]
        best = np.argmin([one.length for one in found], axis=0)[None]
        passes, length = (np.take_along_axis(np.array(values), best, axis=0)[0]
                          for values in ([one.passes for one in found], [one.length for one in found]))
        return Estimates(passes, length)

    def values(self, axes: Array, found: Estimates) -> Array:
        """What is to be least for axes in both feed directions, (k, 2).

        Parameters
        ----------
        axes : (k, 3) array
        found : Estimates
            Their passes and lengths.
        """
        if self.objective == "time":
            assert self.pace is not None
            values = self.pace.seconds(axes, found.passes, found.length)
        else:
            values = found.length if self.objective == "length" else found.passes
        return values if self.feed is None else np.where(np.array(FEEDS) == self.feed, values, np.inf)

    def value(self, axis: Array, feed: int, passes: float, length: float) -> float:
        """What is to be least for one axis and feed.

        Parameters
        ----------
        axis : (3,) array
        feed : int
            Index in `FEEDS`.
        passes, length : float
        """
        if self.objective == "time":
            assert self.pace is not None
            return float(self.pace.seconds(axis[None], np.array([[passes] * 2]), np.array([[length] * 2]))[0, feed])
        return length if self.objective == "length" else passes

    def counted(self, axis: Array, feed: str) -> tuple[float, float]:
        """Exact count of passes and cutting length, mm, of one axis and feed; inf where it leaves no strip, or passes
        of this kind do not go with the face.

        Parameters
        ----------
        axis : (3,) array
        feed : str
        """
        found = min((self._count(pattern, axis, feed) for pattern in self.patterns), key=lambda one: one.length)
        return found.passes, found.length

    def weighed(self, axis: Array, feed: str) -> Count:
        """The count told from fewer places; infinite where that is not possible.

        Parameters
        ----------
        axis : (3,) array
        feed : str
        """
        if self.tool.flat_radius == 0:
            return Count(np.inf, np.inf)
        return min((pattern.weigh(axis, feed) for pattern in self.patterns), key=lambda one: one.length)

    def _count(self, pattern: PassPattern, axis: Array, feed: str) -> Count:
        """The count of one pattern: for a ball end the first one that was taken, as it is the same for all axes.

        Under some of them the side above the ball cuts too, and wider strips; that is not looked for.
        """
        if pattern.name == PLANES or self.tool.flat_radius > 0:  # planes turn with the axis
            return pattern.count(self.cut(axis), feed)
        key = pattern.name, feed
        if key not in self._of_ball:
            found = pattern.count(self.cut(axis), feed)
            if not np.isfinite(found.length):
                return found
            self._of_ball[key] = found
        return self._of_ball[key]

    def worthwhile(self, value: float) -> float:
        """Least share of a value that is worth a further step of a search.

        Parameters
        ----------
        value : float
            What is to be least.
        """
        if self.objective == "length" and self.index_length > 0:
            return float(np.clip(_LITTLE_OF_INDEX * self.index_length / value, _SHARES[0], _MOST_OF_INDEX))
        little = {"length": _LITTLE, "time": _LITTLE_TIME, "passes": 0.0}[self.objective]
        return float(np.clip(little / value, *_SHARES))

    def charge(self, length: float, unreached: float) -> float:
        """Factor on passes and length for what is left as rest material.

        What stays is charged `CLEAN_UP` times its cutting length with a ball that fits into the corner: of the
        cutter's corner radius, or of a quarter of its radius if that is larger.

        Parameters
        ----------
        length : float
            Cutting length over the whole face, mm.
        unreached : float
            Share of the area left.
        """
        if unreached <= 0 or not np.isfinite(length):
            return 1.0
        return 1 - unreached + CLEAN_UP * unreached * (self.face.area / length) / self.clean_up_strip

    @property
    def clean_up_strip(self) -> float:
        """Strip width of the clean-up tool on a plane, mm: a ball of the corner radius, or a quarter of the radius."""
        radius = max(self.tool.corner_radius, self.tool.radius / 4)
        return 2 * float(np.sqrt(2 * radius * self.scallop - min(self.scallop, radius) ** 2))
