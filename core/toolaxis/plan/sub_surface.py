"""A sub-surface as it is given by hand: its border, and what of its axis and feed is fixed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]

_KEYS = ("face", "label", "region", "axis", "feed", "locked")
_FEEDS = ("", "u", "v")


@dataclass(frozen=True, eq=False)
class SubSurface:
    """A sub-surface of a face that a plan has to take as it is.

    Attributes
    ----------
    face : int
        Number of the face.
    region : tuple of (m, 2) arrays
        Closed loops in (u, v) of the face, the outer one first; empty for the whole face.
    axis : (3,) array, optional
        Axis from tip to spindle in the part's frame; one is searched unless given.
    feed : "u", "v" or ""
        Parameter that varies along the passes; the better one where it is empty.
    locked : bool
        Whether the axis is kept whatever comes of it; else another one is searched where it may not be used.
    label : str
        What messages call it, "7a"; the face's number and letters in their order unless given.

    Raises
    ------
    InvalidInput
        When a value is out of its range, or an axis is locked and not given.
    """

    face: int
    region: tuple[Array, ...] = ()
    axis: Array | None = None
    feed: str = ""
    locked: bool = False
    label: str = ""

    def __post_init__(self) -> None:
        where = f"the sub-surface of face {self.face!r}"
        if isinstance(self.face, bool) or not isinstance(self.face, int | np.integer):
            raise InvalidInput(f"{where} names no face: give a whole number from 1")
        try:
            region = tuple(np.array(loop, dtype=float) for loop in self.region)
            axis = None if self.axis is None else np.array(self.axis, dtype=float)
        except (TypeError, ValueError) as reason:
            raise InvalidInput(f"{where} has a border or an axis that are no numbers: give loops of (u, v), and "
                               "three numbers for the axis") from reason
        if axis is not None and (axis.shape != (3,) or not np.isfinite(axis).all() or not axis.any()):
            raise InvalidInput(f"the axis of {where} is {axis.tolist()}: give three finite numbers that are not all 0")
        if self.feed not in _FEEDS:
            raise InvalidInput(f"the feed of {where} is {self.feed!r}: use u, v or nothing")
        if self.locked and axis is None:
            raise InvalidInput(f"the axis of {where} is locked and not given: give it, or leave out the lock")
        object.__setattr__(self, "region", region)
        object.__setattr__(self, "axis", None if axis is None else axis / np.linalg.norm(axis))

    @property
    def held(self) -> bool:
        """Whether something of its axis or its feed is given."""
        return self.axis is not None or bool(self.feed)


def division_document(division: Sequence[SubSurface]) -> dict[str, Any]:
    """A division as a document that `json.dump` takes.

    Parameters
    ----------
    division : sequence of SubSurface
    """
    return {"sub_surfaces": [{"face": int(one.face), "label": one.label,
                              "region": [loop.tolist() for loop in one.region],
                              "axis": None if one.axis is None else one.axis.tolist(), "feed": one.feed,
                              "locked": one.locked} for one in division]}


def division_from(document: Mapping[str, Any]) -> tuple[SubSurface, ...]:
    """The division that `division_document` wrote, or that a plan's document has.

    Parameters
    ----------
    document : mapping
        Of a plan, its sub-surfaces are taken with their axes, none of them locked.

    Raises
    ------
    InvalidInput
        When it is neither.
    """
    rows = document.get("sub_surfaces") if isinstance(document, Mapping) else None
    if rows is None and isinstance(document, Mapping) and "operations" in document:
        rows = [{"face": op["face"], "label": op["label"], "region": op["region"] or (),
                 "axis": op["orientation"]["axis"]} for op in document["operations"]]
    if not isinstance(rows, Sequence) or isinstance(rows, str):
        raise InvalidInput("the division is neither a plan nor a list of sub_surfaces: write {\"sub_surfaces\": "
                           "[{\"face\": 1, \"region\": [[[u, v], ...]]}, ...]}")
    for k, row in enumerate(rows):
        unknown = sorted(set(row) - set(_KEYS)) if isinstance(row, Mapping) else ["no object"]
        if unknown or "face" not in row:
            raise InvalidInput(f"sub_surfaces[{k}] has {unknown[0] if unknown else 'no face'}: give "
                               f"{', '.join(_KEYS)}, of which only the face is needed")
    return tuple(SubSurface(**{**row, "region": tuple(row.get("region") or ())}) for row in rows)
