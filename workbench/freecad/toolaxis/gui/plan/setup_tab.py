"""The tab Setup of the planning panel: the origin of the work coordinate systems, and the stock."""

from contextlib import suppress

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.work_origin import box_around, is_picked, origin_from_vertex
from freecad.toolaxis.gui.plan.selection import owner_of
from freecad.toolaxis.gui.widgets.quantity import QuantityField, length_text, number_text, shown_unit

from toolaxis.shape.work_origin import PLACES, StockBox, format_margins, parse_margins, parse_origin

translate = FreeCAD.Qt.translate

#: Kinds of origins in the order of the layout.
_OWN, _STOCK, _PART, _PICKED = range(4)
_BODIES = {_STOCK: "stock", _PART: "part"}
_BY_JOB, _BOX = range(2)
_MARGINS = tuple(f"margin{axis}{way}" for axis in "XYZ" for way in ("Low", "High"))
#: Margins of a new stock, mm: those that FreeCAD's jobs begin with.
_USUAL = 1.0


class SetupTab:
    """Reads and fills the fields of the tab.

    Parameters
    ----------
    form : QWidget
        Of plan.ui.
    faces : freecad.toolaxis.gui.plan.face_list.FaceList
        What is machined.
    """

    def __init__(self, form, faces):
        self.form, self.faces = form, faces
        self.margins = [QuantityField(getattr(form, name), decimals=(2, 4)) for name in _MARGINS]
        for field in self.margins:
            field.value = _USUAL
        self._picked, self._slots, self._quiet = "", [], False
        self._for_origin = False
        self.problem = ""
        faces.on_change(self._show)
        form.origin.currentIndexChanged.connect(self._origin_changed)
        form.originPlace.currentIndexChanged.connect(self._changed)
        form.stockKind.currentIndexChanged.connect(self._stock_changed)
        for field in self.margins:
            field.on_change(self._stock_changed)
        form.takeVertex.clicked.connect(self.take_vertex)
        self._show()

    def on_change(self, slot):
        """Call a slot without arguments whenever origin or stock change.

        Parameters
        ----------
        slot : callable
        """
        self._slots.append(slot)

    @property
    def origin(self):
        """The short form of the origin; empty for the part's own."""
        kind = self.form.origin.currentIndex()
        if kind == _PICKED:
            return self._picked
        if kind in _BODIES:
            return f"{_BODIES[kind]}:{tuple(PLACES)[max(self.form.originPlace.currentIndex(), 0)]}"
        return ""

    @property
    def stock_box(self):
        """The margins of the stock in their short form; empty where the CAM job makes it."""
        if self.form.stockKind.currentIndex() != _BOX:
            return ""
        return format_margins([field.value for field in self.margins])

    @property
    def refusal(self):
        """Why there is no origin yet, one sentence; empty where there is one."""
        if self.problem:
            return self.problem
        if self.form.origin.currentIndex() == _PICKED and not self._picked:
            return translate("ToolAxis", "Select a vertex of the part in the 3D view and press Use selected on the tab "
                                         "Setup")
        return ""

    def fill(self, inputs):
        """Show origin and stock of some inputs, which are of their form.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
        """
        self._quiet = True
        self._picked, self.problem, self._for_origin = "", "", False
        found = parse_origin(inputs.origin)
        if is_picked(inputs.origin):
            self._picked = inputs.origin
            self.form.origin.setCurrentIndex(_PICKED)
        elif found is None:
            self.form.origin.setCurrentIndex(_OWN)
        else:
            self.form.origin.setCurrentIndex(_STOCK if found[0] == "stock" else _PART)
            self.form.originPlace.setCurrentIndex(tuple(PLACES).index(found[1]))
        margins = parse_margins(inputs.stock_box)
        self.form.stockKind.setCurrentIndex(_BOX if margins else _BY_JOB)
        for field, value in zip(self.margins, margins or (_USUAL,) * 6, strict=True):
            field.value = value
        self._quiet = False
        self._show()

    def take_vertex(self):
        """Take the vertex that is selected in the 3D view as the origin."""
        from toolaxis.errors import ToolAxisError

        self.problem = translate("ToolAxis", "No vertex is selected: select a vertex of the part in the 3D view")
        for entry in FreeCADGui.Selection.getSelectionEx("", 0):
            for name in entry.SubElementNames:
                thing, vertex = owner_of(entry.Object, name)
                if not vertex.rsplit(".", 1)[-1].startswith("Vertex"):
                    continue
                if thing not in self.things:
                    self.problem = translate(
                        "ToolAxis", "The vertex does not belong to the part to machine: select one of {}").format(
                            ", ".join(one.Label for one in self.things))
                    continue
                try:
                    self._picked, self.problem = origin_from_vertex(thing, vertex), ""
                except ToolAxisError as reason:
                    self.problem = str(reason)
        self._changed()

    @property
    def things(self):
        """The parts that are machined."""
        return tuple(dict.fromkeys(thing for thing, _ in self.faces.faces))

    @property
    def box(self):
        """Lower and upper corner of the parts, (2, 3) mm in the document's space; None where they have no shape."""
        from toolaxis.cad.freecad.documents import shape_of
        from toolaxis.errors import ToolAxisError

        shapes = []
        for thing in self.things:
            with suppress(ToolAxisError):  # it is refused with the reason when it is computed with
                shapes.append(shape_of(thing))
        return box_around(shapes) if shapes else None

    def _origin_changed(self, kind):
        """A point of the stock needs the stock: its margins are asked for as long as that is the origin."""
        if self._quiet:
            return
        wanted = self.form.stockKind.currentIndex()
        if kind == _STOCK and wanted == _BY_JOB:
            wanted, self._for_origin = _BOX, True
        elif kind != _STOCK and self._for_origin:
            wanted, self._for_origin = _BY_JOB, False
        self._quiet = True
        self.form.stockKind.setCurrentIndex(wanted)
        self._quiet = False
        self._changed()

    def _stock_changed(self, *_):
        """What the user has chosen of the stock stays, whatever the origin."""
        if not self._quiet:
            self._for_origin = False
        self._changed()

    def _changed(self, *_):
        if self._quiet:
            return
        self._show()
        for slot in self._slots:
            slot()

    def _show(self):
        """Show the fields that count, and what they come to."""
        form, kind = self.form, self.form.origin.currentIndex()
        for widget in (form.originPlace, form.originPlaceLabel):
            widget.setVisible(kind in _BODIES)
        for widget in (form.originPicked, form.originPickedLabel, form.takeVertex):
            widget.setVisible(kind == _PICKED)
        form.originPicked.setText(self._picked_text())
        form.marginsGroup.setVisible(form.stockKind.currentIndex() == _BOX)
        form.stockSize.setText(self._size_text())

    def _picked_text(self):
        """The coordinates of the picked vertex in the part's own frame."""
        if not self._picked:
            return translate("ToolAxis", "no vertex")
        unit, factor = shown_unit("mm")
        return f"{'; '.join(number_text(value / factor, 2, 3) for value in parse_origin(self._picked)[1])} {unit}"

    def _size_text(self):
        """The lengths of the stock, a sentence; empty where there is none."""
        from toolaxis.errors import ToolAxisError

        box = self.box if self.form.stockKind.currentIndex() == _BOX else None
        if box is None:
            return ""
        try:
            size = StockBox.around(box, parse_margins(self.stock_box)).size
        except ToolAxisError:
            return ""
        return translate("ToolAxis", "Stock: {}").format(" x ".join(length_text(length) for length in size))
