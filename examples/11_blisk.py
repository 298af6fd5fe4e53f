"""A blisk with 16 twisted blades as one solid with root fillets: look-alike of [zhu2016] Fig. 25.

Least gap between neighbouring blades 13.4 mm as in the original; all else is not published: blades of some 47 mm
between a conical hub and a cylindrical tip, leaning 28 degrees from the axis at the root and 55 at the tip, 5.0 mm
thick at the root and 2.8 at the tip.
"""

import numpy as np
from block import settled, write_facts
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt
from rotor import Rotor, bore, least_gap, ring_plane, sector, solid

BLADES = 16
HUB_RADIUS, HUB_SLOPE = 52.007, np.radians(6.0)
TIP_RADIUS, BORE, HALF_WIDTH = 102.0, 25.0, 25.0
FOOT, FILLET = 2.0, 3.5
AXIAL_ROOT, AXIAL_TIP = 34.0, 25.0
ANGLES_ROOT, ANGLES_TIP = np.radians((44.0, 12.0)), np.radians((62.0, 48.0))

#: Cutter, scallop height in mm, weights of the samples and what [zhu2016] Sec. 6.6 and Table 6 print for the original.
FACTS = {"look_alike": "zhu2016 Fig. 25", "tool": "torus:10x1", "scallop": 0.02, "weights": [0.7, 0.15, 0.15],
         "blades": BLADES, "least_gap": 13.4,
         "published": {"passes": [34, 25, 34, 33, 38, 41, 12, 12],
                       "axes": [[-0.735501, 0.654352, 0.175674], [-0.230669, -0.153449, 0.960856],
                                [0.116362, -0.516818, 0.84815], [0.543971, -0.068807, 0.836278],
                                [-0.262985, 0.80952, 0.524896], [-0.223237, 0.463047, 0.85776],
                                [-0.287711, 0.746861, 0.599517], [0.257789, -0.917348, 0.303344]]}}


def hub_radius(z):
    """Radius of the cone at a height."""
    return HUB_RADIUS + np.tan(HUB_SLOPE) * z


def root(t):
    """Meridian (r, z) of the blade's root, FOOT mm above the cone."""
    z = AXIAL_ROOT * (t - 0.5)
    return np.stack([hub_radius(z) + FOOT / np.cos(HUB_SLOPE), z], axis=-1)


def tip(t):
    """Meridian (r, z) of the blade's tip."""
    z = AXIAL_TIP * (t - 0.5)
    return np.stack([TIP_RADIUS + 0 * z, z], axis=-1)


def wrap(t, s):
    """Angle of the blade's middle: its angle to the axis changes evenly along the flow, and with the span."""
    first, last = (a + (b - a) * s for a, b in zip(ANGLES_ROOT, ANGLES_TIP, strict=True))
    length = AXIAL_ROOT + (AXIAL_TIP - AXIAL_ROOT) * s
    radius = HUB_RADIUS + FOOT + (TIP_RADIUS - HUB_RADIUS - FOOT) * s

    def along(x):
        return -np.log(np.cos(first + (last - first) * x)) / (last - first)

    return np.pi + length / radius * (along(t) - along(0.5))


def half(t, s):
    """Half of the blade's thickness."""
    return (2.5 - 1.1 * s) * (0.32 + 0.68 * 4 * t * (1 - t))


def above(points):
    """Height above the cone."""
    return (np.hypot(points[..., 0], points[..., 1]) - hub_radius(points[..., 2])) * np.cos(HUB_SLOPE)


def hub(t, angle):
    """Points of the cone; t as along the blade."""
    z = AXIAL_ROOT * (t - 0.5)
    return np.stack([hub_radius(z) * np.cos(angle), hub_radius(z) * np.sin(angle), z], axis=-1)


UP = gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0))
ENDS = (0.5 - HALF_WIDTH / AXIAL_ROOT, 0.5 + HALF_WIDTH / AXIAL_ROOT)
ROTOR = Rotor(BLADES, root, tip, wrap, half, (0.04, 0.96), FILLET, above, hub, ENDS,
              Geom_ConicalSurface(UP, HUB_SLOPE, HUB_RADIUS), Geom_CylindricalSurface(UP, TIP_RADIUS))


def blisk():
    """The whole part."""
    radii = [hub_radius(z) for z in (-HALF_WIDTH, HALF_WIDTH)]
    ends = [ring_plane(ROTOR, radius, end, z, BORE)
            for end, (radius, z) in enumerate(zip(radii, (-HALF_WIDTH, HALF_WIDTH), strict=True))]
    return solid(ROTOR, sector(ROTOR), [*ends, bore(BORE, -HALF_WIDTH, HALF_WIDTH)])


if __name__ == "__main__":
    gap, one, other = least_gap(ROTOR)
    print(f"least gap {gap:.4f} mm, from {np.round(one, 3)} to {np.round(other, 3)}")
    if abs(gap - FACTS["least_gap"]) > 1e-3:
        raise ValueError(f"least gap is {gap} mm: it must be {FACTS['least_gap']} mm; change HUB_RADIUS")
    write_facts("blisk", settled(blisk()), "made for this project", **FACTS)
