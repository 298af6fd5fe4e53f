"""What the panel shows in the 3D view before anything is in the document: passes, tool with holder, and frame."""

from contextlib import suppress
from functools import partial
from itertools import pairwise

import numpy as np
from freecad.toolaxis.document.axis_lines import COLOUR, SHARE, ends_of
from freecad.toolaxis.document.preferences import colours
from freecad.toolaxis.document.tool_colours import tool_colour
from freecad.toolaxis.gui.play.nodes import colour_node, revolve, solids, unpickable_node, view_of
from pivy import coin  # here, with the panel: it takes a while, in which nothing may wait that is computed
from PySide import QtCore

_TRIAD = (("X", (0.86, 0.15, 0.15)), ("Y", (0.20, 0.62, 0.20)), ("Z", (0.20, 0.35, 0.90)))
#: Widths of the cuts of the operation that is shown, and of the others, pixels.
_THICK, _THIN = 1.6, 1.0
#: Time between the parts that are put into the view, ms: the first drawing of each is slow.
STEP = 20


class Preview:
    """Things in the scene of a document's 3D view that are no objects; gone when the panel closes.

    They appear one by one, so that the window answers in between.

    Parameters
    ----------
    document : App.Document
    """

    def __init__(self, document):
        self.name = document.Name
        self.root = self.transform = None
        self.view = None
        self.stations = None
        self._others, self._shown_plan = None, None
        self._switch, self._tool_seen = None, True
        self._left = []
        self._timer = QtCore.QTimer()
        self._timer.setInterval(STEP)
        self._timer.timeout.connect(self._grow)

    def show(self, plan, op):
        """Show an operation with its tool where it has passes, and thinner the passes of all others.

        Parameters
        ----------
        plan : toolaxis.plan.plan.Plan
        op : toolaxis.plan.operation.Operation
        """
        if plan is not self._shown_plan:
            self.clear()
        self._clear_one()
        view = view_of(self.name)
        if view is None:
            return
        self.view = view
        if plan is not self._shown_plan:
            self._show_others(plan, view)
        if op.done:
            self._show_one(plan, op, view)
        self._timer.start()

    def _show_one(self, plan, op, view):
        """Show an operation with its tool."""
        root = unpickable_node()
        tool = coin.SoSeparator()
        self.transform = coin.SoTransform()
        tool.addChild(self.transform)
        self._switch = coin.SoSwitch()
        self._switch.addChild(tool)
        root.addChild(self._switch)
        self.show_tool(self._tool_seen)
        self._left = [(root, lambda: _lines(op.path, _colour_of(plan, op))),
                      (root, lambda: _frame(op.frame, 0.35 * op.face.diagonal)),
                      *([] if op.orientation.lead is None else [(root, lambda: _axes(op))]),
                      *((tool, partial(revolve, *solid)) for solid in solids(op.tool)), *self._left]
        self.stations = PreviewStations(op.path)
        self.root = root
        view.getSceneGraph().addChild(root)

    def _show_others(self, plan, view):
        """Show the passes of all operations of a plan, as long as it is the one that is shown."""
        self._shown_plan, self._others = plan, unpickable_node()
        view.getSceneGraph().addChild(self._others)
        done = [op for op in plan.operations if op.done]
        if len(plan.operations) > 1:  # also one alone: what is shown may be one without an axis
            self._left += [(self._others, partial(_cuts, op.path, _colour_of(plan, op), _THIN)) for op in done]

    def _grow(self):
        """Add one part; called until none is left."""
        if not self._left:
            self._timer.stop()
            return
        above, make = self._left.pop(0)
        above.addChild(make())

    def show_tool(self, seen):
        """Show or hide the tool, of this operation and of those that are shown later.

        Parameters
        ----------
        seen : bool
        """
        self._tool_seen = seen
        if self._switch is not None:
            self._switch.whichChild = coin.SO_SWITCH_ALL if seen else coin.SO_SWITCH_NONE

    def move(self, share):
        """Move the tool along the passes.

        Parameters
        ----------
        share : float
            0 at the first point of the first pass, 1 at the last of the last.
        """
        if self.root is None:
            return
        tip, axis = self.stations.at(share)
        self.transform.translation.setValue(*(float(x) for x in tip))
        self.transform.rotation.setValue(coin.SbRotation(coin.SbVec3f(0, 0, 1), coin.SbVec3f(*map(float, axis))))

    def clear(self):
        """Take everything out of the view."""
        for root in filter(None, (self.root, self._others)):
            with suppress(Exception):  # the view may be gone already, and its scene with it
                self.view.getSceneGraph().removeChild(root)
        self.forget()

    def _clear_one(self):
        """Take out of the view what belongs to the operation that is shown."""
        if self.root is not None:
            with suppress(Exception):  # the view may be gone already, and its scene with it
                self.view.getSceneGraph().removeChild(self.root)
        self.root = self.transform = self.stations = self._switch = None
        self._left = [(above, make) for above, make in self._left if above is self._others]

    def forget(self):
        """Let go without touching the view."""
        self.root = self.transform = self.view = self.stations = self._switch = None
        self._others = self._shown_plan = None
        self._left = []


class PreviewStations:
    """Places of the tool along the motions that are no links, by their share of the length.

    Parameters
    ----------
    path : toolaxis.cldata.toolpath.ToolPath
    """

    def __init__(self, path):
        from toolaxis.cldata.toolpath import Motion

        self.path = path
        steps = np.linalg.norm(np.diff(path.cl, axis=0), axis=1)
        steps[path.kind[1:] == Motion.LINK] = 0.0
        self.along = np.concatenate([[0.0], np.cumsum(steps)])

    def at(self, share):
        """Tip and axis of the tool, each (3,).

        Parameters
        ----------
        share : float
            0 to 1.
        """
        s = min(max(share, 0.0), 1.0) * self.along[-1]
        k = int(np.clip(np.searchsorted(self.along, s, side="left"), 1, len(self.along) - 1))
        step = self.along[k] - self.along[k - 1]
        part = (s - self.along[k - 1]) / step if step > 0 else 1.0
        axis = self.path.axis[k]
        return self.path.cl[k - 1] + part * (self.path.cl[k] - self.path.cl[k - 1]), axis / np.linalg.norm(axis)


def polylines(colour, lines, width):
    """Lines in one colour, on which no light falls.

    Parameters
    ----------
    colour : (float, float, float)
    lines : sequence of (k, 3) array
        mm
    width : float
        Pixels.
    """
    node = colour_node(colour, lit=False)
    style = coin.SoDrawStyle()
    style.lineWidth = width
    points = coin.SoCoordinate3()
    rows = np.concatenate(lines).astype(float)
    points.point.setValues(0, len(rows), rows.tolist())
    lineset = coin.SoLineSet()
    lineset.numVertices.setValues(0, len(lines), [len(line) for line in lines])
    for child in (style, points, lineset):
        node.addChild(child)
    return node


def _colour_of(plan, op):
    """The colour of an operation's cuts: that of its tool where there are several."""
    return tool_colour(plan.used_tools.index(op.tool)) if len(plan.tools) > 1 else colours()[0]


def _lines(path, colour):
    """The way of the tool's tip, in one colour where it cuts and in another between the passes."""
    node = _cuts(path, colour, _THICK)
    between = _runs(path, False)
    if between:
        node.addChild(polylines(colours()[1], between, 1.0))
    return node


def _cuts(path, colour, width):
    """The cuts of a path."""
    node = coin.SoSeparator()
    lines = _runs(path, True)
    if lines:
        node.addChild(polylines(colour, lines, width))
    return node


def contact_lines(path):
    """Where the tool touches the face as it cuts, (k, 3) arrays, mm.

    Parameters
    ----------
    path : toolaxis.cldata.toolpath.ToolPath
    """
    return [path.cc[run] for run in _slices(path, True)]


def _runs(path, cutting):
    """Polylines of a path's tip where the tool cuts, or where it does not."""
    return [path.cl[run] for run in _slices(path, cutting)]


def _slices(path, cutting):
    """Points of a path between which the tool cuts, or between which it does not."""
    from toolaxis.cldata.toolpath import Motion

    cut = np.asarray(path.kind[1:]) == Motion.CUT
    bounds = np.concatenate([[0], np.flatnonzero(np.diff(cut)) + 1, [len(cut)]])
    return [slice(i, j + 1) for i, j in pairwise(bounds) if j > i and cut[i] == cutting]


def _axes(op):
    """The axis that moves, as short lines along the passes."""
    from toolaxis.cldata.toolpath import Motion

    lines, _ = ends_of(op.path.cl, op.path.axis, op.path.kind == Motion.CUT, SHARE * op.face.diagonal)
    return polylines(COLOUR, list(lines), 1.2)


def _frame(frame, size):
    """The work coordinate system at its origin, where its object will stand in the document."""
    return triad(frame.origin, (frame.x, frame.y, frame.z), size)


def triad(origin, ways, size):
    """Three arrows X, Y and Z.

    Parameters
    ----------
    origin : (3,) array
        mm
    ways : sequence of (3,) array
        Their directions, unit vectors.
    size : float
        Their length, mm.
    """
    node = coin.SoAnnotation()  # drawn over everything: part of it may lie inside the part
    for (name, colour), way in zip(_TRIAD, ways, strict=True):
        tip = origin + size * way
        node.addChild(polylines(colour, [np.array([origin, tip])], 3.0))
        label = colour_node(colour, lit=False)
        move = coin.SoTranslation()
        move.translation.setValue(*(float(x) for x in tip + 0.06 * size * way))
        font = coin.SoFont()
        font.size = 16
        text = coin.SoText2()
        text.string = name
        for child in (move, font, text):
            label.addChild(child)
        node.addChild(label)
    return node
