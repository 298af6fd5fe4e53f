"""Proofs that no axis at all can machine a face with a tool."""

from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import DIVIDE, SMALLER_CORNER
from toolaxis.contact.clearance.branch_and_bound import BUDGET
from toolaxis.contact.clearance.queries import lower_bounds, motions
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.interference import FINE
from toolaxis.feasibility.surroundings import SKIN
from toolaxis.search.messages import format_apart, place
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Share of a face that must be tighter than the cutter for all of it to be called so.
_TIGHT = 0.9


def spread_too_wide(feasibility: Feasibility) -> str:
    """Whether the normals spread too far for any axis to see them all; the sentence that says so, or "".

    Parameters
    ----------
    feasibility : Feasibility

    Notes
    -----
    Exact for the sampled normals, each of which is a contact that has to be made: an axis within the greatest angle of
    all of them exists only if they fit into a cap of that radius.
    """
    cap, most = feasibility.normals.cap, feasibility.greatest_angle
    if cap.centre.any() and cap.radius <= most + 1e-9:
        return ""
    rim = feasibility.face.evaluate(feasibility.normals.kept[cap.rim]).point
    if cap.centre.any():
        angle, limit = format_apart(degrees(cap.radius), degrees(most), 1)
        size = f"up to {angle} deg to all sides of their middle"
    else:
        size, limit = "over more than a hemisphere", f"{degrees(most):.1f}"
    return (f"no single axis reaches all of face {feasibility.face.label}: its normals spread {size}, as at "
            f"{', '.join(place(p) for p in rim)}, and the cutter reaches {limit} deg from the axis; {DIVIDE} "
            "into sub-surfaces with an axis each (--regions N)")


def tight_fillet(face: Face, tool: Tool) -> str:
    """What to say of a face nearly all of which is a hollow tighter than the cutter; empty where it is not.

    Leaning, a cutter with a small corner reaches parts of such a face, in rags that are not worth their axes.

    Parameters
    ----------
    face : Face
    tool : Tool
    """
    bent = face.curvature(face.grid(12, 12)).k1
    if not len(bent) or (bent * tool.radius > 1).mean() <= _TIGHT:
        return ""
    return f"a concave fillet of {1 / np.median(bent):.2f} mm radius, tighter than the cutter's {tool.radius:g} mm"


def corner_depths(feasibility: Feasibility, points: Array, normals: Array) -> Array:
    """How deep the corner's ball goes into the face at contacts at least, whatever the axis, (n,) mm; 0 or less if not.

    Parameters
    ----------
    feasibility : Feasibility
    points, normals : (n, 3) array
        Contacts on the face.
    """
    tool, skin = feasibility.tool, feasibility.groups[0]
    radius = tool.corner_radius
    if radius <= 0 or skin.role != SKIN or tool.flute_length < 2 * radius:
        return np.zeros(len(points))
    centre = points + (radius + feasibility.allowance) * normals
    ball = Tool.ball(2 * radius, flute_length=1.0001 * radius)
    slack = max(face.tolerance for face in skin.faces) + 2 * FINE
    only = np.full((len(skin.faces), 3), -np.inf)
    only[[face.number in feasibility.face.numbers for face in skin.faces]] = 0.0
    found = lower_bounds(skin.cells, ball, motions(centre - radius * normals, normals), 0.0, FINE, only)
    return np.asarray(np.where(found.looked > BUDGET, 0.0, -found.lower[:, 0] - slack))


def corner_too_large(feasibility: Feasibility) -> str:
    """Whether the corner's ball alone, which every cutter holds at its contact, gouges; the sentence, or "".

    Parameters
    ----------
    feasibility : Feasibility

    Notes
    -----
    Whatever the axis, the cutter contains the ball of the corner radius that touches the surface at the contact.  Where
    the search for the depth was given up, its bound says nothing and no proof is drawn from it.  Faces that continue
    this one are left out: contacts beside them can be left as rest material.
    """
    some, limit = feasibility.dense, feasibility.tolerance.gouge
    if not len(some.uv):
        return ""
    depth = corner_depths(feasibility, some.point, some.normal)
    i = int(np.argmax(depth))
    if depth[i] <= limit:
        return ""
    deep, allowed = format_apart(float(depth[i]), limit, 3)
    radius, where = feasibility.tool.corner_radius, place(some.point[i])
    return (f"the corner radius {radius:g} mm gouges face {feasibility.face.label} by {deep} mm at {where} "
            f"with every axis; {allowed} mm is allowed: use {SMALLER_CORNER}")
