"""The faces to machine, as the panel has the user choose them: from the selection, listed, and lit in the 3D view."""

import re

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.read_shapes import faces_by_number
from freecad.toolaxis.gui.plan.camera import camera_of
from freecad.toolaxis.gui.plan.face_list import ALL, face_key
from freecad.toolaxis.gui.plan.selection import faces_of_only_body, selected_faces
from freecad.toolaxis.gui.plan.skin_search import SkinSearch
from freecad.toolaxis.gui.plan.view_watch import ViewWatch
from freecad.toolaxis.services.background import BackgroundWork
from freecad.toolaxis.services.obstacles import bodies_in
from freecad.toolaxis.services.sight import scene_of
from PySide import QtCore

translate = FreeCAD.Qt.translate

#: What a stage of the computation says of the face that it is about.
_FACE = re.compile(r"\b[Ff]ace (\d+)")


class FaceChoice(QtCore.QObject):
    """What the widgets around the list of faces do; which faces there are is told by the fields.

    Parameters
    ----------
    document : App.Document
    form : QWidget
        Of plan.ui.
    fields : freecad.toolaxis.gui.plan.form.PlanForm
    """

    added = QtCore.Signal(str)
    """The selection was added; what is wrong with it, or empty."""

    def __init__(self, document, form, fields):
        super().__init__(form)
        self.document, self.form, self.fields = document, form, fields
        self.skins = SkinSearch(form, fields.faces)
        self._numbered, self._lit = {}, None
        self.watch, self.looking = ViewWatch(document, self), None

    def connect_widgets(self):
        """Begin to listen; what is filled in before tells nothing."""
        form = self.form
        self.fields.racks.on_change(self._take_only_body)
        self.fields.earlier.on_change(self._offer_bodies)
        form.addFaces.clicked.connect(self._add_selected)
        form.removeFaces.clicked.connect(self.fields.faces.remove_marked)
        form.facesFilter.textChanged.connect(self.fields.faces.show_matching)
        form.facesSeen.activated.connect(self._list_seen)
        form.faces.itemSelectionChanged.connect(self._point_out)
        form.facesTold.installEventFilter(self)
        self.skins.found.connect(self.tell)
        self.watch.rested.connect(self._look_again)

    def _add_selected(self):
        faces, problems = selected_faces(self.document)
        nothing = translate("ToolAxis", "Nothing is selected: select faces or a body in the 3D view first")
        self.fields.faces.add(faces)
        self._offer_bodies()
        self.added.emit("; ".join(problems) or ("" if faces else nothing))

    def _list_seen(self, kind):
        """List all faces, or those that can be seen as the view stands, or the others."""
        self._stop_looking()
        if kind == ALL:
            self.fields.faces.show_kind(kind)
            return
        self.fields.faces.show_kind(kind, self._hidden_task()(None))
        self.watch.begin()

    def _hidden_task(self):
        """The keys of what cannot be seen as the view stands now, as a computation apart from the document."""
        listed, camera = self.fields.faces.listed, camera_of(self.document)
        keys = list(map(face_key, listed))
        scene = scene_of(listed, bodies_in(self.document, [thing for thing, _ in listed]))
        return lambda progress: [keys[k] for k in scene.hidden(camera, progress)]

    def _look_again(self):
        """The view was turned: list what can be seen now, found off the GUI thread."""
        if not self.form.faces.isEnabled():  # it is computed; the list is looked at afterwards
            self.watch.look_again()
            return
        if self.looking is not None:
            self.looking.leave()
        self.looking = BackgroundWork(self._hidden_task(), self)
        self.looking.done.connect(self._looked)
        self.looking.start()

    def _looked(self, hidden):
        self.looking = None
        self.fields.faces.show_kind(self.form.facesSeen.currentIndex(), hidden)

    def _stop_looking(self):
        self.watch.leave()
        if self.looking is not None:
            self.looking.leave()
            self.looking = None

    def leave(self):
        """Give up all that goes on."""
        self.skins.leave()
        self._stop_looking()

    def _offer_bodies(self):
        """Offer all bodies to be avoided but those that are machined."""
        parts = [thing for thing, _ in self.fields.faces.faces]
        self.fields.avoid.offer(bodies_in(self.document, parts), self.fields.avoid.ticked)

    def _take_only_body(self):
        """A rack machines whole parts: where no face was chosen, all of the only body is."""
        if self.fields.racks.chosen and not self.fields.faces.faces:
            self.fields.faces.add(faces_of_only_body(self.document))
            self._offer_bodies()

    def _point_out(self):
        """Select in the 3D view what is marked in the list."""
        self._select(self.fields.faces.marked)

    def _select(self, faces):
        """Select faces in the 3D view, and nothing else."""
        FreeCADGui.Selection.clearSelection(self.document.Name)
        for thing, name in faces:
            FreeCADGui.Selection.addSelection(self.document.Name, thing.Name, name)

    def tell(self):
        """Say how many faces or skins are machined, and of what; all of it is in the tooltip where there is no room."""
        self.form.facesTold.setToolTip(self.fields.faces.summary())
        self._fit_told()

    def eventFilter(self, watched, event):
        """Qt asks what becomes of an event."""
        if event.type() == QtCore.QEvent.Resize:
            self._fit_told()
        return False

    def _fit_told(self):
        label = self.form.facesTold
        label.setText(label.fontMetrics().elidedText(label.toolTip(), QtCore.Qt.ElideRight, label.width()))

    def begin(self, inputs):
        """Know the faces of what is computed now.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
        """
        self._numbered, self._lit = faces_by_number(inputs), None
        self.skins.pause()

    def light(self, stage):
        """Light up in the 3D view, and mark in the list, what is being computed.

        Parameters
        ----------
        stage : str
            What the computation reports.
        """
        number = _FACE.search(stage)
        face = None if number is None else self._numbered.get(int(number.group(1)))
        if face is not None and face != self._lit:
            self._lit = face
            self._select(self.fields.faces.mark(face))

    def show_planned(self, inputs, plan):
        """List the skins of a plan as it machines them, and light up nothing: that would lie over what is shown.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
        plan : toolaxis.plan.plan.Plan
        """
        self.form.faces.clearSelection()
        FreeCADGui.Selection.clearSelection(self.document.Name)
        if inputs.rack and plan.outcome != "cancelled":
            skins = dict.fromkeys(op.face.numbers for op in plan.operations if len(op.face.numbers) > 1)
            self.skins.show(inputs, [tuple(self._numbered[n] for n in skin) for skin in skins])
