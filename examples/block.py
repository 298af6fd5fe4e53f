"""What the numbered scripts share: a block under a freeform top, a single face, and files that come out the same.

Needs the Open CASCADE bindings that CadQuery or build123d bring.
"""

import json
import tempfile
from pathlib import Path

import numpy as np
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeSolid,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Sewing,
)
from OCP.BRepLib import BRepLib
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.StepBasic import StepBasic_Product
from OCP.STEPControl import STEPControl_Reader, STEPControl_StepModelType, STEPControl_Writer
from OCP.TCollection import TCollection_HAsciiString

from toolaxis.cad.ocp.kernel_names import IntegerArray, PointGrid, RealArray, as_shell
from toolaxis.shape.nurbs import uniform_knots

HERE = Path(__file__).parent


def surface(points, degree):
    """A kernel B-spline surface with clamped uniform knots on [0, 1] from control points (nu, nv, 3)."""
    nu, nv, _ = points.shape
    poles = PointGrid(1, nu, 1, nv)
    for i in range(nu):
        for j in range(nv):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*map(float, points[i, j])))
    arrays = []
    for count, p in zip((nu, nv), degree, strict=True):
        values, repeats = np.unique(uniform_knots(count, p), return_counts=True)
        knots, counts = RealArray(1, len(values)), IntegerArray(1, len(values))
        for k, (value, repeat) in enumerate(zip(values, repeats, strict=True)):
            knots.SetValue(k + 1, float(value))
            counts.SetValue(k + 1, int(repeat))
        arrays.append((knots, counts))
    (ku, mu), (kv, mv) = arrays
    return Geom_BSplineSurface(poles, ku, kv, mu, mv, *degree)


def face(points, degree):
    """A face over the whole of a B-spline surface; its normal Su x Sv points out of the material."""
    return BRepBuilderAPI_MakeFace(surface(points, degree), 1e-7).Face()


def block(points, degree, bottom):
    """A solid with a B-spline top and plane walls down to z = bottom.

    The border of the control net must lie in four upright planes.
    """
    top = surface(points, degree)
    borders = [top.VIso(0.0), top.UIso(1.0), top.VIso(1.0), top.UIso(0.0)]
    sewing = BRepBuilderAPI_Sewing(1e-6)
    sewing.Add(BRepBuilderAPI_MakeFace(top, 1e-7).Face())
    for curve in borders:
        a, b = curve.StartPoint(), curve.EndPoint()
        low_a, low_b = (gp_Pnt(p.X(), p.Y(), bottom) for p in (a, b))
        edges = [BRepBuilderAPI_MakeEdge(curve).Edge(), *(BRepBuilderAPI_MakeEdge(p, q).Edge()
                                                          for p, q in ((b, low_b), (low_b, low_a), (low_a, a)))]
        sewing.Add(BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(*edges).Wire(), True).Face())
    corners = [points[0, 0], points[-1, 0], points[-1, -1], points[0, -1]]
    foot = BRepBuilderAPI_MakePolygon(*(gp_Pnt(float(x), float(y), bottom) for x, y, _ in corners), True)
    sewing.Add(BRepBuilderAPI_MakeFace(foot.Wire(), True).Face())
    sewing.Perform()
    solid = BRepBuilderAPI_MakeSolid(as_shell(sewing.SewedShape())).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    return solid


def write(name, shape, points, degree, source, **facts):
    """Write name.step, and name.json with the sculptured face's control points and whatever else is known."""
    write_step(name, shape)
    rows = ",\n".join("  " + json.dumps(np.round(row, 9).tolist()) for row in points)
    known = "".join(f',\n "{key}": {json.dumps(value)}' for key, value in facts.items())
    (HERE / f"{name}.json").write_text(f'{{"source": {json.dumps(source)},\n "degree": {json.dumps(list(degree))},\n'
                                       f' "points": [\n{rows}\n ]{known}}}\n')


def write_facts(name, shape, source, **facts):
    """Write name.step, and name.json with what is known of a part that has more than one sculptured face."""
    write_step(name, shape)
    known = "".join(f',\n "{key}": {json.dumps(value)}' for key, value in facts.items())
    (HERE / f"{name}.json").write_text(f'{{"source": {json.dumps(source)}{known}}}\n')


def settled(shape):
    """The shape as it is read back from a STEP file.

    Kernels put the faces of some shells in order when they read them, each version in its own way: not those of a
    shell that was read once. So the faces of a file written from it have the same numbers everywhere.
    """
    with tempfile.TemporaryDirectory() as folder:
        reader = STEPControl_Reader()
        reader.ReadFile(str(write_step("once", shape, Path(folder))))
        reader.TransferRoots()
        return reader.OneShape()


def write_step(name, shape, folder=None):
    """Write name.step beside the scripts or into a folder: mm, AP214, the same bytes every time; its path."""
    folder = HERE if folder is None else folder
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
    _name_product(writer.Model(), TCollection_HAsciiString(name))
    header = APIHeaderSection_MakeHeader(writer.Model())
    header.SetName(TCollection_HAsciiString(f"{name}.step"))
    header.SetTimeStamp(TCollection_HAsciiString("2016-01-01T00:00:00"))
    path = folder / f"{name}.step"
    if writer.Write(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise OSError(f"{name}.step could not be written to {folder}")
    return path


def _name_product(model, name):
    """Name the product of a STEP model: the kernel's own name counts what this process has written before."""
    for number in range(1, model.NbEntities() + 1):
        entity = model.Value(number)
        if isinstance(entity, StepBasic_Product):
            entity.SetId(name)
            entity.SetName(name)
