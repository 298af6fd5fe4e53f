"""Kernel shapes out: valid faces of the same area and border, poles and holes too, and edges that are polylines."""

import numpy as np
import pytest

from toolaxis.cad import load
from toolaxis.errors import InvalidInput

pytest.importorskip("OCP")

from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakeSphere, BRepPrimAPI_MakeTorus
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp_Explorer

from toolaxis.cad.ocp.export import face_shape, polyline_edge
from toolaxis.cad.ocp.kernel_names import as_edge
from toolaxis.cad.step.worker import read_shape


def area(shape):
    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, found, 1e-7)
    return found.Mass()


def edges(shape):
    explorer, found = TopExp_Explorer(shape, TopAbs_EDGE), []
    while explorer.More():
        found.append(BRepAdaptor_Curve(as_edge(explorer.Current())))
        explorer.Next()
    return found


def check(face, rel):
    made = face_shape(face)
    assert made.ShapeType() == TopAbs_FACE and BRepCheck_Analyzer(made).IsValid()
    assert area(made) == pytest.approx(face.area, rel=rel)
    back = load(made).faces[0]
    ours, theirs = (one.normal(one.grid(9, 9)).mean(axis=0) for one in (face, back))
    assert theirs == pytest.approx(ours, abs=0.02)
    return made


@pytest.mark.parametrize("solid", [
    pytest.param(lambda: BRepPrimAPI_MakeSphere(10.0).Shape(), id="sphere"),
    pytest.param(lambda: BRepPrimAPI_MakeSphere(10.0, 0.3, np.pi / 2, 2.0).Shape(), id="part of a sphere"),
    pytest.param(lambda: BRepPrimAPI_MakeTorus(20.0, 5.0).Shape(), id="torus"),
    pytest.param(lambda: BRepPrimAPI_MakeCone(10.0, 0.0, 12.0).Shape(), id="cone"),
])
def test_faces_of_solids_come_back_with_their_area_and_side(solid):
    for face in load(solid()).faces:
        check(face, 1e-4)


def test_trimmed_faces_and_holes_come_back(block_shape):
    for face in load(block_shape).faces:
        check(face, 1e-4)


def test_a_wavy_border_keeps_to_its_loop_takes_few_edges_and_survives_step(tmp_path, write_step):
    """A sub-surface cut out of a doubly curved face: two long curves and a hole."""
    import toolaxis as ta

    x, y = np.meshgrid(np.linspace(0, 60, 7), np.linspace(0, 40, 7), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 4 * np.sin(x / 14) * np.cos(y / 11)], axis=-1))
    t = np.linspace(0, 1, 300)
    outer = np.vstack([np.stack([0.1 + 0.8 * t, 0.15 + 0.08 * np.sin(9 * t)], 1),
                       np.stack([0.9 - 0.8 * t, 0.85 + 0.05 * np.cos(7 * t)], 1)])
    ring = 0.5 + 0.15 * np.stack([np.cos(-2 * np.pi * t[:-1]), np.sin(-2 * np.pi * t[:-1])], 1)
    piece = face.trimmed([outer, ring])
    made = check(piece, 2e-5)
    curves = edges(made)
    assert len(curves) <= 8
    exact = face.evaluate(np.vstack([outer, ring])).point
    ends = [(c.FirstParameter(), c.LastParameter()) for c in curves]
    points = [c.Value(t) for c, (a, b) in zip(curves, ends, strict=True) for t in np.linspace(a, b, 2000)]
    places = np.array([[p.X(), p.Y(), p.Z()] for p in points])
    gap = np.linalg.norm(places[:, None, :] - exact[None, ::23], axis=2).min(axis=0)
    assert gap.max() < 0.03  # the samples on the curves are 0.05 mm apart
    corners = face.evaluate(outer[[0, 299, 300, 599]]).point
    assert np.linalg.norm(places[:, None, :] - corners[None], axis=2).min(axis=0).max() < 1e-6
    again = read_shape(str(write_step(made, tmp_path / "piece.step")))[0]
    assert area(again) == pytest.approx(piece.area, rel=2e-5)


def test_a_corner_in_the_border_stays_sharp():
    import toolaxis as ta

    x, y = np.meshgrid(np.linspace(0, 30, 5), np.linspace(0, 30, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0 * x], axis=-1))
    loop = np.array([[0.1, 0.1], [0.9, 0.2], [0.8, 0.9], [0.5, 0.97], [0.15, 0.7]])
    made = check(face.trimmed([loop]), 1e-5)
    assert len(edges(made)) == 5


def test_an_edge_is_its_polyline_and_points_that_repeat_do_not_matter():
    points = np.array([[0, 0, 0], [3, 4, 0], [3, 4, 0], [3, 4, 12.0]])
    curve = BRepAdaptor_Curve(polyline_edge(points))
    assert GCPnts_AbscissaPoint.Length_s(curve) == pytest.approx(17.0, abs=1e-9)
    middle = curve.Value(5.0)
    assert [middle.X(), middle.Y(), middle.Z()] == pytest.approx([3, 4, 0], abs=1e-9)
    with pytest.raises(InvalidInput, match="has no length: two different points"):
        polyline_edge(np.ones((4, 3)))
