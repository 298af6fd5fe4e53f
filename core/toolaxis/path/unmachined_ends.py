"""What layers around a closed face leave at both ends of its span: strips from the outermost layers to the border."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.plan.zone import Zone
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]

#: Share of the way to the next layer that a layer machines beyond itself; strips no wider than that are none.
_BEYOND = 0.4
#: Layers nearer to the border than this share of the step are there.
_THERE = 0.45


class _Layer(NamedTuple):
    """A layer in the parameters of its face: places around, ascending from end to end, and steps, (n,) each."""

    along: Array
    step: Array


def beyond_layers(face: Face, path: ToolPath, feed: str) -> tuple[Zone, ...]:
    """Zones between the first and the last layer of a path and the borders beyond them.

    Parameters
    ----------
    face : Face
        Closed in one parameter.
    path : ToolPath
        Its passes go around one after the other; two at least, or there is no zone.
    feed : str
        The closed parameter.

    Returns
    -------
    tuple of Zone
        The largest first.
    """
    if path.passes < 2:
        return ()
    first, second, last_but_one, last = (_layer(face, path, number, feed)
                                         for number in (0, 1, path.passes - 2, path.passes - 1))
    zones = []
    for outer, inner in ((first, second), (last, last_but_one)):
        loop = _strip_beyond(face, outer, inner, feed)
        if loop is not None:
            piece = face.trimmed((loop,))
            zones.append(Zone(piece.trims, piece.area))
    return tuple(sorted(zones, key=lambda zone: -zone.area))


def _strip_beyond(face: Face, outer: _Layer, inner: _Layer, feed: str) -> Array | None:
    """The loop around what an outermost layer leaves up to the border, (m, 2); None where it is at the border."""
    u0, u1, v0, v1 = face.bounds
    along_ends, step_ends = ((u0, u1), (v0, v1)) if feed == "u" else ((v0, v1), (u0, u1))
    outwards = outer.step - np.interp(outer.along, inner.along, inner.step)
    border = step_ends[1] if outwards.mean() > 0 else step_ends[0]
    if abs(border - outer.step.mean()) <= _THERE * abs(outwards.mean()):
        return None
    edge = np.clip(outer.step + _BEYOND * outwards, *step_ends)
    at_layer = np.column_stack([outer.along, edge])
    at_border = [[along_ends[1], border], [along_ends[0], border]]
    loop = np.concatenate([at_layer, at_border])
    return loop if feed == "u" else loop[:, ::-1]


def _layer(face: Face, path: ToolPath, number: int, feed: str) -> _Layer:
    rows = np.arange(path.breaks[number], path.breaks[number + 1])
    cuts = rows[path.kind[rows] == Motion.CUT]
    u, v = nearest(face, path.cc[cuts]).uv.T
    along, step = (u, v) if feed == "u" else (v, u)
    order = np.argsort(along, kind="stable")
    along, step = along[order], step[order]
    low, high = face.bounds[:2] if feed == "u" else face.bounds[2:]
    is_apart = np.concatenate([[True], np.diff(along) > 1e-9 * (high - low)])
    is_kept = (along > low) & (along < high) & is_apart
    along, step = along[is_kept], step[is_kept]
    return _Layer(np.concatenate([[low], along, [high]]), np.concatenate([step[:1], step, step[-1:]]))
