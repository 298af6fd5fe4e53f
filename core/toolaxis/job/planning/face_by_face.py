"""Skins of which a part has no axis, against the same faces one by one: which is better, and how that is told."""

from collections.abc import Sequence
from dataclasses import replace

from toolaxis.plan.operation import Operation
from toolaxis.shape.face import Face

#: Shares of a skin's area that differ by less count as the same.
_SAME = 0.01


def loses_area(operations: Sequence[Operation], area: float) -> bool:
    """Whether more than a small share of a skin has no axis, and nothing of it is there on which the program failed.

    Parameters
    ----------
    operations : sequence of Operation
        None of them where the skin was not planned.
    area : float
        Of the skin, mm^2.
    """
    lost = sum(op.face.area for op in operations if not op.done)
    return lost > _SAME * area and not any(op.failed for op in operations)


def area_machined(operations: Sequence[Operation]) -> float:
    """Area of the sub-surfaces that have an axis, without what is left as rest material, mm^2.

    Parameters
    ----------
    operations : sequence of Operation
    """
    return sum(op.face.area * (1 - op.orientation.unreached) for op in operations if op.done)


def is_better(one: Sequence[Operation], other: Sequence[Operation], area: float) -> bool:
    """Whether some operations are better than others on the same faces: more area, else fewer of them, else shorter.

    Parameters
    ----------
    one, other : sequence of Operation
    area : float
        Of the faces, mm^2.
    """
    gain = area_machined(one) - area_machined(other)
    if abs(gain) > _SAME * area:
        return gain > 0
    return _effort(one) < _effort(other)


def _effort(operations: Sequence[Operation]) -> tuple[bool, int, float]:
    """How many operations there are, and the length of their cuts, mm; nothing at all is the worst."""
    done = [op for op in operations if op.done]
    return not done, len(done), sum(op.orientation.length for op in done)


def name_faces(skin: Face, operations: Sequence[Operation]) -> list[Operation]:
    """Operations of a skin's faces that tell that they stand in its place.

    Parameters
    ----------
    skin : Face
    operations : sequence of Operation
    """
    note = f"skin {skin.label}: its faces one by one"
    return [replace(op, orientation=replace(op.orientation, reasons=(*op.orientation.reasons, note)))
            for op in operations]


def compare_areas(skin: Face, whole: Sequence[Operation], faces: Sequence[Operation]) -> str:
    """The sentence that tells that a skin was taken apart, and what that gains.

    Parameters
    ----------
    skin : Face
    whole, faces : sequence of Operation
        Of the skin as one face, and of its faces.
    """
    shares = [100 * area_machined(some) / skin.area for some in (faces, whole)]
    return (f"skin {skin.label}: its faces one by one machine {shares[0]:.1f} % of its area, as one face it would be "
            f"{shares[1]:.1f} %")
