"""How far a ball end leans from the normals where it touches the faces it machines: from CL data and faces alone."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.numeric.vectors import angle_between, dot, unit
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.tools.profile import Profile

Array = NDArray[np.float64]

#: Leans are measured to this, rad.
UNCERTAINTY = 1e-4
#: A ball touches a face where the way from the nearest point to its centre is normal to the face up to this, rad:
#: beyond a border it points to the border.
_ALIGNED = 1e-3
#: Places on each motion, as shares of it, besides its end.
_ON_MOTION = (0.25, 0.5, 0.75)


class ContactLean(NamedTuple):
    """The least lean of a ball end.

    angle : float, rad, of its axis from the normal at a contact;  face : label;  point : the contact, mm;
    motion : int, index of the cutter location at which the motion arrives.
    """

    angle: float
    face: str
    point: tuple[float, float, float]
    motion: int


def least_lean(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, faces: Sequence[Face],
               heights: tuple[float, float]) -> ContactLean | None:
    """The least angle between a ball end's axis and the normal at its contacts with faces.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        Cutter locations, mm, and unit axes.
    profile : Profile
        With a ball end.
    faces : sequence of Face
        What is machined.
    heights : (float, float)
        Stock that is left on them, and how high above that the ball still cuts, mm.

    Returns
    -------
    ContactLean, or None where it touches none of the faces.

    Notes
    -----
    The centre of a ball lies over its contact, along the normal there: the point of a face nearest to the centre is the
    contact.  Cutting motions are looked at where they begin and end, and at places between.

    **Properties**: 1. moving faces and cutter locations together changes nothing; 2. on a plane it is the angle of the
    axis to its normal.
    """
    tips, axes, arrival = _positions(*cl)
    if not len(tips):
        return None
    radius, (allowance, above) = profile.corner_radius, heights
    centres = tips + radius * axes
    found = [nearest(face, centres) for face in faces]
    which = np.argmin([one.distance for one in found], axis=0)
    best: ContactLean | None = None
    for number, (face, one) in enumerate(zip(faces, found, strict=True)):
        rows = np.flatnonzero((which == number) & (one.distance <= radius + allowance + above) & (one.distance > 0))
        normal = face.normal(one.uv[rows])
        aligned = dot(centres[rows] - one.point[rows], normal) >= np.cos(_ALIGNED) * one.distance[rows]
        rows, normal = rows[aligned], normal[aligned]
        if not len(rows):
            continue
        angles = np.asarray(angle_between(axes[rows], normal))
        i = int(np.argmin(angles))
        if best is None or angles[i] < best.angle:
            x, y, z = (float(value) for value in one.point[rows[i]])
            best = ContactLean(float(angles[i]), face.label, (x, y, z), int(arrival[rows[i]]))
    return best


def _positions(tips: Array, axes: Array, kind: NDArray[np.int8]) -> tuple[Array, Array, NDArray[np.int64]]:
    """Tips, axes and arriving motions of places on the cutting motions, (m, 3), (m, 3), (m,)."""
    end = np.flatnonzero(kind[1:] == Motion.CUT) + 1
    share = np.tile((0.0, *_ON_MOTION, 1.0), len(end))[:, None]
    arrival = np.repeat(end, len(_ON_MOTION) + 2)
    before, after = arrival - 1, arrival
    at = tips[before] + share * (tips[after] - tips[before])
    turned = axes[before] + share * (axes[after] - axes[before])
    return at, np.asarray(unit(turned)) if len(turned) else turned, arrival
