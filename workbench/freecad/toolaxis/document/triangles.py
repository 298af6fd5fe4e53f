"""Triangles over the rays of a surface map."""

import numpy as np


def triangles_of(found):
    """Triangles over the rays of a surface map; those across gaps and beyond trims are left out.

    Parameters
    ----------
    found : toolaxis.verify.maps.SurfaceMap

    Returns
    -------
    (m, 3) array of int
        Rows of its points.
    """
    from scipy.spatial import Delaunay, QhullError

    d = found.face.evaluate(found.face.grid(8, 8))
    scale = [float(np.linalg.norm(rate, axis=1).mean()) for rate in (d.su, d.sv)]
    flat = found.uv * np.where(np.isfinite(scale) & (np.array(scale) > 0), scale, 1.0)
    try:
        triangle = Delaunay(flat).simplices
    except (QhullError, ValueError):  # fewer than three rays, or all on a line
        triangle = np.empty((0, 3), dtype=int)
    corner = found.point[triangle]
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    triangle = triangle[longest <= 3.0 * found.spacing]
    middle = found.uv[triangle].mean(axis=1) if len(triangle) else np.empty((0, 2))
    if len(middle):
        triangle = triangle[found.face.contains(middle)]
    return triangle[np.argsort(flat[triangle[:, 0], 0], kind="stable")]  # neighbours stay near one another
