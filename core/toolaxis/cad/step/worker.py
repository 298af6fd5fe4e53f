"""The child process that lets the kernel read a STEP file: ``python -m toolaxis.cad.step.worker IN OUT ORDER``.

ORDER is a pickled FaceOrder.  The outcome goes to OUT as a pickle: ("done", Transfer) or ("failed", kind, message).
"""

import pickle
import sys
from pathlib import Path
from typing import Any, NamedTuple

from toolaxis.cad.shape_data import Transfer
from toolaxis.cad.step.faces import FaceOrder, number_faces, warn_of_lost_faces
from toolaxis.errors import InvalidInput, MissingBackend, ToolAxisError, UnsupportedGeometry, place_of, report_it

#: How many faces times entities the kernel is asked for the origin of each: always, and where faces are missing.
ASKED, ASKED_OF_MISSING = 1e7, 1e9


class Reading(NamedTuple):
    """What the kernel has read.

    Attributes
    ----------
    shape : TopoDS_Shape
        In mm.
    unit : str
        The length unit that the file declares.
    reader : STEPControl_Reader
    """

    shape: Any
    unit: str
    reader: Any


def read_shape(path: str) -> tuple[Any, str]:
    """Let the kernel read a file.

    Parameters
    ----------
    path : str

    Returns
    -------
    shape : TopoDS_Shape
        In mm.
    unit : str
        The length unit that the file declares.

    Raises
    ------
    InvalidInput
        When the kernel refuses the file or makes nothing of it.
    """
    reading = read_file(path)
    return reading.shape, reading.unit


def read_file(path: str) -> Reading:
    """Let the kernel read a file, and keep what knows where each piece of the shape comes from.

    Parameters
    ----------
    path : str

    Raises
    ------
    InvalidInput
        When the kernel refuses the file or makes nothing of it.
    """
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    from toolaxis.cad.ocp.kernel_names import TextSequence

    reader = STEPControl_Reader()
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise InvalidInput("the CAD kernel cannot parse its text: export the part again")
    length, angle, solid = (TextSequence() for _ in range(3))
    reader.FileUnits(length, angle, solid)
    units = dict.fromkeys(length.Value(i + 1).ToCString().lower() for i in range(length.Length()))
    reader.TransferRoots()
    shape = reader.OneShape()
    if shape is None or shape.IsNull():
        raise InvalidInput("the CAD kernel made no shape of it: export the part again")
    return Reading(shape, ", ".join(units) or "not declared", reader)


def ranks_of_faces(reading: Reading, faces: Any) -> list[int]:
    """The place in the text of the entity that each face was made of, from 1; 0 where the kernel does not know.

    Parameters
    ----------
    reading : Reading
    faces : ShapeMap
    """
    from OCP.TopLoc import TopLoc_Location

    session = reading.reader.WS()
    results, model = session.TransferReader(), session.Model()
    ranks = {model.Value(rank): rank for rank in range(1, model.NbEntities() + 1)}
    found = []
    for k in range(1, faces.Extent() + 1):
        face = faces.FindKey(k)
        origin = results.EntityFromShapeResult(face, 1)
        if origin is None:  # A copy in another place
            origin = results.EntityFromShapeResult(face.Located(TopLoc_Location()), 1)
        found.append(ranks.get(origin, 0))
    return found


def indices_of_copies(faces: Any) -> list[int]:
    """A number from 1 for each face, the same for copies of one face in several places.

    Parameters
    ----------
    faces : ShapeMap
    """
    from OCP.TopLoc import TopLoc_Location

    from toolaxis.cad.ocp.kernel_names import ShapeMap

    distinct = ShapeMap()
    return [distinct.Add(faces.FindKey(k).Located(TopLoc_Location())) for k in range(1, faces.Extent() + 1)]


def convert(path: str, order: FaceOrder | None = None) -> tuple[Any, ...]:
    """The outcome for one file, ready to be pickled.

    Parameters
    ----------
    path : str
    order : FaceOrder, optional
        Which faces the file has.
    """
    try:
        return "done", _convert_file(path, order or FaceOrder((), ()))
    except ImportError as reason:
        return "failed", MissingBackend, (f"the CAD kernel that is installed is not one that toolaxis knows ({reason})"
                                          ": pip install 'toolaxis[cadquery]' or 'toolaxis[build123d]'")
    except InvalidInput as reason:
        return "failed", InvalidInput, str(reason)
    except UnsupportedGeometry as reason:
        return "failed", UnsupportedGeometry, str(reason)
    except ToolAxisError as reason:
        return "failed", ToolAxisError, str(reason)
    except Exception as reason:
        return "failed", *_blame_file(reason)


def _convert_file(path: str, order: FaceOrder) -> Transfer:
    from toolaxis.cad.ocp.reader import face_map, shape_record

    reading = read_file(path)
    entities, read = len(order.definitions), reading.reader.WS().Model().NbEntities()
    if read < entities:  # It drops what it cannot parse, and makes something of the rest.
        raise InvalidInput(f"the CAD kernel can parse {read} of its {entities} entities only: export the part again")
    faces = face_map(reading.shape)
    if not faces.Extent():
        raise InvalidInput(f"the CAD kernel made none of its {order.promised} faces: export the part again")
    copies = indices_of_copies(faces)
    missing = order.left or max(copies) != order.promised
    asked = order.lists and faces.Extent() * entities <= (ASKED_OF_MISSING if missing else ASKED)
    ranks = ranks_of_faces(reading, faces) if asked else [0] * faces.Extent()
    origins = order.origins(ranks, read)
    numbers = number_faces(order, origins)
    record = shape_record(reading.shape, numbers=numbers.made)
    record.unit = reading.unit
    return warn_of_lost_faces(record, copies, order, numbers, origins)


def _blame_file(reason: Exception) -> tuple[type[ToolAxisError], str]:
    """The kernel's own exceptions are the file's fault; every other one is a fault of ours."""
    what = f"{type(reason).__name__}: {str(reason).strip() or 'no message'}"
    if type(reason).__module__.split(".")[0] == "OCP":
        return InvalidInput, f"the CAD kernel fails on it ({what}): repair the geometry and export it again"
    return ToolAxisError, (f"an error of toolaxis itself, not of the file ({what}, at {place_of(reason)}): "
                           f"{report_it('the file')}")


def main(arguments: list[str]) -> int:
    """Read arguments[0] with the pickled order in arguments[2], write the outcome to arguments[1]."""
    outcome = convert(arguments[0], pickle.loads(Path(arguments[2]).read_bytes()))
    Path(arguments[1]).write_bytes(pickle.dumps(outcome, protocol=pickle.HIGHEST_PROTOCOL))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
