"""Every kind of kernel surface, made on purpose in awkward positions, against the kernel at random parameters."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import (
    Geom_BezierCurve,
    Geom_BezierSurface,
    Geom_BSplineCurve,
    Geom_Circle,
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_Ellipse,
    Geom_Hyperbola,
    Geom_Line,
    Geom_OffsetSurface,
    Geom_Parabola,
    Geom_Plane,
    Geom_RectangularTrimmedSurface,
    Geom_SphericalSurface,
    Geom_SurfaceOfLinearExtrusion,
    Geom_SurfaceOfRevolution,
    Geom_ToroidalSurface,
    Geom_TrimmedCurve,
)
from OCP.GeomAPI import GeomAPI_Interpolate
from OCP.GeomConvert import GeomConvert
from OCP.GeomLProp import GeomLProp_SLProps
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Dir, gp_Pnt

from toolaxis.cad.build_part import face_from_record
from toolaxis.cad.ocp.kernel_names import IntegerArray, PointArray, PointGrid, RealArray, SharedPointArray
from toolaxis.cad.ocp.reader import face_record, shape_record
from toolaxis.errors import InvalidInput, UnsupportedGeometry

FRAME = gp_Ax3(gp_Pnt(3, -2, 5), gp_Dir(1, 2, 3), gp_Dir(2, -1, 0.5))
LEFT_HANDED = gp_Ax3(gp_Pnt(3, -2, 5), gp_Dir(1, 2, 3), gp_Dir(2, -1, 0.5))
LEFT_HANDED.YReverse()
SMALL = gp_Ax2(gp_Pnt(20, 0, 1), gp_Dir(0, 1, 0.2), gp_Dir(1, 0, 0))


def points(rows, kind):
    array = kind(1, len(rows))
    for k, row in enumerate(rows):
        array.SetValue(k + 1, gp_Pnt(*map(float, row)))
    return array


def numbers(rows, kind):
    array = kind(1, len(rows))
    for k, value in enumerate(rows):
        array.SetValue(k + 1, value)
    return array


def bspline_curve():
    poles = [(20, 0, 0), (22, 1, 3), (19, 2, 6), (21, 0, 9), (23, 0, 12)]
    weights, knots = ([1.0, 2.0, 0.5, 1.5, 1.0], [0.0, 0.3, 2.0])
    return Geom_BSplineCurve(points(poles, PointArray), numbers(weights, RealArray),
                             numbers(knots, RealArray), numbers([4, 1, 4], IntegerArray), 3)


def periodic_curve():
    ring = [(20 + 3 * np.cos(a), 0.3 * np.sin(2 * a), 2 * np.sin(a)) for a in np.arange(5) * 2 * np.pi / 5]
    fit = GeomAPI_Interpolate(points(ring, SharedPointArray), True, 1e-9)
    fit.Perform()
    return fit.Curve()


CURVES = {
    "line": (lambda: Geom_Line(gp_Pnt(20, 1, 0), gp_Dir(0.3, 0.1, 1)), -3.0, 8.0),
    "circle": (lambda: Geom_Circle(SMALL, 4.0), -1.0, 3.5),
    "ellipse": (lambda: Geom_Ellipse(SMALL, 5.0, 2.0), 2.0, 8.0),
    "parabola": (lambda: Geom_Parabola(SMALL, 1.5), -2.0, 3.0),
    "bspline": (bspline_curve, 0.0, 2.0),
    "bezier": (lambda: Geom_BezierCurve(points([(20, 0, 0), (25, 1, 3), (19, 2, 6)], PointArray)), 0.0, 1.0),
    "periodic": (periodic_curve, 4.0, 7.5),
    "hyperbola": (lambda: Geom_Hyperbola(SMALL, 3.0, 2.0), -0.8, 1.0),
}


def bezier_surface():
    grid = PointGrid(1, 4, 1, 3)
    for i in range(4):
        for j in range(3):
            grid.SetValue(i + 1, j + 1, gp_Pnt(10.0 * i, 8.0 * j, float((i - 1.5) ** 2 - 2 * j)))
    surface = Geom_BezierSurface(grid)
    surface.SetWeight(2, 2, 1.7)
    return surface


def extrusion(name):
    make, low, high = CURVES[name]
    return Geom_SurfaceOfLinearExtrusion(make(), gp_Dir(0.2, 1, 0.1)), (low, high, -4.0, 9.0)


def revolution(name, low=5.0, high=8.5):
    make, v0, v1 = CURVES[name]
    curve = Geom_TrimmedCurve(make(), v0, v1) if name in ("line", "parabola", "hyperbola") else make()
    axis = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0.1, -0.2, 1))
    return Geom_SurfaceOfRevolution(curve, axis), (low, high, v0, v1)


CASES = {
    "plane": lambda: (Geom_Plane(FRAME), (-3.0, 8.0, 2.0, 9.0)),
    "left-handed plane": lambda: (Geom_Plane(LEFT_HANDED), (-3.0, 8.0, 2.0, 9.0)),
    "cylinder over the seam": lambda: (Geom_CylindricalSurface(FRAME, 7.0), (5.5, 8.0, -3.0, 4.0)),
    "left-handed cylinder": lambda: (Geom_CylindricalSurface(LEFT_HANDED, 7.0), (0.1, 6.0, -3.0, 4.0)),
    "whole cylinder": lambda: (Geom_CylindricalSurface(FRAME, 7.0), (0.0, 2 * np.pi, -3.0, 4.0)),
    "cone": lambda: (Geom_ConicalSurface(FRAME, 0.4, 6.0), (-1.0, 2.0, -2.0, 5.0)),
    "cone to its apex": lambda: (Geom_ConicalSurface(FRAME, -0.4, 6.0), (0.5, 2.0, 0.0, 6.0 / np.sin(0.4))),
    "sphere": lambda: (Geom_SphericalSurface(FRAME, 9.0), (1.0, 4.0, -0.4, 1.2)),
    "sphere to its pole": lambda: (Geom_SphericalSurface(LEFT_HANDED, 9.0), (1.0, 4.0, 0.2, np.pi / 2)),
    "torus": lambda: (Geom_ToroidalSurface(FRAME, 9.0, 2.0), (5.0, 7.5, 4.0, 9.0)),
    "bezier": lambda: (bezier_surface(), (0.0, 1.0, 0.0, 1.0)),
    **{f"extruded {name}": (lambda name=name: extrusion(name)) for name in CURVES},
    **{f"revolved {name}": (lambda name=name: revolution(name)) for name in CURVES},
    "offset of a spline": lambda: (Geom_OffsetSurface(bezier_surface(), 2.0), (0.0, 1.0, 0.0, 1.0)),
    "trimmed torus": lambda: (Geom_RectangularTrimmedSurface(Geom_ToroidalSurface(FRAME, 9.0, 2.0), 1.0, 2.0, 3.0, 5.0),
                              (1.0, 2.0, 3.0, 5.0)),
}
APPROXIMATED = {"extruded hyperbola", "revolved hyperbola", "offset of a spline"}


def xyz(p):
    return np.array([p.X(), p.Y(), p.Z()])


@pytest.fixture(params=CASES)
def made(request):
    surface, box = CASES[request.param]()
    kernel_face = BRepBuilderAPI_MakeFace(surface, *box, 1e-9).Face()
    record, warnings = face_record(kernel_face)
    assert warnings == []
    return request.param, surface, box, record, face_from_record(record)


def test_points_normals_and_curvatures_are_those_of_the_kernel(made):
    name, surface, box, record, face = made
    rng = np.random.default_rng(5)
    kernel_uv = np.column_stack([rng.uniform(*box[:2], 40), rng.uniform(*box[2:], 40)])
    uv = record.map.to_ours(kernel_uv)
    assert face.contains(uv).all()
    d, normal, curvature = face.evaluate(uv), face.normal(uv), face.curvature(uv)
    loose = face.tolerance > 0
    assert loose == (name in APPROXIMATED)
    for k in range(40):
        props = GeomLProp_SLProps(surface, *map(float, kernel_uv[k]), 2, 1e-15)
        assert np.linalg.norm(d.point[k] - xyz(props.Value())) <= (face.tolerance if loose else 1e-12 * face.diagonal)
        if not props.IsCurvatureDefined():
            continue
        out = np.cross(xyz(props.D1U()), xyz(props.D1V()))
        assert np.linalg.norm(normal[k] - out / np.linalg.norm(out)) <= (1e-4 if loose else 1e-9)
        theirs = props.MaxCurvature(), props.MinCurvature()
        scale = max(*map(abs, theirs), 1 / face.diagonal)
        assert np.abs(np.array([curvature.k1[k], curvature.k2[k]]) - theirs).max() <= (1e-2 if loose else 1e-8) * scale


def test_a_natural_rectangle_needs_no_loops_and_maps_there_and_back(made):
    _, _, box, record, face = made
    assert face.trims == ()
    u0, u1, v0, v1 = face.bounds
    assert (u1 - u0, v1 - v0) == pytest.approx((box[1] - box[0], box[3] - box[2]), rel=1e-9)
    corners = np.array([[u, v] for u in (u0, u1) for v in (v0, v1)])
    assert np.abs(record.map.to_ours(corners) - corners).max() < 1e-9
    inner = np.random.default_rng(1).uniform([u0, v0], [u1, v1], (20, 2))
    assert np.abs(record.map.to_kernel(record.map.to_ours(inner)) - inner).max() < 1e-12 * (1 + np.abs(box).max())


def test_an_approximation_states_a_bound_that_is_small():
    surface, box = CASES["offset of a spline"]()
    record, _ = face_record(BRepBuilderAPI_MakeFace(surface, *box, 1e-9).Face())
    assert 0 < record.tolerance < 1e-3
    assert record.kind == "offset"


def test_a_reversed_face_is_flipped():
    surface, box = CASES["torus"]()
    kernel_face = BRepBuilderAPI_MakeFace(surface, *box, 1e-9).Face()
    assert face_record(kernel_face)[0].flip is False
    assert face_record(kernel_face.Reversed())[0].flip is True


def test_a_face_that_is_only_a_mesh_is_named_as_such():
    from OCP.BRep import BRep_Builder
    from OCP.Poly import Poly_Triangle, Poly_Triangulation
    from OCP.TopoDS import TopoDS_Face

    mesh = Poly_Triangulation(3, 1, False)
    for k, p in enumerate([(0, 0, 0), (1, 0, 0), (0, 1, 0)]):
        mesh.SetNode(k + 1, gp_Pnt(*p))
    mesh.SetTriangle(1, Poly_Triangle(1, 2, 3))
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, mesh)
    with pytest.raises(UnsupportedGeometry, match="mesh but no surface"):
        face_record(face)
    with pytest.raises(UnsupportedGeometry, match="none of the part's 1 faces"):
        shape_record(face)


def test_an_endless_plane_is_refused():
    with pytest.raises(UnsupportedGeometry, match="no end"):
        shape_record(BRepBuilderAPI_MakeFace(Geom_Plane(FRAME), 1e-9).Face())


def test_nothing_is_refused():
    from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape

    with pytest.raises(InvalidInput, match="empty"):
        shape_record(TopoDS_Shape())
    with pytest.raises(InvalidInput):
        shape_record(TopoDS_Compound())


def test_a_periodic_surface_is_unrolled_over_its_seam():
    """A face on a closed, periodic B-spline that straddles the end of the period."""
    ring = Geom_SurfaceOfLinearExtrusion(periodic_curve(), gp_Dir(0, 1, 0))
    closed = GeomConvert.SurfaceToBSplineSurface_s(Geom_RectangularTrimmedSurface(ring, 0.0, 5.0, False))
    if not closed.IsUPeriodic():
        closed.SetUPeriodic()
    low, high = closed.UKnot(1), closed.UKnot(closed.NbUKnots())
    period = high - low
    face = BRepBuilderAPI_MakeFace(closed, high - 0.3 * period, high + 0.4 * period, 0.5, 4.0, 1e-9).Face()
    ours = face_from_record(face_record(face)[0])
    u0, u1, _, _ = ours.bounds
    assert u1 - u0 == pytest.approx(0.7 * period, rel=1e-9)
    uv = np.random.default_rng(0).uniform([u0, 0.5], [u1, 4.0], (30, 2))
    theirs = np.array([xyz(closed.Value(float(u), float(v))) for u, v in uv])
    assert np.abs(ours.evaluate(uv).point - theirs).max() < 1e-12
