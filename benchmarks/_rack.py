"""A cutter with shank and holder for a part nobody planned before, chosen by a rule that knows sizes and radii alone.

The rule: of the ball ends on the rack the largest that is no wider than a twentieth of the part's diagonal and fits,
its radius at most 0.9 times the least concave radius, into sculptured faces that make up 80 % of the sculptured area
and half of their number; the smallest where none does.  Where it is 6 mm wide or more and sculptured faces of the same
shares are nowhere hollow tighter than five of its diameters, a torus of that diameter with a corner of an eighth of it
takes its place.  Scallop heights go with the diameter.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

_AREA, _NUMBER, _FITS, _ACROSS, _GENTLE, _LEAST_TORUS, _CORNER = 0.8, 0.5, 0.9, 0.05, 5.0, 6.0, 0.125


class _Holding(NamedTuple):
    """What a cutter of a diameter is held by, mm: scallop height to plan with, stick-out, radius of the shank and of
    the holder's nose."""

    diameter: float
    scallop: float
    stickout: float
    shank: float
    nose: float


_RACK = (_Holding(0.5, 0.002, 25, 1.5, 6), _Holding(1, 0.003, 25, 1.5, 6), _Holding(2, 0.005, 25, 1.5, 6),
         _Holding(3, 0.01, 30, 1.5, 6), _Holding(4, 0.01, 40, 2, 8), _Holding(6, 0.01, 40, 3, 8),
         _Holding(8, 0.02, 45, 4, 8),
         _Holding(10, 0.02, 50, 5, 9), _Holding(12, 0.02, 60, 6, 10), _Holding(16, 0.03, 75, 8, 14),
         _Holding(20, 0.03, 80, 10, 17), _Holding(32, 0.05, 120, 16, 25), _Holding(50, 0.1, 160, 20, 32))


class RackTool(NamedTuple):
    """name : short form;  scallop : mm;  file : text of a tool file, None where the name is all that is known."""

    name: str
    scallop: float
    file: str | None


def chosen(survey: Mapping[str, Any]) -> RackTool:
    """The tool for a part, by the rule.

    Parameters
    ----------
    survey : mapping
        What ``inspect --json`` printed.
    """
    faces = [face for face in survey["faces"] if face["sculptured"]]
    fitting = [place for place in _RACK if place.diameter <= _ACROSS * survey["diagonal"]
               and _holds(faces, place.diameter / 2 / _FITS)]
    place = fitting[-1] if fitting else _RACK[0]
    if place.diameter >= _LEAST_TORUS and _holds(faces, _GENTLE * place.diameter):
        return given(f"torus:{place.diameter:g}x{_CORNER * place.diameter:g}")
    return given(f"ball:{place.diameter:g}")


def given(text: str) -> RackTool:
    """A tool of a size that somebody chose, held as the next larger one on the rack.

    Parameters
    ----------
    text : str
        ball:8, torus:12x1 or flat:20 get shank and holder; everything else that ``--tool`` takes stays as it is.
    """
    found = re.fullmatch(r"(ball|torus|flat):([0-9.]+)(?:x([0-9.]+))?", text)
    if found is None:
        size = re.search(r"[0-9.]+", text)
        return RackTool(text, _place(float(size[0]) if size else 0.0).scallop, None)
    kind, diameter, corner = found[1], float(found[2]), found[3]
    place = _place(diameter)
    rows = [f'kind = "{kind}"', f"diameter = {diameter}"]
    if corner:
        rows.append(f"corner_radius = {float(corner)}")
    neck, flute = 0.475 * diameter, 2 * diameter
    shank = [[diameter / 2, 0.0], [diameter / 2, place.stickout]]
    if place.shank > diameter / 2:  # a thin neck, and a cone up to the shank
        shank = [[neck, 0.0], [neck, 6 * diameter], [place.shank, 6 * diameter + 2 * place.shank],
                 [place.shank, place.stickout]]
    holder = [[place.nose, 0.0], [place.nose, 40.0], [place.nose + 15, 40.0], [place.nose + 15, 80.0]]
    rows += [f"flute_length = {flute}", f"stickout = {float(place.stickout)}", f"shank = {shank}", f"holder = {holder}"]
    return RackTool(text, place.scallop, "\n".join(rows) + "\n")


def _place(diameter: float) -> _Holding:
    return next((place for place in _RACK if place.diameter >= diameter), _RACK[-1])


def _holds(faces: Sequence[Mapping[str, Any]], radius: float) -> bool:
    """Whether faces of the required shares are nowhere hollow tighter than a radius."""
    wide = [face for face in faces if face["concave_radius"] is None or face["concave_radius"] >= radius]
    area = sum(face["area"] for face in faces)
    return sum(face["area"] for face in wide) >= _AREA * area and len(wide) >= _NUMBER * len(faces)
