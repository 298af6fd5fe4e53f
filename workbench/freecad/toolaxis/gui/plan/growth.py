"""What a computation with several tools has found so far: what each tool reaches, and finished passes."""

from contextlib import suppress
from dataclasses import dataclass

import FreeCAD
import numpy as np
from freecad.toolaxis.document.colour_scale import scale_colours
from freecad.toolaxis.gui.plan.account import ReachedByTool, fill_reached
from freecad.toolaxis.gui.plan.preview import STEP, contact_lines, polylines
from freecad.toolaxis.gui.play.nodes import colour_node, unpickable_node, view_of
from pivy import coin
from PySide import QtCore

translate = FreeCAD.Qt.translate

#: Size of the points that stand for cells, pixels, and how far above the face they are drawn, in widths of a cell.
_POINT, _ABOVE = 5.0, 0.2
#: What no tool reaches.
_GREY = (0.45, 0.45, 0.45)
#: Width of cuts, pixels.
_WIDTH = 1.2


@dataclass
class SeenCells:
    """Points of a face for which one tool is the largest that reaches them.

    Attributes
    ----------
    tools : tuple of toolaxis.tools.tool.Tool
        All tools of the rack, the larger ones first.
    tool : toolaxis.tools.tool.Tool or None
        None where no tool reaches them.
    points : (n, 3) array
        mm
    area : float
        mm^2 that they stand for.
    """

    tools: tuple
    tool: object
    points: np.ndarray
    area: float


@dataclass
class SeenCuts:
    """Where a finished operation touches the face.

    Attributes
    ----------
    tool : toolaxis.tools.tool.Tool
    lines : list of (k, 3) array
        mm
    area : float
        mm^2 that it machines.
    """

    tool: object
    lines: list
    area: float


def digest_piece(piece):
    """What is shown of a piece of a plan with several tools; runs off the GUI thread.

    Parameters
    ----------
    piece : toolaxis.job.planning.rack_screening.LargestTools or toolaxis.plan.operation.Operation

    Returns
    -------
    list of SeenCells and SeenCuts
    """
    from toolaxis.plan.operation import Operation

    if isinstance(piece, Operation):
        return [SeenCuts(piece.tool, contact_lines(piece.path), piece.face.area * (1 - piece.orientation.unreached))]
    points = piece.point + _ABOVE * np.sqrt(piece.area)[:, None] * piece.normal
    tools = (*piece.tools, None)
    rows = [(tools[place], piece.largest == place) for place in np.unique(piece.largest)]
    return [SeenCells(piece.tools, tool, points[chosen], float(piece.area[chosen].sum())) for tool, chosen in rows]


class RackGrowth:
    """Shows in the 3D view, and as a table of the tools, what was handed over; gone when the plan is there.

    Parts appear one by one in the view, so that the window answers in between.

    Parameters
    ----------
    document : App.Document
    table : QTableWidget
    note : QLabel
        Says what points and lines stand for.
    """

    def __init__(self, document, table, note):
        self.name, self.table, self.note = document.Name, table, note
        self._timer = QtCore.QTimer()
        self._timer.setInterval(STEP)
        self._timer.timeout.connect(self._draw_next)
        self.forget()

    @property
    def empty(self):
        """Whether nothing is shown."""
        return not (self._reached or self._machined)

    def forget(self):
        """Let go without touching the view."""
        self._timer.stop()
        self.root = self.view = None
        self._waiting = []
        self._colours = {}
        self._reached, self._machined = {}, {}

    def clear(self):
        """Take everything out of the view."""
        if self.root is not None:
            with suppress(Exception):  # the view may be gone already, and its scene with it
                self.view.getSceneGraph().removeChild(self.root)
        self.forget()
        self.note.hide()

    def add(self, pieces):
        """Show further pieces.

        Parameters
        ----------
        pieces : list of lists of SeenCells and SeenCuts
        """
        if self.root is None:
            self._begin()
        found = [one for some in pieces for one in some]
        for piece in found:
            kept = self._machined if isinstance(piece, SeenCuts) else self._reached
            kept[piece.tool] = kept.get(piece.tool, 0.0) + piece.area
            if isinstance(piece, SeenCells) and not self._colours:
                self._colours = dict(zip(piece.tools, scale_colours(len(piece.tools)) / 255, strict=True))
        seen = [tool for tool in self._colours if tool in self._reached or tool in self._machined]
        fill_reached(self.table, [self._row(tool) for tool in seen], sum(self._reached.values()))
        if self.root is not None:
            self._waiting += found
            self._timer.start()

    def _begin(self):
        self.note.setText(translate("ToolAxis", "Points: the largest tool that was found to reach the face there, grey "
                                                "where none was found so far; an estimate. Lines: finished passes."))
        self.note.show()
        self.view = view_of(self.name)
        if self.view is not None:
            self.root = unpickable_node()
            self.view.getSceneGraph().addChild(self.root)

    def _draw_next(self):
        """Draw one piece; called until none is left."""
        if not self._waiting:
            self._timer.stop()
            return
        self.root.addChild(self._node(self._waiting.pop(0)))

    def _node(self, piece):
        colour = self._colours.get(piece.tool, _GREY)
        if isinstance(piece, SeenCuts):
            return polylines(colour, piece.lines, _WIDTH) if piece.lines else coin.SoSeparator()
        return points_node(colour, piece.points)

    def _row(self, tool):
        return ReachedByTool(tuple(self._colours[tool]), tool.number, tool.shop_name, self._reached.get(tool, 0.0),
                             self._machined.get(tool, 0.0))


def points_node(colour, points):
    """Points in one colour, on which no light falls.

    Parameters
    ----------
    colour : (float, float, float)
    points : (n, 3) array
        mm
    """
    node = colour_node(colour, lit=False)
    style = coin.SoDrawStyle()
    style.pointSize = _POINT
    places = coin.SoCoordinate3()
    places.point.setValues(0, len(points), np.asarray(points, dtype=float).tolist())
    for child in (style, places, coin.SoPointSet()):
        node.addChild(child)
    return node
