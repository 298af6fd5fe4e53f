"""Bodies of a document that the tool may meet beside the part."""

from freecad.toolaxis.document.placement import chain_of


def bodies_in(document, parts):
    """Objects of a document that may have to be avoided: solids and shells at the top, but for some parts.

    What stands in a container that is a part is of that part.

    Parameters
    ----------
    document : App.Document
    parts : sequence of objects
    """
    own = {part.Name for part in parts}
    above = {one.Name for part in parts for one in part.InListRecursive}
    return [thing for thing in document.Objects if thing.Name not in above and _is_body(thing)
            and own.isdisjoint(one.Name for one in (thing, *chain_of(thing)))]


def bodies_beside(document, parts):
    """What of them is avoided unless the user says otherwise: those seen in one assembly or container with a part.

    Parameters
    ----------
    document : App.Document
    parts : sequence of objects
    """
    containers = {chain[0].Name for chain in map(chain_of, parts) if chain and chain[0].isDerivedFrom("App::Part")}
    return [body for body in bodies_in(document, parts) if body.Visibility and chain_of(body)[0].Name in containers]


def _is_body(thing):
    shape = getattr(thing, "Shape", None)
    if shape is None or not (thing.isDerivedFrom("Part::Feature") or thing.isDerivedFrom("App::Link")):
        return False
    if thing.isDerivedFrom("PartDesign::Feature") or thing.isDerivedFrom("Part::Part2DObject"):
        return False
    if "ToolBit" in type(getattr(thing, "Proxy", None)).__name__:
        return False
    inside = [above for above in thing.InList if above.TypeId == "PartDesign::Body" or hasattr(above, "Proxy")]
    return not inside and not shape.isNull() and bool(shape.Faces)
