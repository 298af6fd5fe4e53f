"""Origin and stock in the 3D view while they are chosen: a triad and the edges of a box."""

from contextlib import suppress

import numpy as np
from freecad.toolaxis.document.work_origin import origin_in_document
from freecad.toolaxis.gui.plan.preview import polylines, triad
from freecad.toolaxis.gui.play.nodes import view_of
from pivy import coin

from toolaxis.shape.work_origin import StockBox, locate_origin, parse_margins

#: Length of the triad's axes, in diagonals of the part.
_SHARE = 0.25
_EDGES = (0.30, 0.45, 0.60)
#: The way along the edges of a box, by its corners as binary numbers.
_WAY = (0, 1, 3, 2, 0, 4, 5, 7, 6, 4), (1, 5), (3, 7), (2, 6)


class SetupPreview:
    """Draws what the tab Setup holds, as long as it differs from the usual or its tab is open.

    Parameters
    ----------
    document : App.Document
    form : QWidget
        Of plan.ui.
    setup : freecad.toolaxis.gui.plan.setup_tab.SetupTab
    """

    def __init__(self, document, form, setup):
        self.name, self.form, self.setup = document.Name, form, setup
        self.view = self.root = None
        setup.on_change(self.show)
        setup.faces.on_change(self.show)
        form.tabs.currentChanged.connect(self._turned)

    def _turned(self, _):
        self.show()

    def show(self):
        """Draw it anew."""
        self.clear()
        setup = self.setup
        chosen = setup.origin or setup.stock_box or self.form.tabs.currentWidget() is self.form.setupTab
        view, box = view_of(self.name), setup.box if chosen else None
        if view is None or box is None:
            return
        nodes = self._nodes(np.array(box))
        if not nodes:
            return
        self.view, self.root = view, coin.SoSeparator()
        style = coin.SoPickStyle()
        style.style = coin.SoPickStyle.UNPICKABLE
        for node in (style, *nodes):
            self.root.addChild(node)
        view.getSceneGraph().addChild(self.root)

    def _nodes(self, box):
        """The triad, and the box where there is stock; nothing where they are refused."""
        from toolaxis.cad.freecad.documents import shape_of
        from toolaxis.errors import ToolAxisError

        setup = self.setup
        try:
            margins, shapes = parse_margins(setup.stock_box), [shape_of(thing) for thing in setup.things]
            origin = origin_in_document(setup.origin, shapes)
            where = locate_origin(origin, box, margins) if origin else np.array(shapes[0].Placement.Base)
        except ToolAxisError:
            return []
        found = []
        if self.form.tabs.currentWidget() is not self.form.resultTab:  # there the plan's own triad has the same origin
            found.append(triad(where, np.eye(3), _SHARE * float(np.linalg.norm(box[1] - box[0]))))
        if margins:
            stock = StockBox.around(box, margins)
            ends = np.array([stock.low, stock.high])
            corners = np.array([[ends[k & 1, 0], ends[k >> 1 & 1, 1], ends[k >> 2 & 1, 2]] for k in range(8)])
            found.append(polylines(_EDGES, [corners[list(way)] for way in _WAY], 1.5))
        return found

    def clear(self):
        """Take it out of the view."""
        if self.root is not None:
            with suppress(Exception):  # the view may be gone already, and its scene with it
                self.view.getSceneGraph().removeChild(self.root)
        self.forget()

    def forget(self):
        """Let go without touching the view."""
        self.view = self.root = None
