"""One orientation: the tool axis chosen for a face, what it costs, and the map it was chosen from."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toolaxis.plan.choices import ISO
from toolaxis.plan.zone import Zone

Array = NDArray[np.float64]

#: What came of a face; "failed" where the program itself went wrong, which says nothing of the face.
OUTCOMES = ("optimal", "feasible", "infeasible", "not_found", "failed", "cancelled")

#: Why an axis is forbidden, in the order in which it is found out; code 0 is an axis that may be used.
REASONS = ("free", "limits", "back of the surface", "too near to a normal", "gouge",
           "cutter collides", "shank collides", "holder collides")


@dataclass(frozen=True, eq=False)
class AxisMap:
    """Every axis that was looked at.

    Attributes
    ----------
    axis : (n, 3) array
        Unit vectors.
    passes : (n,) array
        Screening value: estimated passes in the better feed direction; inf where forbidden.
    length : (n,) array
        Screening value: estimated cutting length, mm; inf where forbidden.
    reason : (n,) array of int8
        Index into `REASONS`.
    amount : (n,) array
        By how much the reason's limit is missed (mm or rad); 0 where free.
    """

    axis: Array
    passes: Array
    length: Array
    reason: NDArray[np.int8]
    amount: Array


@dataclass(frozen=True, eq=False)
class Orientation:
    """A tool axis for a face.

    Attributes
    ----------
    axis : (3,) array or None
        Unit vector from tip to spindle; None unless the outcome is optimal or feasible.
    feed : str
        "u" or "v": the parameter that varies along the passes.
    passes : int
        Passes really made; 0 where they were not made.
    count : float
        Real-valued number of passes with exact widths.
    length : float
        Length of the cutting motion, mm.
    average_strip_width : float
        Area over cutting length, mm.
    gouge : float
        Upper bound of the penetration below the machined skin, mm.
    clearance : dict of str to float
        Lower bound per component ("cutter", "shank", "holder"), mm; a component that is not known is absent.
    outcome : str
        One of `OUTCOMES`.
    reasons : tuple of str
        Sentences: what limits the choice, or why there is none.
    evaluations : int
        Axes evaluated in all, screening and bounds included.
    map : AxisMap or None
    lobes : tuple of Orientation
        The best axis of each other lobe of feasible axes, best first.
    unreached : float
        Share of the face's area left as rest material, 0 to 1.
    lead : float or None
        Where the axis moves: its constant angle from the normal towards growing `feed`, or the mean of its angles to
        the normal, rad; `axis` is the mean one then.  None for a fixed axis.
    pattern : str
        How the passes lie: one of `toolaxis.plan.choices.PATTERNS`.
    ideal : float
        What passes with this axis tend to as the scallop height goes to zero, mm, each place cut in its best direction;
        no bound.  0 where it is not known.
    zones : tuple of Zone
        What its passes leave higher than the scallop limit, in (u, v) of the face, as it was found with their proof; an
        operation takes it over.
    """

    axis: Array | None
    feed: str = "u"
    passes: int = 0
    count: float = 0.0
    length: float = 0.0
    average_strip_width: float = 0.0
    gouge: float = 0.0
    clearance: dict[str, float] = field(default_factory=dict)
    outcome: str = "not_found"
    reasons: tuple[str, ...] = ()
    evaluations: int = 0
    map: AxisMap | None = None
    lobes: "tuple[Orientation, ...]" = ()
    unreached: float = 0.0
    lead: float | None = None
    pattern: str = ISO
    ideal: float = 0.0
    zones: tuple[Zone, ...] = ()

    @property
    def ideal_of_cut(self) -> float:
        """The ideal length without the share of the area that is left as rest material, mm."""
        return self.ideal * (1 - self.unreached)
