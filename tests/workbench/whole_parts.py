"""Small whole parts for the tests: a roof that two axes suit better than one, and a wheel with a few blades."""

from math import exp, pi, sin

import Part as FreecadPart
from FreeCAD import Vector

BLADE_TOOL = {"tool": "torus:6x1", "stickout": 40.0, "holder": ((8.0, 0.0), (8.0, 30.0)), "scallop": 0.3}

#: Two ball ends with holders, of which the larger one does not reach the bottom of the groove of `grooved`.
RACK = """
[holders.SLIM]
holder = [[8.0, 0.0], [8.0, 30.0]]

[[tool]]
number = 1
title = "Ball D20, 60 out"
kind = "ball"
diameter = 20.0
stickout = 60.0
holder = "SLIM"
feedrate = 1500.0
spindle = 6000.0

[[tool]]
number = 7
title = "Ball D6, 40 out"
kind = "ball"
diameter = 6.0
stickout = 40.0
holder = "SLIM"
"""


def interpolated(rows):
    surface = FreecadPart.BSplineSurface()
    surface.interpolate(rows)
    return surface.toShape()


def block_under(document, top, name):
    """A block under a surface, and the name of its upper face."""
    thing = document.addObject("Part::Feature", name)
    thing.Shape = top.extrude(Vector(0, 0, -25)).common(FreecadPart.makeBox(80, 60, 40, Vector(-20, -20, 0)))
    document.recompute()
    kinds = [type(face.Surface).__name__ for face in thing.Shape.Faces]
    return thing, f"Face{kinds.index('BSplineSurface') + 1}"


def roof(document, name="Roof"):
    """A block whose top falls to both sides of a ridge, waved; the name of that face beside it."""
    return block_under(document, interpolated([[Vector(x, y, 14 - 0.035 * (x - 14) ** 2 + 0.3 * sin(y / 5))
                                                for y in range(0, 17, 4)] for x in range(0, 29, 4)]), name)


def wave(document, name="Wave"):
    """A block whose top rises, falls and rises, so that several axes take less cutting than one."""
    return block_under(document, interpolated([[Vector(x, y, 14 + 4 * sin(pi * x / 15)) for y in (0, 3, 6, 9)]
                                               for x in range(0, 31, 3)]), name)


def grooved(document, name="Grooved"):
    """A block with a gentle top in which a narrow groove runs; the name of that face beside it."""
    return block_under(document, interpolated([[Vector(x, y, 12 - 0.004 * (x - 30) ** 2 - 4 * exp(-((x - 30) / 5) ** 2))
                                                for y in (0, 13, 26, 40)] for x in range(0, 61, 2)]), name)


def three_patches(document, name="Patches"):
    """Two patches that continue each other smoothly, and a third one beside them; a sheet."""
    bounds = (0, 16), (16, 32), (40, 60)
    faces = [interpolated([[Vector(x, y, 0.05 * x + 0.4 * sin(y / 5)) for y in range(0, 17, 4)]
                           for x in range(low, high + 1, 4)]) for low, high in bounds]
    thing = document.addObject("Part::Feature", name)
    thing.Shape = FreecadPart.Compound(faces)
    document.recompute()
    return thing


def wheel(document, count=3, name="Wheel"):
    """Thin blades with two sculptured sides around a cylinder."""
    faces = [face for face in FreecadPart.makeCylinder(12, 16, Vector(0, 0, -8)).Faces
             if type(face.Surface).__name__ == "Cylinder"]
    for k in range(count):
        for bulge, flip in ((2.0, False), (0.5, True)):
            face = interpolated([[Vector(x, bulge * (1 - (z / 6) ** 2) + 0.02 * (x - 20) * z, z)
                                  for x in (20, 23.333, 26.667, 30)] for z in (-6, -3, 0, 3, 6)])
            if flip:
                face.reverse()
            faces.append(face.rotated(Vector(), Vector(0, 0, 1), 360 * k / count))
    thing = document.addObject("Part::Feature", name)
    thing.Shape = FreecadPart.Compound(faces)
    document.recompute()
    return thing
