"""All tolerances and required clearances in one frozen place."""

from dataclasses import dataclass, fields
from math import isfinite, radians

from toolaxis.errors import InvalidInput


@dataclass(frozen=True)
class Tolerance:
    """Limits that decide what counts as safe and how finely curves are followed.

    Attributes
    ----------
    gouge : float
        Deepest penetration below the machined skin that is accepted, mm.
    cutter_clearance, shank_clearance, holder_clearance : float
        Least distance of each component to everything that is not the machined skin, mm.
    chord : float or None
        Chord tolerance of the passes, mm; None stands for a fiftieth of the scallop height.
    min_lead : float
        Least angle between the axis of a cutter with a flat bottom and any normal of the face, rad: nearer than
        this the contact wanders over the flat bottom and its place is undefined.
    trim : float
        Chord tolerance of trim loops, as a share of the face's diagonal; at most 0.0002 mm, however large the face.
    """

    gouge: float = 0.002
    cutter_clearance: float = 0.1
    shank_clearance: float = 0.5
    holder_clearance: float = 1.0
    chord: float | None = None
    min_lead: float = radians(0.5)
    trim: float = 1e-5

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if value is None:
                continue
            if not isfinite(value) or value < 0 or (field.name in ("chord", "trim", "gouge") and value == 0):
                raise InvalidInput(f"tolerance {field.name} is {value}: it must be a finite positive number")

    def chord_for(self, scallop: float) -> float:
        """Chord tolerance of passes for a scallop height, mm.

        Parameters
        ----------
        scallop : float
            Scallop height, mm.
        """
        return scallop / 50 if self.chord is None else self.chord
