"""What has other names in other releases of the kernel: containers, and casts of shapes to their kinds."""

from collections.abc import Callable
from typing import Any

from OCP.TopoDS import TopoDS

try:
    from OCP.collections import Array1_double as RealArray
    from OCP.collections import Array1_gp_Pnt as PointArray
    from OCP.collections import Array1_gp_Pnt2d as Point2dArray
    from OCP.collections import Array1_int as IntegerArray
    from OCP.collections import Array2_double as RealGrid
    from OCP.collections import Array2_gp_Pnt as PointGrid
    from OCP.collections import HArray1_double as SharedRealArray
    from OCP.collections import HArray1_gp_Pnt as SharedPointArray
    from OCP.collections import HArray1_gp_Pnt2d as SharedPoint2dArray
    from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
    from OCP.collections import Sequence_TCollection_AsciiString as TextSequence
    from OCP.collections import Sequence_TDF_Label as LabelSequence
except ImportError:
    from OCP.TColgp import TColgp_Array1OfPnt as PointArray
    from OCP.TColgp import TColgp_Array1OfPnt2d as Point2dArray
    from OCP.TColgp import TColgp_Array2OfPnt as PointGrid
    from OCP.TColgp import TColgp_HArray1OfPnt as SharedPointArray
    from OCP.TColgp import TColgp_HArray1OfPnt2d as SharedPoint2dArray
    from OCP.TColStd import TColStd_Array1OfInteger as IntegerArray
    from OCP.TColStd import TColStd_Array1OfReal as RealArray
    from OCP.TColStd import TColStd_Array2OfReal as RealGrid
    from OCP.TColStd import TColStd_HArray1OfReal as SharedRealArray
    from OCP.TColStd import TColStd_SequenceOfAsciiString as TextSequence
    from OCP.TDF import TDF_LabelSequence as LabelSequence
    from OCP.TopTools import TopTools_IndexedMapOfShape as ShapeMap



def _cast(kind: str) -> Callable[[Any], Any]:
    """The cast of a shape to its kind."""
    return getattr(TopoDS, kind, None) or getattr(TopoDS, f"{kind}_s")


as_edge, as_face, as_shell, as_solid, as_wire = map(_cast, ("Edge", "Face", "Shell", "Solid", "Wire"))

__all__ = ["IntegerArray", "LabelSequence", "Point2dArray", "PointArray", "PointGrid", "RealArray", "RealGrid",
           "ShapeMap", "SharedPoint2dArray", "SharedPointArray", "SharedRealArray", "TextSequence", "as_edge",
           "as_face", "as_shell", "as_solid", "as_wire"]
