"""Figures of a face at one axis, taken alike outside and inside FreeCAD."""

import math

import numpy as np

import toolaxis as ta


def evaluated(part, number, short, scallop):
    """Strip widths, gouges, clearances, counts and passes of a face at its mean normal, leant by 10 degrees.

    Parameters
    ----------
    part : ta.Part
    number : int
    short : str
        The tool's short form.
    scallop : float
    """
    face, tool = part.face(number), ta.Tool.parse(short)
    uv = face.grid(5, 5)
    normals = face.normal(face.grid(15, 15))
    mean = normals.mean(axis=0) / np.linalg.norm(normals.mean(axis=0))
    aside = np.cross(mean, np.eye(3)[int(np.argmin(np.abs(mean)))])
    axis = mean * math.cos(math.radians(10)) + aside / np.linalg.norm(aside) * math.sin(math.radians(10))
    path = ta.passes(face, tool, axis, scallop)
    return {
        "axis": axis.tolist(),
        "strip width": np.nan_to_num(ta.strip_width(face, tool, uv, axis, scallop)).ravel().tolist(),
        "gouge": ta.gouge(face, tool, uv, axis, part.skin(number)).tolist(),
        "clearance": np.clip(ta.clearance(face, tool, uv, axis, part.surroundings(number)), -100, 100).tolist(),
        "count": [ta.count(face, tool, axis, scallop, feed) for feed in ("u", "v")],
        "length": [path.length()],
        "passes": [path.passes],
    }
