"""Run outside FreeCAD before test_part_contract.py: what Open CASCADE's adapter says of each part, and the parts.

``python prepare_part_contract.py FOLDER [--long]`` leaves in FOLDER, for each part, its geometry (.step or .brep) and
the record (.pickle), and in kernel.txt the kernel's release.  Real parts by others come from the folder that
TOOLAXIS_SHARED names, where it is there: a few of different origin, with --long all of them.
"""

import importlib.util
import os
import pickle
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOME = ("axom_revolved_sphere", "axom_sliced_cylinder", "kj66_impeller", "mousecover", "nacelle", "wing_inv")


def made_faces():
    """Faces on every kind of surface in awkward positions, from the tests of the other adapter."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    spec = importlib.util.spec_from_file_location("made", ROOT / "tests" / "cad" / "test_surfaces.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name, make in module.CASES.items():
        surface, box = make()
        face = BRepBuilderAPI_MakeFace(surface, *box, 1e-9).Face()
        yield name.replace(" ", "_"), face
        if name == "torus":
            yield "reversed_torus", face.Reversed()


def bare_face():
    """A patch of a cylinder over its seam whose edges have no curves in its parameters."""
    from OCP.BRep import BRep_Builder
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire
    from OCP.Geom import Geom_CylindricalSurface
    from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt
    from OCP.TopoDS import TopoDS_Face

    from toolaxis.cad.ocp.kernel_names import as_edge

    surface = Geom_CylindricalSurface(gp_Ax3(gp_Pnt(3, -2, 5), gp_Dir(1, 2, 3), gp_Dir(2, -1, 0.5)), 7.0)
    (u0, u1), (v0, v1) = (5.5, 7.5), (-3.0, 4.0)
    edges = [(surface.VIso(v0), u0, u1), (surface.UIso(u1), v0, v1), (surface.VIso(v1), u1, u0),
             (surface.UIso(u0), v1, v0)]
    wire = BRepBuilderAPI_MakeWire()
    for curve, start, end in edges:
        edge = BRepBuilderAPI_MakeEdge(curve, min(start, end), max(start, end)).Edge()
        wire.Add(edge if start < end else as_edge(edge.Reversed()))
    face, builder = TopoDS_Face(), BRep_Builder()
    builder.MakeFace(face, surface, 1e-7)
    builder.Add(face, wire.Wire())
    return face


def mesh_face():
    """A face that is only a triangle of a mesh."""
    from OCP.BRep import BRep_Builder
    from OCP.gp import gp_Pnt
    from OCP.Poly import Poly_Triangle, Poly_Triangulation
    from OCP.TopoDS import TopoDS_Face

    mesh, face = Poly_Triangulation(3, 1, False), TopoDS_Face()
    for k, point in enumerate([(0, 0, 0), (1, 0, 0), (0, 1, 0)]):
        mesh.SetNode(k + 1, gp_Pnt(*point))
    mesh.SetTriangle(1, Poly_Triangle(1, 2, 3))
    BRep_Builder().MakeFace(face, mesh)
    return face


def write(folder, everything):
    import OCP
    from OCP.BRepTools import BRepTools

    from toolaxis.cad.ocp.reader import shape_record
    from toolaxis.cad.step.worker import convert

    (folder / "kernel.txt").write_text(OCP.__version__)
    shared = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
    others = [path for path in sorted(shared.glob("*.st*p")) if everything or path.stem in SOME]
    for path in [*sorted((ROOT / "examples").glob("*.step")), *others]:
        done, found, *_ = convert(str(path))
        if done == "done":
            shutil.copy(path, folder / f"{path.stem}.step")
            (folder / f"{path.stem}.pickle").write_bytes(pickle.dumps(found.record))
    for name, face in made_faces():
        BRepTools.Write_s(face, str(folder / f"{name}.brep"))
        (folder / f"{name}.pickle").write_bytes(pickle.dumps(shape_record(face)))
    BRepTools.Write_s(bare_face(), str(folder / "bare.brep"))
    BRepTools.Write_s(mesh_face(), str(folder / "mesh.brep"))


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT / "core"))
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    write(target, everything="--long" in sys.argv)
