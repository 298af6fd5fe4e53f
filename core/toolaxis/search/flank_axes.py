"""Axes along the flank of a face: almost perpendicular to all its normals, so that arc and side of the cutter both cut.

Where normals lie close to one plane, as on ruled and on nearly flat faces, strips can be widest there.  Such a lobe is
a few degrees wide, less than the first axes of a search are apart.
"""

from math import cos, radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.numeric.rounding import canonical_sign

Array = NDArray[np.float64]

#: How far the contacts stay within the greatest angle that the cutter can touch at, rad.
_WITHIN = (radians(1.0), radians(3.0))
#: An axis that must be lifted farther than this to see the whole face does not go along it, rad.
_FAR = radians(15.0)
#: Least difference between mean squares of the normals along the two directions that they avoid most: below it,
#: neither of them is meant.
_APART = 1e-6


def flank_axes(feasibility: Feasibility) -> Array:
    """Axes along the flank of a face, in both senses, lifted just enough for the cutter to touch all of it.

    Parameters
    ----------
    feasibility : Feasibility

    Returns
    -------
    (k, 3) array of unit vectors, at most 4; none where normals spread too far, or are all alike.

    Notes
    -----
    **Properties**: 1. an axis makes angles with the sampled normals that are a degree, or three, smaller than the
    greatest at which the cutter touches, and with one of them just that; 2. the axes move with the face.
    """
    normals, mean = feasibility.normals.samples, feasibility.normals.mean
    size, directions = np.linalg.eigh(normals.T @ normals / len(normals))
    along = canonical_sign(directions[:, 0])
    out = mean - (mean @ along) * along
    if size[1] - size[0] < _APART or not (normals @ out > 0).all():
        return np.empty((0, 3))
    out /= np.linalg.norm(out)
    found = []
    for sense in (along, -along):
        x, y = normals @ sense, normals @ out
        for within in _WITHIN:
            least = np.minimum(cos(feasibility.greatest_angle - within) / np.hypot(x, y), 1.0)
            lift = float((np.arcsin(least) - np.arctan2(x, y)).max())
            if lift <= _FAR:
                found.append(np.cos(lift) * sense + np.sin(lift) * out)
    return np.array(found).reshape(-1, 3)
