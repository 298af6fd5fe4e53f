"""A plan as a STEP file: part, sub-surfaces as coloured faces, and passes that stand at named placements."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Message import Message, Message_Gravity
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from toolaxis import __version__
from toolaxis.cad.ocp.plan_shapes import LINES, PART, pieces, rest_of
from toolaxis.errors import InvalidInput
from toolaxis.plan.plan import Plan

Colour = tuple[float, float, float]

_TIME = "2000-01-01T00:00:00"


def write_step(plan: Plan, path: Path, colours: Mapping[int, Colour], name: str = "plan", part: Any = None) -> None:
    """Write a plan as a STEP file (AP214) with names, colours and placements.

    Parameters
    ----------
    plan : Plan
    path : Path
    colours : mapping of int to (float, float, float)
        Colour of each operation's sub-surface by its number, red, green and blue from 0 to 1.
    name : str
        Of the whole.
    part : TopoDS_Shape, optional
        What stands for the part; the faces that no operation machines unless given.

    Raises
    ------
    InvalidInput
        When the kernel does not write the file.

    Notes
    -----
    The whole is an assembly of "part" and of one assembly for each operation, "op01-face3".  That is placed at the work
    coordinate system, z along the tool axis, and holds "op01-face3-surface" and "op01-face3-passes" in its coordinates;
    an operation without an axis has its sub-surface alone, in the part's frame.
    """
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colouring = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    whole = _Assembly(shapes, colouring, name)
    whole.put(rest_of(plan) if part is None else part, "part", PART)
    for piece in pieces(plan):
        colour = colours[piece.operation.number]
        if not piece.done:
            whole.put(piece.face, piece.surface_name, colour)
            continue
        own = _Assembly(shapes, colouring, piece.name)
        own.put(piece.local_face, piece.surface_name, colour)
        own.put(piece.passes(local=True), f"{piece.name}-passes", LINES)
        whole.take(own, piece.location)
    shapes.UpdateAssemblies()
    _write(document, path)


def _write(document: Any, path: Path) -> None:
    with _quiet():
        writer = STEPCAFControl_Writer()
        writer.SetNameMode(True)
        writer.SetColorMode(True)
        Interface_Static.SetCVal_s("write.step.unit", "MM")
        written = writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
        header = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
        header.SetTimeStamp(TCollection_HAsciiString(_TIME))  # the same plan gives the same file
        header.SetOriginatingSystem(TCollection_HAsciiString(f"toolaxis {__version__}"))
        written = written and writer.Write(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    if not written:
        raise InvalidInput(f"the CAD kernel did not write {path}: give the name of a file in a folder that can be "
                           "written")


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep what the kernel has to tell of its work away from standard output."""
    printers = list(Message.DefaultMessenger_s().Printers())
    levels = [printer.GetTraceLevel() for printer in printers]
    for printer in printers:
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    try:
        yield
    finally:
        for printer, level in zip(printers, levels, strict=True):
            printer.SetTraceLevel(level)


class _Assembly:
    """An assembly in the making."""

    def __init__(self, shapes: XCAFDoc_ShapeTool, colouring: XCAFDoc_ColorTool, name: str) -> None:
        self.shapes, self.colouring, self.name, self.label = shapes, colouring, name, shapes.NewShape()
        _name_label(self.label, name)

    def put(self, shape: Any, name: str, colour: Colour) -> None:
        """Add a shape under a name; it stays as one, whatever it is made of."""
        label = self.shapes.AddShape(shape, False)
        _name_label(label, name)
        self.colouring.SetColor(label, Quantity_Color(*colour, Quantity_TypeOfColor.Quantity_TOC_sRGB),
                                XCAFDoc_ColorType.XCAFDoc_ColorGen)
        _name_label(self.shapes.AddComponent(self.label, label, TopLoc_Location()), name)

    def take(self, other: "_Assembly", location: Any) -> None:
        """Add another assembly at a location."""
        _name_label(self.shapes.AddComponent(self.label, other.label, location), other.name)


def _name_label(label: Any, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
