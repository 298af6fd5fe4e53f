"""Verdict maps painted on the faces in the 3D view; the triangles are made off the GUI thread."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from freecad.toolaxis.document.colour_scale import judged
from freecad.toolaxis.document.triangles import triangles_of
from PySide import QtCore

WHAT = ("remaining", "gouge")
#: FreeCAD shows faces as coarse triangles that stand above the true face here and there; the colours are drawn nearer
#: to the viewer by this many steps of the depth buffer, a few thousandths of what the view is deep.
_NEARER = -50000.0


@dataclass(eq=False)
class PaintedFace:
    """One face as triangles with a value at each corner.

    Attributes
    ----------
    point : (n, 3) array
    triangle : (m, 3) array of int
    remaining, gouge : (n,) array
        mm; inf where the cutter never came.
    declared : (n,) array of bool
        Whether it lies in a clean-up zone.
    """

    point: np.ndarray
    triangle: np.ndarray
    remaining: np.ndarray
    gouge: np.ndarray
    declared: np.ndarray


#: Triangles in one node: the scene grows node by node, so that the event loop is never held up.
_PIECE = 5000


def skins_of(found):
    """Triangles over the rays of a surface map, in pieces; those across gaps and beyond trims are left out.

    Parameters
    ----------
    found : toolaxis.verify.maps.SurfaceMap
    """
    triangle = triangles_of(found)
    return [_piece(found, triangle[k:k + _PIECE]) for k in range(0, len(triangle), _PIECE)]


def _piece(found, triangle):
    rows, inverse = np.unique(triangle, return_inverse=True)
    return PaintedFace(found.point[rows], inverse.reshape(triangle.shape), found.remaining[rows], found.gouge[rows],
                       found.declared[rows])


class Paint:
    """Colours on faces, in the scene of a document's 3D view; no objects.

    Parameters
    ----------
    view : Gui.View3DInventorPy or None
    """

    def __init__(self, view):
        self.view, self.root = view, None
        self.marker = None
        self._left = []
        self._timer = QtCore.QTimer()
        self._timer.timeout.connect(self._grow)

    def show(self, skins, what, limits):
        """Paint faces.

        Parameters
        ----------
        skins : sequence of PaintedFace
        what : str
            "remaining" or "gouge".
        limits : (float, float)
            The end of the scale, and what the judge accepts, mm.
        """
        from pivy import coin

        self.clear()
        if self.view is None:
            return
        root = coin.SoSeparator()
        style = coin.SoPickStyle()
        style.style = coin.SoPickStyle.UNPICKABLE
        root.addChild(style)
        offset = coin.SoPolygonOffset()
        offset.factor, offset.units = -2.0, _NEARER
        root.addChild(offset)
        self.marker = coin.SoSeparator()
        root.addChild(self.marker)
        self.root, self._left = root, [(skin, what, limits) for skin in skins]
        self.view.getSceneGraph().addChild(root)
        self._timer.start()

    def _grow(self):
        """Add one piece; called until none is left."""
        if self.root is None or not self._left:
            self._timer.stop()
            return
        skin, what, limits = self._left.pop()
        aside = skin.declared if what == "remaining" else None
        self.root.addChild(_paint_skin(skin, judged(getattr(skin, what), *limits, aside)))

    def point_at(self, point, size):
        """Zoom to a point and mark it.

        Parameters
        ----------
        point : (3,) sequence
        size : float
            Height of what is then seen, mm.
        """
        from pivy import coin

        if self.view is None or self.marker is None:
            return
        self.marker.removeAllChildren()
        material = coin.SoMaterial()
        material.diffuseColor.setValue(0.9, 0.1, 0.6)
        material.emissiveColor.setValue(0.5, 0.0, 0.3)
        move = coin.SoTranslation()
        move.translation.setValue(*(float(x) for x in point))
        ball = coin.SoSphere()
        ball.radius = size / 60
        for child in (material, move, ball):
            self.marker.addChild(child)
        camera = self.view.getCameraNode()
        way = camera.orientation.getValue().multVec(coin.SbVec3f(0, 0, -1)).getValue()
        away = max(camera.focalDistance.getValue(), 2 * size)
        camera.focalDistance = away
        camera.position.setValue(*(float(p - away * w) for p, w in zip(point, way, strict=True)))
        if hasattr(camera, "height"):
            camera.height = size
        else:
            away = size
            camera.position.setValue(*(float(p - away * w) for p, w in zip(point, way, strict=True)))
        self.view.redraw()

    def clear(self):
        """Take the colours off."""
        if self.root is not None:
            with suppress(Exception):  # the view may be gone already
                self.view.getSceneGraph().removeChild(self.root)
        self.root = self.marker = None
        self._left = []


def _paint_skin(skin, rgb):
    from pivy import coin

    node = coin.SoSeparator()
    model = coin.SoLightModel()
    model.model = coin.SoLightModel.BASE_COLOR
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.UNKNOWN_ORDERING
    material = coin.SoMaterial()
    material.diffuseColor.setValues(0, len(rgb), (rgb / 255.0).tolist())
    binding = coin.SoMaterialBinding()
    binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    points = coin.SoCoordinate3()
    points.point.setValues(0, len(skin.point), skin.point.tolist())
    faces = coin.SoIndexedFaceSet()
    index = np.column_stack([skin.triangle, np.full(len(skin.triangle), -1)]).ravel()
    faces.coordIndex.setValues(0, len(index), index.tolist())
    for child in (model, hints, material, binding, points, faces):
        node.addChild(child)
    return node
