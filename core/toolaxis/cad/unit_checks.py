"""Does a part look as if the numbers of its file were of another unit than the one declared?"""

from math import sqrt

import numpy as np

from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

SMALLEST, LARGEST = 10.0, 5000.0
"""mm across, of parts that are milled."""
NARROWEST = 0.2
"""mm: least width, on average, of a face that runs along half the part or more."""
FINEST, FINENESS = 0.5, 200.0
"""Least distance of control points, mm, or as how many to the part's diagonal, of such a face."""
STRAY = 100.0
"""How many times as large as all others together a face is that does not belong there."""
OTHER_UNITS = (("m", 1000.0), ("inch", 25.4), ("cm", 10.0))


def unit_warnings(part: Part) -> tuple[str, ...]:
    """At most one sentence: what of a part is too small or too large to be milled if the declared unit is right.

    Looked at are the size of the whole, faces that run along the part but are narrower than any cut, and control
    points that stand closer than cutters shape.

    Parameters
    ----------
    part : Part
    """
    size = part.diagonal
    stray = _stray(part) if size > LARGEST else ""
    if stray:
        return (stray,)
    if size > LARGEST:
        return (f"the part is {size:.4g} mm across in the unit that the file declares ({part.unit}): check the unit "
                f"({size / 1000:.4g} mm if its numbers were micrometres)",)
    if size < SMALLEST:
        odd = f"the part is {size:.4g} mm across in the unit that the file declares ({part.unit})"
    else:
        odd = _narrow(part) or _most_crowded_face(part)
    otherwise = " or ".join(f"{_length(size * factor)} if its numbers were {name}" for name, factor in OTHER_UNITS)
    across = "" if size < SMALLEST else f"the part is {size:.4g} mm across, "
    return (f"{odd}: check the unit ({across}{otherwise})",) if odd else ()


def _stray(part: Part) -> str:
    """The face that alone makes the part so large."""
    widest = max(part.faces, key=lambda face: face.diagonal)
    boxes = np.array([face.box for face in part.faces if face is not widest]).reshape(-1, 2, 3)
    if not len(boxes):
        return ""
    rest = float(np.linalg.norm(boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)))
    if widest.diagonal < STRAY * rest:
        return ""
    return (f"face {widest.number} is {widest.diagonal:.4g} mm across and all others together {rest:.4g} mm: its "
            "geometry looks damaged; repair it in the CAD system and export it again")


def _length(value: float) -> str:
    return f"{value:.4g} mm" if value < 10000.0 else f"{value / 1000.0:.4g} m"


def _along(part: Part) -> list[Face]:
    """The faces that run along the part; what is small beside it may be lettering or an accident of modelling."""
    return [face for face in part.faces if face.diagonal > 0.5 * part.diagonal]


def _narrow(part: Part) -> str:
    """The narrowest face along the part, where no cutter makes one so narrow."""
    widths = [(face.area / face.diagonal, face) for face in _along(part)]
    width, face = min(widths, key=lambda pair: pair[0], default=(NARROWEST, None))
    if face is None or width >= NARROWEST:
        return ""
    return (f"face {face.number} is {face.diagonal:.4g} mm long and {width:.2g} mm wide on average in the unit that "
            f"the file declares ({part.unit}), narrower than is milled")


def _most_crowded_face(part: Part) -> str:
    """The face along the part whose control points stand closest, where cutters shape nothing so fine."""
    modelled = [(_spacing(face), face) for face in _along(part) if face.kind == "bspline" and not face.tolerance]
    finest = min(FINEST, part.diagonal / FINENESS)
    spacing, face = min(modelled, key=lambda pair: pair[0], default=(finest, None))
    if face is None or spacing >= finest:
        return ""
    return (f"the control points of face {face.number} stand {spacing:.2g} mm apart on average in the unit that the "
            f"file declares ({part.unit}), closer than is milled")


def _spacing(face: Face) -> float:
    """Side of the square of the face that one control point has, mm."""
    count_u, count_v = face.surface.control.shape[:2]
    return sqrt(face.area / (count_u * count_v))


def tool_warnings(part: Part, diameter: float) -> tuple[str, ...]:
    """At most one sentence: whether a cutter is wider than the part in two of its directions.

    Parameters
    ----------
    part : Part
    diameter : float
        Of the cutter, mm.
    """
    sides = sorted((float(high - low) for low, high in part.box.T), reverse=True)
    if not 0.0 < sides[1] < diameter:
        return ()
    written = " x ".join(f"{side:.4g}" for side in sides)
    unit = f" ({part.unit})" if part.unit else ""
    return (f"the cutter is {diameter:.4g} mm wide and the part only {written} mm: check the unit of the part{unit} "
            "and the size of the tool",)
