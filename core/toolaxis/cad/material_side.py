"""Faces that meet with their material on opposite sides: where a few of many are wrong, these are turned over."""

from collections import deque
from collections.abc import Sequence

import numpy as np

from toolaxis.shape.adjacency import Border, consistent
from toolaxis.shape.face import Face

#: Share of the area of faces that hang together up to which those that disagree with the others are turned over.
FEW = 0.25


def faces_to_turn(faces: Sequence[Face], borders: Sequence[Border]) -> frozenset[int]:
    """Numbers of the faces to turn over, so that all that hang together have their material on one side.

    Parameters
    ----------
    faces : sequence of Face
    borders : sequence of Border
        Where they meet.

    Returns
    -------
    frozenset of int
        Empty where all agree already, where no choice of sides agrees everywhere, and where those that disagree with
        the others have more than `FEW` of the area: then nobody knows which are wrong.
    """
    by_number = {face.number: face for face in faces}
    beside: dict[int, list[tuple[int, bool]]] = {face.number: [] for face in faces}
    for (a, b), agreed in agreement(faces, borders).items():
        beside[a].append((b, agreed < 0))
        beside[b].append((a, agreed < 0))
    turned: set[int] = set()
    seen: dict[int, bool] = {}
    for face in faces:
        if face.number not in seen:
            turned |= _few_of(by_number, _sides(face.number, beside, seen))
    return frozenset(turned)


def agreement(faces: Sequence[Face], borders: Sequence[Border]) -> dict[tuple[int, int], float]:
    """Along what length two faces have their material on one side, less that along which they do not, mm.

    A face that runs out to nothing between two others says anything there.

    Parameters
    ----------
    faces : sequence of Face
    borders : sequence of Border
    """
    by_number = {face.number: face for face in faces}
    found: dict[tuple[int, int], float] = {}
    for border in borders:
        a, b = sorted(border.faces)
        if a != b:
            length = float(np.linalg.norm(np.diff(border.points, axis=0), axis=1).sum())
            agrees = consistent(border, *(by_number[number] for number in border.faces))
            found[a, b] = found.get((a, b), 0.0) + (length if agrees else -length)
    return found


def _sides(first: int, beside: dict[int, list[tuple[int, bool]]], seen: dict[int, bool]) -> dict[int, bool]:
    """On which of two sides faces that hang together have their material, that of one first; empty where there is no
    such choice."""
    side = {first: False}
    waiting = deque([first])
    sound = True
    while waiting:
        number = waiting.popleft()
        for other, differs in beside[number]:
            wanted = side[number] ^ differs
            if other not in side:
                side[other] = wanted
                waiting.append(other)
            sound &= side[other] == wanted
    seen.update(side)
    return side if sound else {}


def _few_of(by_number: dict[int, Face], side: dict[int, bool]) -> set[int]:
    """Of faces on two sides those on the one with little of the area; none where neither has."""
    if len(set(side.values())) < 2:  # areas take as long as all else that is read in a part
        return set()
    areas = [sum(by_number[number].area for number, on in side.items() if on == which) for which in (False, True)]
    lesser = areas[1] <= areas[0]
    if not 0 < min(areas) <= FEW * sum(areas):
        return set()
    return {number for number, on in side.items() if on == lesser}
