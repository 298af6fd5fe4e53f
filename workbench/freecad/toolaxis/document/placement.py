"""Where things stand in a document: frames as placements, and what carries an object along."""

import FreeCAD


def placement_from(matrix):
    """A placement from the matrix of a rigid motion.

    Parameters
    ----------
    matrix : (4, 4) array
        mm
    """
    return FreeCAD.Placement(FreeCAD.Matrix(*(float(x) for x in matrix.ravel())))


def matrix_of(placement):
    """The (4, 4) array of a placement, mm.

    Parameters
    ----------
    placement : FreeCAD.Placement
    """
    import numpy as np

    return np.array(placement.toMatrix().A, dtype=float).reshape(4, 4)


def chain_of(thing):
    """The objects whose placements carry an object along, outermost first, itself last.

    Part containers, bodies, assemblies, arrays of links, links and what they link to.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    chain, other = [thing], _carrier(thing)
    while other is not None:
        chain.insert(0, other)
        other = _carrier(other)
    linked = thing
    while linked is not None and getattr(linked, "LinkTransform", False):
        linked = getattr(linked, "LinkedObject", None)
        if linked is not None:
            chain.append(linked)
    return [one for one in chain if hasattr(one, "Placement")]


def _carrier(thing):
    if thing.isDerivedFrom("App::LinkElement"):
        arrays = [other for other in thing.InList if thing in (getattr(other, "ElementList", None) or ())]
        return arrays[0] if arrays else None
    return thing.getParentGeoFeatureGroup()


def carried(chain):
    """The product of the placements of a chain.

    Parameters
    ----------
    chain : sequence of App.DocumentObject
    """
    placement = FreeCAD.Placement()
    for one in chain:
        placement = placement.multiply(one.Placement)
    return placement


def follow(thing, chain, last):
    """Let FreeCAD itself keep an object's placement: that of a chain, times a placement property of the object.

    Parameters
    ----------
    thing : App.DocumentObject
    chain : sequence of App.DocumentObject
    last : str
        Name of the property.
    """
    try:
        thing.setExpression("Placement", " * ".join([*(f"{one.Name}.Placement" for one in chain), last]))
    except Exception:  # a name that is also a unit, for instance A
        labels = (one.Label.replace("\\", "\\\\").replace(">", "\\>") for one in chain)
        thing.setExpression("Placement", " * ".join([*(f"<<{label}>>.Placement" for label in labels), last]))
