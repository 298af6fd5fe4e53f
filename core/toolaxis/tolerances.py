"""All tolerances and required clearances in one frozen place."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from math import degrees, isfinite, pi, radians
from numbers import Real
from typing import Any, TypeAlias

from toolaxis.errors import InvalidInput

#: The machining tolerance unless given, and the least and the greatest that is planned with, mm.  Below the least,
#: bounds of depths (0.0003 mm) have no room; above the greatest, the judge's rays would see thin walls as whole.
MACHINING, LEAST, GREATEST = 0.01, 0.0005, 0.1
#: Shares of the scallop height and of the machining tolerance that the chord tolerance takes, whichever is less.
SCALLOP_SHARE, MACHINING_SHARE = 1 / 10, 1 / 4
#: More than this share of either a given chord tolerance does not take.
MOST = 1 / 2


@dataclass(frozen=True)
class Tolerance:
    """Limits that decide what counts as safe and how finely curves are followed.

    Attributes
    ----------
    gouge : float
        The machining tolerance: deepest penetration below the machined skin that is accepted, mm.
    cutter_clearance, shank_clearance, holder_clearance : float
        Least distance of each component to everything that is not the machined skin, mm.
    chord : float or None
        Chord tolerance of the passes, mm; None stands for the share that `chord_for` states.
    min_lead : float
        Least angle between the axis of a cutter with a flat bottom and any normal of the face, rad: nearer than
        this the contact wanders over the flat bottom and its place is undefined.
    least_lean : float
        Least angle between the axis of a ball end, tapered ones too, and the normal at every contact, rad: at the tip
        of a ball the cutting speed is zero.  0 allows all; cutters with a flat bottom keep `min_lead` in its place.
    trim : float
        Chord tolerance of trim loops, as a share of the face's diagonal; at most 0.0002 mm, however large the face.
    shank_share : float or None
        Share of the cutter's diameter that its shank keeps where that is less than `shank_clearance`; never less than
        `cutter_clearance`.  The neck of a 1 mm ball end that kept 0.5 mm would stay out of the corners that it is made
        for.  None: every shank keeps `shank_clearance`.

    Raises
    ------
    InvalidInput
        When a value is out of its range.
    """

    gouge: float = MACHINING
    cutter_clearance: float = 0.1
    shank_clearance: float = 0.5
    holder_clearance: float = 1.0
    chord: float | None = None
    min_lead: float = radians(0.5)
    trim: float = 1e-5
    least_lean: float = 0.0
    shank_share: float | None = 0.1

    def __post_init__(self) -> None:
        _check_machining(self.gouge)
        _check_lean(self.least_lean)
        for field in fields(self):
            value = getattr(self, field.name)
            if value is None or field.name == "least_lean":
                continue
            number = isinstance(value, Real) and isfinite(value)
            if not number or value < 0 or (field.name in ("chord", "trim") and value == 0):
                raise InvalidInput(f"tolerance {field.name} is {value}: it must be a finite positive number")

    @classmethod
    def of(cls, given: "ToleranceLike") -> "Tolerance":
        """Tolerances from what a caller gives.

        Parameters
        ----------
        given : Tolerance, float or None
            A number is the machining tolerance, mm; None stands for the defaults.

        Raises
        ------
        InvalidInput
            When it is none of these, or out of range.
        """
        if given is None:
            return cls()
        if isinstance(given, Tolerance):
            return given
        _check_machining(given)
        return cls(gouge=float(given))

    def with_clearances(self, clearances: Sequence[float] | str) -> "Tolerance":
        """The same with other clearances, which every tool keeps.

        Parameters
        ----------
        clearances : sequence of float, or text such as "0.1,0.5,1"
            Of cutter, shank and holder, mm.

        Raises
        ------
        InvalidInput
            When these are not three numbers, or one is below zero.
        """
        rows = clearances.split(",") if isinstance(clearances, str) else clearances
        try:
            cutter, shank, holder = (float(row) for row in rows)
        except (TypeError, ValueError) as reason:
            raise InvalidInput(f"clearances {clearances!r} are not understood: give three lengths in mm, of cutter, "
                               "shank and holder, such as 0.1,0.5,1") from reason
        return replace(self, cutter_clearance=cutter, shank_clearance=shank, holder_clearance=holder, shank_share=None)

    def for_cutter(self, radius: float) -> "Tolerance":
        """The same for one cutter: `shank_clearance` is what its shank keeps, and `shank_share` None.

        Parameters
        ----------
        radius : float
            Of the cutter, mm.
        """
        if self.shank_share is None:
            return self
        enough = max(2 * self.shank_share * radius, self.cutter_clearance)
        return replace(self, shank_clearance=min(self.shank_clearance, enough), shank_share=None)

    def least_angle(self, flat_radius: float) -> float:
        """Least angle between the axis of a cutter and the normal at its contacts, rad.

        Parameters
        ----------
        flat_radius : float
            Radius of the cutter's flat bottom, mm; 0 for a ball end.
        """
        return self.min_lead if flat_radius > 0 else self.least_lean

    def chord_for(self, scallop: float) -> float:
        """Chord tolerance of passes: how far straight motions may leave them, mm.

        Parameters
        ----------
        scallop : float
            Scallop height that is asked for, mm.

        Returns
        -------
        float
            A tenth of the scallop height or a quarter of the machining tolerance, whichever is less, unless one is
            given; that one as far as it is at most half of both.
        """
        if self.chord is None:
            return min(SCALLOP_SHARE * scallop, MACHINING_SHARE * self.gouge)
        return min(self.chord, MOST * scallop, MOST * self.gouge)


#: What calls take as a tolerance: a `Tolerance`, the machining tolerance in mm, or None for the defaults.
ToleranceLike: TypeAlias = Tolerance | float | None


def _check_lean(value: Any) -> None:
    """Refuse what is no least lean, rad."""
    number = isinstance(value, Real) and not isinstance(value, bool)
    if not number or not 0 <= value < pi / 2:
        shown = f"{degrees(value):g} deg" if number else repr(value)
        raise InvalidInput(f"least lean is {shown}: it must be a number from 0 to below 90 deg; 5 to 15 deg are usual")


def _check_machining(value: Any) -> None:
    """Refuse what is no machining tolerance."""
    number = isinstance(value, Real) and not isinstance(value, bool)
    if not number or not LEAST <= value <= GREATEST:
        shown = f"{value} mm" if number else repr(value)
        raise InvalidInput(f"machining tolerance is {shown}: it must be a number from {LEAST:g} to {GREATEST:g} mm; "
                           f"{MACHINING:g} mm is usual")
