"""The work coordinate system of an operation: FreeCAD's own local coordinate system, carried along by the part."""

from freecad.toolaxis.document.placement import carried, follow
from freecad.toolaxis.document.properties import Property, assign, ensure

_PROPERTIES = (Property("Placement", "Frame", "Tool Axis", "This coordinate system in that of the part", True),)
#: Greatest deviation of an attached frame from where it should stand, mm and in the directions.
_CLOSE = 1e-9


def kind_of_frame(document):
    """The type of FreeCAD's local coordinate system: the one of Part where there is one, else that of Part Design.

    Parameters
    ----------
    document : App.Document
    """
    import Part  # noqa: F401  makes its types known

    if "Part::LocalCoordinateSystem" in document.supportedTypes():
        return "Part::LocalCoordinateSystem"
    import _PartDesign  # noqa: F401  its types without its Python code, which wants a window

    return "PartDesign::CoordinateSystem"


def add_frame(document):
    """A new work coordinate system: a plain object of FreeCAD.

    Parameters
    ----------
    document : App.Document
    """
    thing = document.addObject(kind_of_frame(document), "WorkCoordinates")
    ensure(thing, _PROPERTIES)
    return thing


def place_frame(thing, placement, chain):
    """Put a work coordinate system in its place and let FreeCAD keep it on the part.

    It is attached to a part that stands alone; in containers, links and arrays its placement follows by an expression.

    Parameters
    ----------
    thing : App.DocumentObject
        From `add_frame`.
    placement : FreeCAD.Placement
        In the document's space: +Z the tool axis, +X the feed, origin the datum.
    chain : sequence of App.DocumentObject
        What carries the part along, `freecad.toolaxis.document.placement.chain_of`.
    """
    assign(thing, Frame=carried(chain).inverse().multiply(placement))
    thing.setExpression("Placement", None)
    if len(chain) == 1 and chain[0].isDerivedFrom("Part::Feature") and _attach(thing, placement, chain[0]):
        return
    if thing.AttachmentSupport:
        thing.AttachmentSupport, thing.MapMode = [], "Deactivated"
    thing.Placement = placement
    follow(thing, chain, "Frame")


def _attach(thing, placement, part):
    """Attach to a part; whether it then stands where it should."""
    thing.AttachmentSupport = [(part, "")]
    thing.AttachmentOffset = thing.Frame
    thing.MapMode = "ObjectXY"
    thing.recompute()
    return thing.isValid() and thing.Placement.isSame(placement, _CLOSE)
