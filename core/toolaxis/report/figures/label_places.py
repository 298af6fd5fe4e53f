"""Where labels stand in a picture, so that none lies on another one."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Width and height of a letter, points.
_WIDE, _HIGH = 8.5, 12.0
#: How many times farther from its place, and how much turned about it, rad, a label stands that has no room.
_FARTHER, _TURNS = (1.0, 1.7, 2.4, 3.2), tuple(np.radians([40, -40, 80, -80, 120, -120, 180]))


def join_labels(places: dict[int, Array], near: Array) -> list[tuple[list[int], Array]]:
    """Numbers that share a label, as labels of their own would lie on each other.

    Parameters
    ----------
    places : dict of int to (2,) array
        Where the label of each number would be written.
    near : (2,) array
        Width and height of a label.

    Returns
    -------
    list of numbers and (2,) array
        Those of each label, and where it is written: at the place of the first of them.
    """
    found: list[tuple[list[int], Array]] = []
    for number, place in places.items():
        taken = next((numbers for numbers, other in found if (abs(place - other) < near).all()), None)
        if taken is None:
            found.append(([number], place))
        else:
            taken.append(number)
    return found


class LabelPlaces:
    """Where labels stand in a picture, none on another one as far as there is room.

    Parameters
    ----------
    scale : float
        Points of the page for each mm of the picture.
    """

    def __init__(self, scale: float) -> None:
        self._scale = scale
        self._taken: list[Array] = []

    def find(self, words: str, place: Array, offset: Array) -> Array:
        """The offset of a label from its place, (2,) in points: the one that is wished for, else the nearest free one.

        Parameters
        ----------
        words : str
        place : (2,) array
            mm
        offset : (2,) array
            Wished for, in points.
        """
        half = np.array([_WIDE * len(words), _HIGH]) / 2
        first, length = float(np.arctan2(offset[1], offset[0])), float(np.linalg.norm(offset))
        ways = [(times * length, first + turn) for times in _FARTHER for turn in _TURNS]
        offsets = [offset, *(far * np.array([np.cos(turn), np.sin(turn)]) for far, turn in ways)]
        boxes = [np.concatenate([self._scale * place + one, half]) for one in offsets]
        free = (k for k, box in enumerate(boxes) if not any(_meet(box, other) for other in self._taken))
        best = next(free, 0)
        self._taken.append(boxes[best])
        return np.asarray(offsets[best])


def _meet(one: Array, other: Array) -> bool:
    """Whether two boxes, each of middle and half sides, (4,), overlap."""
    return bool((abs(one[:2] - other[:2]) < one[2:] + other[2:]).all())
