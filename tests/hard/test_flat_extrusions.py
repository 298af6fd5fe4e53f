"""Found: planes that a file stores as extrusions, B-splines or cones were planned as sculptured faces."""

import pytest

import toolaxis as ta

cq = pytest.importorskip("cadquery")


def test_flat_faces_are_planes_however_they_are_stored() -> None:
    rim = cq.Edge.makeSpline([cq.Vector(x, 0, z) for x, z in ((0, 0), (10, 2), (20, 0), (30, 3))])
    ends = [cq.Edge.makeLine(cq.Vector(30, 0, 3), cq.Vector(30, 0, -10)),
            cq.Edge.makeLine(cq.Vector(30, 0, -10), cq.Vector(0, 0, -10)),
            cq.Edge.makeLine(cq.Vector(0, 0, -10), cq.Vector(0, 0, 0))]
    wire = cq.Wire.assembleEdges([rim, *ends])
    nurbs = cq.Workplane(cq.Solid.extrudeLinear(wire, [], cq.Vector(0, 20, 0))).val().toNURBS()
    part = ta.load(cq.Workplane(nurbs))
    assert sorted(face.kind for face in part.faces)[-5:] == ["plane"] * 5
    assert len(part.sculptured) == 1
