"""A radial impeller with nine twisted blades as one solid with root fillets, 140 mm across.

Its own design, for [zhu2016] has none: flow from the axis outwards over a hub that is a piece of a torus, blades with a
back sweep, 15 mm high where the flow comes in and 9 mm where it leaves.
"""

import numpy as np
from block import settled, write_facts
from OCP.Geom import Geom_ToroidalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt
from rotor import Rotor, bore, least_gap, rim, ring_plane, sector, solid

BLADES = 9
#: Meridians of hub and tip: circles around (r, z) = (CENTRE, height).
CENTRE, HUB_RADIUS, HUB_HEIGHT, TIP_RADIUS, TIP_HEIGHT = 70.0, 50.0, 50.0, 33.0, 42.0
ANGLES_ROOT, ANGLES_TIP = np.radians((14.0, 85.0)), np.radians((5.0, 85.0))
#: Change of the blade's angle about the axis with t, where the flow comes in and where it leaves, at root and tip.
TURN_IN, TURN_OUT = (2.2, 2.0), (0.75, 0.75)
FOOT, FILLET, BORE, BOTTOM = 1.0, 2.0, 8.0, -4.0

#: Cutter and scallop height in mm.
FACTS = {"look_alike": "none: own design", "tool": "torus:6x1", "scallop": 0.02, "blades": BLADES}


def meridian(radius, height, angles, t):
    """Rows (r, z) of a circle's arc."""
    angle = angles[0] + (angles[1] - angles[0]) * t
    return np.stack([CENTRE - radius * np.cos(angle), height - radius * np.sin(angle)], axis=-1)


def root(t):
    """Meridian of the blade's root, FOOT mm above the hub."""
    return meridian(HUB_RADIUS - FOOT, HUB_HEIGHT, ANGLES_ROOT, t)


def tip(t):
    """Meridian of the blade's tip."""
    return meridian(TIP_RADIUS, TIP_HEIGHT, ANGLES_TIP, t)


def wrap(t, s):
    """Angle of the blade's middle; all of the trailing edge stands at one angle."""
    first, last = (a + (b - a) * s for a, b in (TURN_IN, TURN_OUT))
    return np.pi + last * (t - 1) - (first - last) * (1 - t) ** 3 / 3


def half(t, s):
    """Half of the blade's thickness."""
    return (1.4 - 0.6 * s) * (0.4 + 0.6 * 4 * t * (1 - t))


def above(points):
    """Height above the hub."""
    return HUB_RADIUS - np.hypot(np.hypot(points[..., 0], points[..., 1]) - CENTRE, points[..., 2] - HUB_HEIGHT)


def hub(t, angle):
    """Points of the hub; t as along the blade."""
    r, z = np.moveaxis(meridian(HUB_RADIUS, HUB_HEIGHT, ANGLES_ROOT, t), -1, 0)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)


def torus(height, radius):
    """A kernel torus about the axis."""
    return Geom_ToroidalSurface(gp_Ax3(gp_Pnt(0, 0, height), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)), CENTRE, radius)


ENDS = tuple((np.array([0.0, np.pi / 2]) - ANGLES_ROOT[0]) / (ANGLES_ROOT[1] - ANGLES_ROOT[0]))
ROTOR = Rotor(BLADES, root, tip, wrap, half, (0.02, 0.98), FILLET, above, hub, ENDS, torus(HUB_HEIGHT, HUB_RADIUS),
              torus(TIP_HEIGHT, TIP_RADIUS), along=13)


def impeller():
    """The whole part."""
    front = ring_plane(ROTOR, CENTRE - HUB_RADIUS, 0, HUB_HEIGHT, BORE)
    back = ring_plane(ROTOR, CENTRE, 1, BOTTOM, BORE)
    return solid(ROTOR, sector(ROTOR, [rim(ROTOR, 1, BOTTOM)]), [front, back, bore(BORE, BOTTOM, HUB_HEIGHT)])


if __name__ == "__main__":
    gap, one, other = least_gap(ROTOR)
    print(f"least gap {gap:.4f} mm, from {np.round(one, 3)} to {np.round(other, 3)}")
    write_facts("impeller", settled(impeller()), "made for this project", **FACTS)
