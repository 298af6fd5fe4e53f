"""What layers around a closed face leave at both ends of its span: strips from the outermost layers to the border."""

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
    lines = [_line(face, path, k, feed) for k in (0, 1, path.passes - 2, path.passes - 1)]
    u0, u1, v0, v1 = face.bounds
    (a0, a1), (s0, s1) = ((u0, u1), (v0, v1)) if feed == "u" else ((v0, v1), (u0, u1))
    zones = []
    for (along, outer), inner in ((lines[0], lines[1]), (lines[3], lines[2])):
        step = outer - np.interp(along, *inner)
        border = s1 if step.mean() > 0 else s0
        if abs(border - outer.mean()) <= _THERE * abs(step.mean()):
            continue
        edge = np.clip(outer + _BEYOND * step, s0, s1)
        loop = np.concatenate([np.column_stack([along, edge]), [[a1, border], [a0, border]]])
        piece = face.trimmed((loop if feed == "u" else loop[:, ::-1],))
        zones.append(Zone(piece.trims, piece.area))
    return tuple(sorted(zones, key=lambda zone: -zone.area))


def _line(face: Face, path: ToolPath, number: int, feed: str) -> tuple[Array, Array]:
    """A layer in the parameters: places around, ascending from end to end, and steps."""
    rows = np.arange(path.breaks[number], path.breaks[number + 1])
    rows = rows[path.kind[rows] == Motion.CUT]
    uv = nearest(face, path.cc[rows]).uv
    along, step = uv[:, int(feed == "v")], uv[:, int(feed == "u")]
    order = np.argsort(along, kind="stable")
    along, step = along[order], step[order]
    low, high = (face.bounds[:2] if feed == "u" else face.bounds[2:])
    kept = (along > low) & (along < high) & np.concatenate([[True], np.diff(along) > 1e-9 * (high - low)])
    along, step = along[kept], step[kept]
    return np.concatenate([[low], along, [high]]), np.concatenate([step[:1], step, step[-1:]])
