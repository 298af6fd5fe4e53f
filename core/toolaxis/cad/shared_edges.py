"""Edges that faces share in the kernel's topology, as points and as parameters of both faces."""

from collections.abc import Iterable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.kernel_protocol import KernelEdge, KernelFace
from toolaxis.cad.shape_data import FaceRecord
from toolaxis.shape.adjacency import Border
from toolaxis.shape.joining.edge_matching import OpenEdge

Array = NDArray[np.float64]

_User: TypeAlias = tuple[FaceRecord, KernelEdge]

FINENESS = 1e-4
#: Places at which borders are held against each other; where they are farther apart than that, mm, the edge gets places
#: at this distance, mm, but no more than about so many.
CHECKED, APART, SPACING, MOST = 17, 2e-4, 0.1, 1000


def borders_of(pairs: Iterable[tuple[FaceRecord, KernelFace]]) -> tuple[list[Border], list[OpenEdge]]:
    """Every edge that two faces share, or that one face has twice (a seam); and the sides that only one face has.

    Parameters
    ----------
    pairs : iterable of (FaceRecord, KernelFace)
        Faces to look at.
    """
    users: dict[int, list[_User]] = {}
    for record, face in pairs:
        for edge in (edge for wire in face.wires for edge in wire if not edge.degenerate):
            users.setdefault(edge.key, []).append((record, edge))
    borders, free = [], []
    for sharing in users.values():
        if len(sharing) == 1:
            free.append(_side(sharing[0]))
        for k, one in enumerate(sharing):
            borders += [_border(one, other) for other in sharing[k + 1:]]
    return borders, free


def _side(user: _User) -> OpenEdge:
    record, edge = user
    share, points = _polyline(edge)
    return OpenEdge(record.number, points, _parameters(user, share), _is_left(user))


def _border(one: _User, other: _User) -> Border:
    record, edge = one
    share, points = _polyline(edge)
    if _apart(one, other, np.linspace(0.0, 1.0, CHECKED)) > APART:
        share = _between(share, points)
        points = edge.points(share)
    faces = (record.number, other[0].number)
    first = _parameters(one, share)
    second = _parameters(other, share)
    return Border(faces, points, first, second, _is_left(one), _is_left(other))


def _is_left(user: _User) -> bool:
    """Whether the face lies to the left of its edge."""
    record, edge = user
    return edge.forward ^ record.turned


def _apart(one: _User, other: _User, share: Array) -> float:
    """How far both faces' own borders are apart at shares of an edge at most, mm."""
    first, second = (user[0].surface.evaluate(_parameters(user, share)).point for user in (one, other))
    return float(np.linalg.norm(first - second, axis=1).max())


def _between(share: Array, points: Array) -> Array:
    """Shares with more between them, so that places are no farther apart than what two faces miss changes over."""
    far = np.linalg.norm(np.diff(points, axis=0), axis=1)
    step = max(SPACING, float(far.sum()) / MOST)
    counts = np.maximum(np.ceil(far / step), 1).astype(np.int64)
    pieces = []
    for low, high, count in zip(share[:-1], share[1:], counts, strict=True):
        pieces.append(low + (high - low) * np.arange(count) / count)
    return np.concatenate([*pieces, share[-1:]])


def _polyline(edge: KernelEdge) -> tuple[Array, Array]:
    """Shares of the edge's own range, and points dense enough for its shape."""
    share = np.linspace(0.0, 1.0, 1 + 4 * max(1, min(edge.space_spans, 100)))
    points = edge.points(share)
    limit = FINENESS * np.linalg.norm(np.ptp(points, axis=0))
    for _ in range(8):
        middle = 0.5 * (share[1:] + share[:-1])
        between = edge.points(middle)
        coarse = np.linalg.norm(between - 0.5 * (points[1:] + points[:-1]), axis=1) > limit
        if not coarse.any():
            break
        places = np.flatnonzero(coarse) + 1
        share, points = np.insert(share, places, middle[coarse]), np.insert(points, places, between[coarse], axis=0)
    return share, points


def _parameters(user: _User, share: Array) -> Array:
    record, edge = user
    return record.map.to_ours(edge.parameters(share if edge.forward else 1 - share))
