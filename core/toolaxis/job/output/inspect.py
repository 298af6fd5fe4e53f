"""A survey of a part's faces: what they are and how they bend, before anything is planned."""

from dataclasses import dataclass

import numpy as np

from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.shape.face import Face
from toolaxis.shape.part import PLAIN_KINDS, Part

_GRID = 32
#: Curvatures below this share of one over the face's size count as flat.
_FLAT = 1e-6


@dataclass(frozen=True)
class FaceSummary:
    """One face in numbers; lengths in mm, angles in rad.

    Attributes
    ----------
    number : int
    kind : str
    sculptured : bool
    area : float
    size : (float, float, float)
        Sides of the box around it, along x, y and z.
    convex_radius, concave_radius : float or None
        Least radius of curvature where the face bends away from the tool and towards it; None where it does not.
    spread : float
        Half angle of the smallest cone that holds all normals; pi / 2 where no hemisphere does.
    holes : int
        Inner loops.
    pieces : int
        Smooth pieces between kinks along u and v.
    tolerance : float
        Bound of the distance to the CAD face; 0 where the conversion is exact.
    """

    number: int
    kind: str
    sculptured: bool
    area: float
    size: tuple[float, float, float]
    convex_radius: float | None
    concave_radius: float | None
    spread: float
    holes: int
    pieces: int
    tolerance: float


def survey(part: Part) -> tuple[FaceSummary, ...]:
    """Summaries of all faces, from 32 x 32 sampled places of each and its border.

    Parameters
    ----------
    part : Part
    """
    return tuple(_summary(face) for face in part.faces)


def _summary(face: Face) -> FaceSummary:
    uv = np.concatenate([face.grid(_GRID, _GRID), *face.outline])
    normals = face.normal(uv)
    sound = np.linalg.norm(normals, axis=1) > 0.5
    curvature = face.curvature(uv[sound])
    size = face.box[1] - face.box[0]
    flat = _FLAT / max(face.diagonal, 1e-12)
    low = float(np.min(curvature.k2[np.isfinite(curvature.k2)], initial=0.0))
    high = float(np.max(curvature.k1[np.isfinite(curvature.k1)], initial=0.0))
    return FaceSummary(face.number, face.kind, face.kind not in PLAIN_KINDS, face.area,
                       (float(size[0]), float(size[1]), float(size[2])), -1 / low if low < -flat else None,
                       1 / high if high > flat else None,
                       smallest_cap(normals[sound]).radius if sound.any() else np.pi / 2,
                       max(0, len(face.trims) - 1), (len(face.kinks[0]) + 1) * (len(face.kinks[1]) + 1),
                       face.tolerance)
