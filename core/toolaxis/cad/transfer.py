"""The child process that lets the kernel read a STEP file: ``python -m toolaxis.cad.transfer IN OUT``.

The outcome goes to OUT as a pickle: ("done", ShapeRecord, distinct faces transferred) or ("failed", kind, message).
"""

import pickle
import sys
import traceback
from pathlib import Path
from typing import Any

from toolaxis.errors import InvalidInput, MissingBackend, ToolAxisError, UnsupportedGeometry


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
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TColStd import TColStd_SequenceOfAsciiString

    reader = STEPControl_Reader()
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise InvalidInput("the CAD kernel cannot parse its text: export the part again")
    length, angle, solid = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.FileUnits(length, angle, solid)
    units = dict.fromkeys(length.Value(i + 1).ToCString().lower() for i in range(length.Length()))
    reader.TransferRoots()
    shape = reader.OneShape()
    if shape is None or shape.IsNull():
        raise InvalidInput("the CAD kernel made no shape of it: export the part again")
    return shape, ", ".join(units) or "not declared"


def distinct_faces(shape: Any) -> int:
    """How many different faces a shape has, copies in several places counted once."""
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopTools import TopTools_MapOfShape

    from toolaxis.cad.ocp import face_map

    faces, distinct = face_map(shape), TopTools_MapOfShape()
    for k in range(1, faces.Extent() + 1):
        distinct.Add(faces.FindKey(k).Located(TopLoc_Location()))
    return int(distinct.Extent())


def convert(path: str) -> tuple[Any, ...]:
    """The outcome for one file, ready to be pickled.

    Parameters
    ----------
    path : str
    """
    try:
        from toolaxis.cad.ocp import shape_record

        shape, unit = read_shape(path)
        record = shape_record(shape)
        record.unit = unit
        return "done", record, distinct_faces(shape) - record.endless
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
        return "failed", *_blamed(reason)


def _blamed(reason: Exception) -> tuple[type[ToolAxisError], str]:
    """The kernel's own exceptions are the file's fault; every other one is a fault of ours."""
    what = f"{type(reason).__name__}: {str(reason).strip() or 'no message'}"
    if type(reason).__module__.split(".")[0] == "OCP":
        return InvalidInput, f"the CAD kernel fails on it ({what}): repair the geometry and export it again"
    frame = traceback.extract_tb(reason.__traceback__)[-1]
    return ToolAxisError, (f"an error of toolaxis itself, not of the file ({what}; {Path(frame.filename).name}, line "
                           f"{frame.lineno}): please report it with the file")


def main(arguments: list[str]) -> int:
    """Read arguments[0], write the outcome to arguments[1]."""
    outcome = convert(arguments[0])
    Path(arguments[1]).write_bytes(pickle.dumps(outcome, protocol=pickle.HIGHEST_PROTOCOL))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
