"""Run outside FreeCAD before test_part_contract.py: what Open CASCADE's adapter says of each part, and the parts.

``python prepare_part_contract.py FOLDER`` leaves in FOLDER, for each part, its geometry (.step or .brep) and the record
(.pickle).  Real parts by others come from the folder that TOOLAXIS_SHARED names, where it is there.
"""

import importlib.util
import os
import pickle
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


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


def write(folder):
    from OCP.BRepTools import BRepTools

    from toolaxis.cad.ocp import shape_record
    from toolaxis.cad.transfer import convert

    shared = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
    for path in [*sorted((ROOT / "examples").glob("*.step")), *sorted(shared.glob("*.st*p"))]:
        done, record, *_ = convert(str(path))
        if done == "done":
            shutil.copy(path, folder / f"{path.stem}.step")
            (folder / f"{path.stem}.pickle").write_bytes(pickle.dumps(record))
    for name, face in made_faces():
        BRepTools.Write_s(face, str(folder / f"{name}.brep"))
        (folder / f"{name}.pickle").write_bytes(pickle.dumps(shape_record(face)))


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT / "core"))
    write(Path(sys.argv[1]))
