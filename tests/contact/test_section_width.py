"""Strip width of the standing cutter: its section by brute force, the expected range, and what motions change."""

import numpy as np
import pytest

from toolaxis.contact.frame import axis_from_lean, contact_frame
from toolaxis.contact.placement import place
from toolaxis.contact.strip.cutter_parameters import cutter_parameters
from toolaxis.contact.strip.second_order import contact_forms, relative_forms
from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import InvalidInput
from toolaxis.shape.analytic import CylindricalSurface, PlanarSurface
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.section_width import expect_widths, section_width
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(10, 3)
FACES = {"plane": Face(PlanarSurface((-30.0, 30.0), (-30.0, 30.0)).nurbs()),
         "hollow cylinder": Face(CylindricalSurface(40.0, (-1.0, 1.0), (-30.0, 30.0)).nurbs(), flip=True),
         "convex cylinder": Face(CylindricalSurface(40.0, (-1.0, 1.0), (-30.0, 30.0)).nurbs())}


def _section(face, tool, uv, axis, scallop, feed, side):
    """End of the strip on one side: the torus, met by the line along the normal at places ever farther out."""
    frame = contact_frame(face, uv, feed)
    tip = place(face, tool, uv, axis)[0]
    a, r = tool.flat_radius, tool.corner_radius
    origin = face.evaluate(uv).point[0]

    def inside(distance):
        at = uv.copy()
        for _ in range(30):
            d = face.evaluate(at)
            off = d.point[0] - origin
            matrix = np.array([[d.su[0] @ frame.feed[0], d.sv[0] @ frame.feed[0]],
                               [d.su[0] @ frame.left[0], d.sv[0] @ frame.left[0]]])
            at = at - np.linalg.solve(matrix, [off @ frame.feed[0], off @ frame.left[0] - distance])[None]
        q = face.evaluate(at).point[0] + scallop * face.normal(at)[0] - tip - r * axis[0]
        z = q @ axis[0]
        rho = np.sqrt(q @ q - z * z)
        return (rho - a) ** 2 + z * z <= r * r or (rho <= a and abs(z) <= r) or (z > 0 and rho < a + r)

    low, high = 0.0, 0.05
    while inside(side * high):
        low, high = high, high + 0.05
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if inside(side * middle) else (low, middle)
    return low


@pytest.mark.parametrize("name", FACES)
@pytest.mark.parametrize("direction", [0.0, 0.5, -2.8, np.pi / 2])
def test_the_ends_are_those_of_the_torus(name: str, direction: float) -> None:
    face = FACES[name]
    uv = face.grid(7, 7)[24:25]
    axis = axis_from_lean(contact_frame(face, uv, "v"), np.radians(22.0), direction)
    found = section_width(face, TOOL, uv, axis, 0.1, "v")[0]
    brute = [_section(face, TOOL, uv, axis, 0.1, "v", side) for side in (1, -1)]
    assert np.abs(found - brute).max() < 2e-5


def test_the_expected_range_of_the_paper() -> None:
    low, high = expect_widths(TOOL, np.radians(20.0), 0.1)
    assert (round(low, 4), round(high, 4)) == (2.1529, 3.1529)


def test_small_heights_follow_the_curvature_across_the_feed() -> None:
    face = FACES["hollow cylinder"]
    uv = face.grid(5, 5)
    axis = axis_from_lean(contact_frame(face, uv, "u"), np.radians(25.0), 0.6)
    forms = contact_forms(face, uv, "u", False)
    frame = contact_frame(face, uv, "u")
    parts = (axis * frame.feed).sum(1), (axis * frame.left).sum(1)
    kk = relative_forms(forms, parts, cutter_parameters(TOOL, 0.1, 0.0))[2]
    error = [np.abs(section_width(face, TOOL, uv, axis, h, "u").sum(1) / (2 * np.sqrt(2 * h / kk)) - 1).max()
             for h in (4e-3, 1e-3)]
    assert error[1] < 2e-3 and error[1] < error[0] / 2.5


def test_on_a_plane_it_is_never_wider_than_what_passes_leave_and_even_for_a_lean_along_the_feed() -> None:
    face = FACES["plane"]
    uv = np.zeros((9, 2))
    direction = np.linspace(-np.pi / 2, np.pi / 2, 9)
    axis = axis_from_lean(contact_frame(face, uv, "u"), np.radians(20.0), direction)
    stands, swept = section_width(face, TOOL, uv, axis, 0.1), strip_width(face, TOOL, uv, axis, 0.1)
    assert (stands <= swept + 1e-6).all()
    assert np.allclose(stands[4, 0], stands[4, 1], atol=1e-9)
    assert stands.sum(1).argmax() == 4
    assert np.allclose(stands[::-1, ::-1], stands, atol=1e-6)  # a mirror exchanges left and right


def test_it_grows_as_the_lean_falls() -> None:
    face = FACES["plane"]
    uv = np.zeros((30, 2))
    axis = axis_from_lean(contact_frame(face, uv, "u"), np.radians(np.linspace(5, 60, 30)), 0.0)
    assert (np.diff(section_width(face, TOOL, uv, axis, 0.1).sum(1)) < 0).all()


def test_a_motion_changes_nothing_and_a_scale_scales() -> None:
    rng = np.random.default_rng(3)
    face = Face.from_bspline(rng.normal(size=(5, 5, 1)) * [0, 0, 1.2] + np.stack(np.meshgrid(
        np.linspace(-20, 20, 5), np.linspace(-20, 20, 5), [0.0], indexing="ij"), -1)[:, :, 0])
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    points = np.asarray(face.surface.control)[..., :3]
    moved = Face.from_bspline(points @ turn.T + [3, -8, 5.0])
    large = Face.from_bspline(2.5 * points)
    uv = face.grid(5, 5)
    axis = axis_from_lean(contact_frame(face, uv, "u"), np.radians(25.0), 0.4)
    found = section_width(face, TOOL, uv, axis, 0.1)
    assert np.allclose(section_width(moved, TOOL, uv, axis @ turn.T, 0.1), found, atol=1e-9)
    assert np.allclose(section_width(large, Tool.torus(25, 7.5), uv, axis, 0.25), 2.5 * found, atol=1e-8)


def test_bad_input() -> None:
    with pytest.raises(InvalidInput, match="the radius of the cutter"):
        section_width(FACES["plane"], Tool.ball(8), [[0, 0]], [0, 0, 1], 0.1)
    with pytest.raises(InvalidInput, match="scallop height"):
        section_width(FACES["plane"], TOOL, [[0, 0]], [0, 0, 1], 0.0)
    with pytest.raises(InvalidInput, match="between 0 and 90"):
        expect_widths(TOOL, 0.0, 0.1)
