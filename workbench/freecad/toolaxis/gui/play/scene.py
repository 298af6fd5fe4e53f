"""Tool and machine in the 3D view: table, trunnion, head and tool as they stand, what meets in red.

Parts and clamps that something meets are drawn once more over themselves, in red: they keep their own colours.
"""

from contextlib import suppress

import numpy as np
from freecad.toolaxis.document.placement import carried, chain_of, matrix_of
from freecad.toolaxis.gui.play.nodes import COLOURS, colour_node, revolve, solids, view_of
from freecad.toolaxis.services.tour import corners, places
from pivy import coin

_TABLE, _HEAD, _RED = (0.45, 0.55, 0.68), (0.72, 0.62, 0.42), (0.90, 0.05, 0.05)
_CLEAR = {True: 0.45, False: 0.6}
#: What is drawn over an object is nearer to the viewer by so many steps of the depth buffer.
_NEARER = -2000.0


class MachineScene:
    """Bodies of a machine in the scene of a document's 3D view; they are no objects.

    Parameters
    ----------
    document : App.Document
    """

    def __init__(self, document):
        self.name = document.Name
        self.root = self.view = self.mounted = self.seen = None
        self.bed, self.reddened = np.eye(4), []

    def show(self, mounted, tools):
        """Put a machine and the tools of its operations into the view.

        Parameters
        ----------
        mounted : toolaxis.machine.setup.Mounting or None
            None for the tools alone.
        tools : sequence of toolaxis.tools.tool.Tool
        """
        from toolaxis.machine.body_poses import beside_part

        self.clear()
        self.view, self.mounted = view_of(self.name), mounted
        if self.view is None:
            return
        self.seen = self.seen or (None if mounted is None else self.view.getCamera())
        self.root = coin.SoSeparator()
        style = coin.SoPickStyle()
        style.style = coin.SoPickStyle.UNPICKABLE
        self.root.addChild(style)
        self.bodies = []
        for body in () if mounted is None else mounted.machine.bodies:
            beside = beside_part(mounted.machine, body)
            node = colour_node(_TABLE if beside else _HEAD, _CLEAR[beside])
            transform = coin.SoMatrixTransform()
            node.insertChild(transform, 0)
            for child in _hull(corners(body)):
                node.addChild(child)
            self.root.addChild(node)
            self.bodies.append((body, transform, node.getChild(2), _TABLE if beside else _HEAD))
        self.tool = coin.SoMatrixTransform()
        node, self.spindle, self.members, self.kinds = coin.SoSeparator(), coin.SoSwitch(), [], []
        node.addChild(self.tool)
        node.addChild(self.spindle)
        self.lengths = [float(tool.gauge_length or 0.0) for tool in tools]
        known = {}
        for tool in tools:
            key = tool.profile, *((name, line.tobytes()) for name, line in tool.outlines.items())
            if key not in known:
                known[key] = len(known)
                self.spindle.addChild(self._whole(tool))
            self.kinds.append(known[key])
        self.root.addChild(node)
        self.over = coin.SoSeparator()
        self.root.addChild(self.over)
        self.view.getSceneGraph().addChild(self.root)

    def _whole(self, tool):
        """Cutter, shank and holder; their materials join those that turn red."""
        node = coin.SoSeparator()
        for solid in solids(tool):
            member = revolve(*solid)
            node.addChild(member)
            self.members.append((solid[0], member.getChild(1), COLOURS.get(solid[0], COLOURS["shank"])))
        return node

    def stand(self, joints, red, still, row=0):
        """Move everything to joint coordinates.

        Parameters
        ----------
        joints : (3 + m,) array
        red : set of str
            Names of bodies, and of members of the tool, that meet something.
        still : bool
            Whether the camera stays with the machine's bed; else with the part.
        row : int
            Number of the operation whose tool is in the spindle.
        """
        from toolaxis.machine.kinematics import forward

        if self.root is None:
            return
        found = places(self.mounted, joints)
        for body, transform, material, colour in self.bodies:
            transform.matrix.setValue(*_matrix(found[body.carried]))
            material.diffuseColor.setValue(*(_RED if body.name in red else colour))
        tip, axis = forward(self.mounted.machine, joints[None], self.lengths[row], self.mounted.table_from_part)
        self._put_tool(tip[0], axis[0], red, row)
        if still:
            self._follow(found["bed"] @ np.linalg.inv(self.bed))
        self.bed = found["bed"]

    def stand_alone(self, tip, axis, red, row=0):
        """Move the tool, where there is no machine.

        Parameters
        ----------
        tip, axis : (3,) array
            mm; unit vector from tip to spindle.
        red : set of str
            Names of members of the tool that meet something.
        row : int
            Number of the operation whose tool it is.
        """
        if self.root is not None:
            self._put_tool(tip, axis, red, row)

    def _put_tool(self, tip, axis, red, row):
        for name, material, colour in self.members:
            material.diffuseColor.setValue(*(_RED if name in red else colour))
        self.spindle.whichChild = self.kinds[row]
        self.tool.matrix.setValue(*_matrix(_upright(tip, axis)))

    def redden(self, things):
        """Show objects in red, and all others as they are.

        Parameters
        ----------
        things : sequence of App.DocumentObject
        """
        if self.root is None or [thing.Name for thing in things] == self.reddened:
            return
        self.over.removeAllChildren()
        self.reddened = [thing.Name for thing in things]
        for thing in things:
            self.over.addChild(red_over(thing))

    def _follow(self, motion):
        """Carry the camera along with a rigid motion."""
        camera = self.view.getCameraNode()
        place, turn = np.array(camera.position.getValue().getValue()), camera.orientation.getValue()
        camera.position.setValue(*(motion[:3, :3] @ place + motion[:3, 3]).tolist())
        moved = coin.SbRotation(coin.SbMatrix(*_matrix(np.block([[motion[:3, :3], np.zeros((3, 1))],
                                                                 [np.zeros((1, 3)), np.ones((1, 1))]]))))
        camera.orientation.setValue(turn * moved)

    def look(self):
        """Turn the view so that the machine is seen as a whole, from its front."""
        if self.root is None:
            return
        way = self.bed[:3, :3] @ np.array([0.55, -1.0, 0.55])
        camera, up = self.view.getCameraNode(), self.bed[:3, 2]
        camera.orientation.setValue(_looking(-way, up))
        viewport = coin.SbViewportRegion(*self.view.getSize())
        camera.viewAll(self.root, viewport)

    def leave(self):
        """Take everything out of the view, and look again as before the machine was looked at."""
        view = view_of(self.name)
        self.clear()
        if view is not None and self.seen:
            view.setCamera(self.seen)
        self.seen = None

    def clear(self):
        """Take everything out of the view."""
        if self.root is not None:
            with suppress(Exception):  # the view may be gone already
                self.view.getSceneGraph().removeChild(self.root)
        self.forget()

    def forget(self):
        """Let go without touching the view."""
        self.root = self.view = self.mounted = None
        self.bed, self.reddened = np.eye(4), []


def red_over(thing):
    """An object's own picture once more, in red and a little nearer to the viewer.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    node, place, material, offset = (coin.SoSeparator(), coin.SoMatrixTransform(), coin.SoMaterial(),
                                     coin.SoPolygonOffset())
    chain = chain_of(thing)
    place.matrix.setValue(*_matrix(matrix_of(carried(chain).multiply(thing.Placement.inverse()))))
    material.diffuseColor.setValue(*_RED)
    offset.factor, offset.units = -2.0, _NEARER
    offset.styles = coin.SoPolygonOffset.FILLED | coin.SoPolygonOffset.LINES
    binding = coin.SoMaterialBinding()
    binding.value = coin.SoMaterialBinding.OVERALL
    for one in (material, binding, offset):
        one.setOverride(True)
    for one in (place, material, binding, offset, thing.ViewObject.RootNode):
        node.addChild(one)
    return node


def _matrix(matrix):
    """A rigid motion as Coin has it: for rows, transposed."""
    return np.asarray(matrix, dtype=float).T.ravel().tolist()


def _upright(tip, axis):
    """The rigid motion that puts a tool's tip and axis into place."""
    from toolaxis.numeric.vectors import perpendicular, unit

    z = unit(axis)
    x = perpendicular(z)[0]
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = x, np.cross(z, x), z, tip
    return matrix


def _looking(way, up):
    """The rotation of a camera that looks along a way."""
    from toolaxis.numeric.vectors import unit

    z = -unit(np.asarray(way, dtype=float))
    x = unit(np.cross(up, z))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = x, np.cross(z, x), z
    return coin.SbRotation(coin.SbMatrix(*_matrix(matrix)))


def _hull(points):
    """The nodes of the hull of points, seen from outside."""
    from scipy.spatial import ConvexHull

    whole = ConvexHull(points)
    middle, faces = points.mean(axis=0), []
    for corner, plane in zip(whole.simplices, whole.equations, strict=True):
        a, b, c = points[corner]
        outward = np.cross(b - a, c - a) @ plane[:3] > 0 if np.isfinite(middle).all() else True
        faces += [*(corner if outward else corner[::-1]).tolist(), -1]
    hints = coin.SoShapeHints()
    hints.vertexOrdering, hints.creaseAngle = coin.SoShapeHints.COUNTERCLOCKWISE, 0.4
    rows = coin.SoCoordinate3()
    rows.point.setValues(0, len(points), np.asarray(points, dtype=float).tolist())
    mesh = coin.SoIndexedFaceSet()
    mesh.coordIndex.setValues(0, len(faces), faces)
    return hints, rows, mesh
