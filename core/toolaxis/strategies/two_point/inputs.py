"""What a cutter with a flat bottom has to do: which face, to what tolerance, which way, and how it shall stand."""

from dataclasses import dataclass, field
from math import radians
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.strategies.two_point.contact import STEEPEST
from toolaxis.strategies.two_point.rings import ContactSet
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

if TYPE_CHECKING:
    from toolaxis.strategies.two_point.lean_field import LeanField

Array = NDArray[np.float64]

#: "two-point": gouge-free with two contacts where they can be had; "formula": the paper's lean, lifted; "matched": the
#: curvature-matched lean; "one-point": the least gouge-free lean with one contact; "sturz": one lean everywhere;
#: "matched-raised", "formula-raised": these leans, steeper where they gouge until they do not.
POSTURES = ("two-point", "formula", "matched", "one-point", "sturz", "matched-raised", "formula-raised")
#: Those that gouge nowhere.
FREE_POSTURES = ("two-point", "one-point", "matched-raised", "formula-raised")


@dataclass(frozen=True, eq=False)
class TwoPointInputs:
    """What is to be machined, with what, and how the cutter shall stand.

    Attributes
    ----------
    face : Face
    tool : Tool
        A flat end or a torus.
    scallop : float
        The tolerance: height that may stay, mm.
    feed : str
        "u" or "v": the parameter that varies along the passes.
    posture : str
        One of `POSTURES`.
    lead : float
        Of "sturz", rad.
    share : float
        Of the tolerance, for which "formula" and "formula-raised" are reckoned.
    allowance : float
        Stock left on the face, mm.
    limits : Tolerance
    found : dict of int to Field
        Directions of two-point contact by the sense of the lean, once they were looked for.

    Raises
    ------
    InvalidInput
        When the feed or the posture is unknown, or a size is out of range.
    """

    face: Face
    tool: Tool
    scallop: float
    feed: str = "u"
    posture: str = "two-point"
    lead: float = radians(20.0)
    allowance: float = 0.0
    limits: Tolerance = field(default_factory=Tolerance)
    share: float = 1.0
    found: "dict[int, LeanField]" = field(default_factory=dict, repr=False, init=False)

    def __post_init__(self) -> None:
        if self.feed not in ("u", "v"):
            raise InvalidInput(f"feed is {self.feed!r}: it must be 'u' or 'v'")
        if self.posture not in POSTURES:
            raise InvalidInput(f"posture is {self.posture!r}: it must be one of {', '.join(POSTURES)}")
        if not 0 < self.lead <= STEEPEST:
            raise InvalidInput(f"lead is {np.degrees(self.lead):.3f} degrees: it must be above 0 and at most "
                               f"{np.degrees(STEEPEST):.0f}")
        if not 0 < self.share <= 1:
            raise InvalidInput(f"share of the tolerance is {self.share}: it must be above 0 and at most 1")
        self.setting(np.empty((0, 2)), 1)

    @property
    def column(self) -> int:
        """Column of uv that varies along the passes."""
        return 0 if self.feed == "u" else 1

    @property
    def chord(self) -> float:
        """How far straight motions may leave passes, mm."""
        return self.limits.chord_for(self.scallop)

    @property
    def span(self) -> tuple[float, float, float, float]:
        """along0, along1, step0, step1 of the face."""
        u0, u1, v0, v1 = self.face.bounds
        return (u0, u1, v0, v1) if self.feed == "u" else (v0, v1, u0, u1)

    def uv(self, along: Array, step: float) -> Array:
        """Parameters (n, 2) of places along a pass.

        Parameters
        ----------
        along : (n,) array
        step : float
        """
        pair = np.column_stack([along, np.full(len(along), step)])
        return pair if self.feed == "u" else pair[:, ::-1].copy()

    def setting(self, uv: Array, sense: int) -> ContactSet:
        """Contacts with travel in increasing (1) or decreasing (-1) parameter.

        Parameters
        ----------
        uv : (n, 2) array
        sense : int
        """
        d = self.face.evaluate(uv)
        return ContactSet(self.face, self.tool, uv, sense * (d.su if self.feed == "u" else d.sv), self.scallop,
                          self.allowance, self.limits)
