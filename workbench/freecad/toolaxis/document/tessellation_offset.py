"""How far FreeCAD's own picture of a face may stand out of it, so that what is shown over the face is not hidden."""

from math import cos, pi

import FreeCAD

#: FreeCAD's own settings where an object has none, as its Part workbench keeps them: share of the part's size, percent,
#: and degrees.
_PLACE, _USUAL = "User parameter:BaseApp/Preferences/Mod/Part", (0.2, 28.65)
#: What the first is a percentage of: the mean side of the box, thrice, over 300.
_SIDES = 300.0


def bulge(face, thing):
    """The greatest height of chords of FreeCAD's triangles over a face, mm: above hollows only.

    FreeCAD draws triangles no farther from the face than a share of the part's size, whose neighbours turn by no more
    than an angle; no chord is longer than the face.

    Parameters
    ----------
    face : toolaxis.shape.face.Face
    thing : App.DocumentObject
        Whose face it is.
    """
    import numpy as np
    import Part

    hollow = face.curvature(face.grid(12, 12)).k1
    hollow = float(np.max(hollow[np.isfinite(hollow)], initial=0.0))
    if hollow <= 0:
        return 0.0
    share, angle = _settings(thing)
    box = Part.getShape(thing).BoundBox  # also of a container
    far = (box.XLength + box.YLength + box.ZLength) / _SIDES * share
    return min(far, (1 - cos(angle / 2)) / hollow, hollow * face.diagonal**2 / 8)


def _settings(thing):
    """Share of the part's size, percent, and angle, rad."""
    kept, view = FreeCAD.ParamGet(_PLACE), thing.ViewObject if FreeCAD.GuiUp else None
    share = getattr(view, "Deviation", None) or kept.GetFloat("MeshDeviation", _USUAL[0])
    angle = getattr(view, "AngularDeflection", None) or kept.GetFloat("MeshAngularDeflection", _USUAL[1])
    return float(share), float(getattr(angle, "Value", angle)) * pi / 180
