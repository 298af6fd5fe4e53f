"""The task panel of Plan Orientations: fields, Compute, the map, and OK as one undo step."""

from contextlib import suppress
from dataclasses import replace

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.earlier_setups import fingerprint_of
from freecad.toolaxis.document.inputs import JobInputs, inputs_of
from freecad.toolaxis.document.kinds import is_operation, plan_of
from freecad.toolaxis.document.machine_limits import offered
from freecad.toolaxis.document.placement import chain_of
from freecad.toolaxis.document.plan_account import account_from
from freecad.toolaxis.document.read_shapes import titles_of
from freecad.toolaxis.gui.axis_map.raster import axis_picture, picture_of
from freecad.toolaxis.gui.pictures.window import show_pictures
from freecad.toolaxis.gui.plan.account import headline
from freecad.toolaxis.gui.plan.face_choice import FaceChoice
from freecad.toolaxis.gui.plan.form import PlanForm
from freecad.toolaxis.gui.plan.growth import RackGrowth, digest_piece
from freecad.toolaxis.gui.plan.locks import AxisLocks
from freecad.toolaxis.gui.plan.move_origin import move_origin
from freecad.toolaxis.gui.plan.outcome import outcome_sentence
from freecad.toolaxis.gui.plan.part_size import size_note
from freecad.toolaxis.gui.plan.player import PlanPlayer
from freecad.toolaxis.gui.plan.preview import Preview
from freecad.toolaxis.gui.plan.remedy_row import RemedyRow
from freecad.toolaxis.gui.plan.result_tab import AxisView
from freecad.toolaxis.gui.plan.selection import selected_faces, selects_whole_bodies
from freecad.toolaxis.gui.plan.setup_preview import SetupPreview
from freecad.toolaxis.gui.plan.tool_offer import ToolOffer
from freecad.toolaxis.gui.widgets.fields import fit_pages, load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.gui.widgets.progress_line import ProgressLine
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import api
from freecad.toolaxis.services.background import BackgroundWork, one_line, sentence
from freecad.toolaxis.services.defaults import defaults
from freecad.toolaxis.services.macros import again_lines, plan_line, record
from freecad.toolaxis.services.messages import stale_text
from freecad.toolaxis.services.obstacles import bodies_in
from freecad.toolaxis.services.pictures import drawn
from freecad.toolaxis.services.write_results import apply
from PySide import QtWidgets

from toolaxis.report.areas_aside import has_clamped_area

translate = FreeCAD.Qt.translate

#: Tabs that scroll, each for itself, below what is always in sight.  The layout has all of it in a splitter with one
#: side: FreeCAD gives a panel whose height depends on its width, as that of a label of several lines does, all the
#: height it would like, and scrolls it as a whole; a splitter tells no such thing.
_PAGES = ("jobTab", "setupTab", "toolTab", "advancedTab", "resultTab")
#: Axes that make a map worth showing.
_ENOUGH = 40


class PlanPanel(Panel):
    """FreeCAD calls accept and the functions about buttons; everything else is the panel's own.

    Parameters
    ----------
    document : App.Document
    inputs : freecad.toolaxis.document.inputs.JobInputs, optional
        What the fields show at first; sensible defaults for the selection unless given.
    operation : object, optional
        The operation that is planned again.
    """

    def __init__(self, document, inputs=None, operation=None):
        super().__init__(document, load_form("plan"))
        self.operation = operation
        self.form.setWindowIcon(FreeCADGui.getIcon(str(RESOURCES / "icons" / "plan.svg")))
        self.fields = PlanForm(self.form)
        self.preview = Preview(document)
        self.setup_preview = SetupPreview(document, self.form, self.fields.setup)
        self.view = AxisView(self.form, self.preview)
        self.growth = RackGrowth(document, self.form.toolTable, self.form.growthNote)
        self.player = PlanPlayer(document, self.form, self.preview)
        self.remedies = RemedyRow(self.form)
        self.choice = FaceChoice(document, self.form, self.fields)
        self.tools = ToolOffer(document, self.form, self.fields)
        self.ongoing = ProgressLine(self.form, self._tell, lambda: self.work is not None and self.form.stop.isEnabled())
        self.computed, self.refusal = None, ""
        self.followed = ""
        self.outrun = False
        self._fill(inputs)
        self._connect()
        self._follow()
        self._changed()

    # what FreeCAD calls

    def getStandardButtons(self):
        """OK and Cancel."""
        return QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel

    def modifyStandardButtons(self, box):
        """Called by FreeCAD with the box of buttons; OK stays locked until there is a plan, and `accept` refuses."""
        super().modifyStandardButtons(box)
        self.show_state()

    def accept(self):
        """Put the plan into the document, as one undo step; refused without a plan."""
        if not self._put_into_document():
            return False
        self._close()
        return True

    def _put_into_document(self):
        """Put the plan into the document, as one undo step; its operations, none where it is refused."""
        if not self.ready:
            return []
        if fingerprint_of(self.computed.after) != self.followed:  # the earlier setup has changed meanwhile
            self.computed = None
            self.show_state()
            return []
        plan = self.view.plan
        inputs = replace(self.computed, pieces=self._pieces())
        before = None if self.operation is None else inputs_of(self.operation)
        try:
            made = apply(self.document, inputs, plan, self.operation)
        except Exception as reason:
            self._tell(sentence(reason), bad=True)
            FreeCAD.Console.PrintLog(f"{reason!r}\n")
            return []
        record(*([plan_line(inputs)] if before is None else again_lines(self.operation, before, inputs)))
        return made

    def plan_next_setup(self):
        """Put the plan into the document, and open the panel for the setup after it."""
        inputs, document = self.computed, self.document
        made = self._put_into_document()
        if made:
            following = replace(inputs, after=plan_of(made[0]), held="", pieces=())
            self._open_instead(lambda: PlanPanel(document, following))

    # state

    @property
    def ready(self):
        """Whether there is a plan for what the fields hold, with an axis for at least one face."""
        plan = self.view.plan
        return (plan is not None and self.work is None and self.computed is not None and not self.refusal
                and any(op.done for op in plan.operations))

    def _fill(self, inputs):
        faces, problems = selected_faces(self.document)
        if inputs is None:
            inputs = defaults(self.document, faces, selects_whole_bodies(self.document))
        text = getattr(self.operation, "Account", "")
        self.standing = account_from(text)
        self.view.show_account(self.standing)
        self.given = inputs.pieces
        self.keeps = self.operation is not None and is_operation(self.operation) and bool(self.given)
        self.fields.offer_machines(offered(self.document))
        self.fields.earlier.offer(self.document, self.operation)
        self.fields.fill(inputs)
        bodies = bodies_in(self.document, [thing for thing, _ in inputs.faces])
        self.fields.avoid.offer(bodies, inputs.obstacles)
        if self.operation is not None and not inputs.faces:
            problems = [translate("ToolAxis", "The part was deleted: select other faces")]
        self.problem = "; ".join(problems)

    def _connect(self):
        form = self.form
        self.fields.on_change(self._edited)
        self.choice.connect_widgets()
        self.fields.setup.on_change(self._setup_edited)
        self.choice.added.connect(self._faces_added)
        form.tool.activated.connect(self._tool_chosen)
        form.compute.clicked.connect(self.compute)
        form.stop.clicked.connect(self.stop)
        form.pictures.clicked.connect(self.draw)
        form.playAll.toggled.connect(self.play)
        self.view.changed.connect(self.show_state)
        self.view.told.connect(self._warn)
        self.view.curve.picked.connect(self.compute_with)
        self.remedies.chosen.connect(self.compute_again)
        form.nextSetup.clicked.connect(self.plan_next_setup)

    def _faces_added(self, problem):
        self.problem = problem
        self._changed()

    def _tool_chosen(self, index):
        if index:  # else it is typed in
            self.problem = self.tools.take(index) or self.problem
            self._changed()

    def _setup_edited(self):
        """Origin and stock change no axis: a plan that is there goes along."""
        if not move_origin(self):
            self._edited()

    def _edited(self):
        """The user has changed a field: what no field could show is given up."""
        self.fields.unshown = ""
        self._changed()

    def _changed(self):
        """Something in the fields is different: check it, and lock OK until it is computed again."""
        if self.work is None:
            self.computed = None
            self.remedies.clear()
        self.refusal = self.fields.refusal()
        if self.work is None:
            self._look_at_fields()
        self.choice.tell()
        self.show_state()

    def _look_at_fields(self):
        """Offer what may help where they are refused, else look for the skins of a rack."""
        try:
            inputs = JobInputs(**self.fields.read(), pieces=self._pieces())
        except ValueError:  # a cell of a table is no length
            return
        if self.fields.reason:
            self.remedies.show_advice(self.fields.reason, inputs)
        self.choice.skins.seek(None if self.refusal else inputs)

    def show_state(self):
        """Enable what can be done now, and say how things stand."""
        form, computing = self.form, self.work is not None
        form.compute.setEnabled(not computing and not self.refusal)
        form.stop.setEnabled(computing)
        form.progress.setVisible(computing)
        for page in (form.jobPage, form.setupPage, form.toolPage, form.advancedPage, self.view.map, self.view.curve):
            page.setEnabled(not computing)
        form.playAll.setEnabled(self.ready)
        form.nextSetup.setVisible(self.ready and has_clamped_area(self.view.plan))
        if not self.ready or self.player.plan is not self.view.plan:
            self.player.close()
        if self.buttons is not None:
            with suppress(RuntimeError):
                self.buttons.button(QtWidgets.QDialogButtonBox.Ok).setEnabled(self.ready)
        if not computing:
            self._tell(*self._state())
        fit_pages(form, _PAGES)

    def _state(self):
        """The sentence that tells how things stand, and whether it is bad."""
        if self.problem:
            return self.problem, True
        if self.refusal:
            return self.refusal, bool(self.fields.faces.faces)
        plan = self.view.plan
        if plan is None and self.operation is not None and self.operation.Stale:
            return stale_text(self.operation), True
        if plan is None:
            told = translate("ToolAxis", "Press Compute to find the axes.")
            if self.standing is not None:
                return f"{headline(self.standing)} {told}", False
            odd = size_note(dict.fromkeys(thing for thing, _ in self.fields.faces.faces))
            return (f"{odd} {told}" if odd else told), bool(odd)
        if self.computed is None:
            return translate("ToolAxis", "Inputs have changed: compute again."), True
        return outcome_sentence(plan)

    def _tell(self, text, bad=False):
        tell(self.form.message, text, bad)

    def _warn(self, text):
        """A slot of its own: the bindings hold a function without a name, and with it the panel, to the end."""
        self._tell(text, bad=True)

    # computing

    def compute(self):
        """Compute off the GUI thread; refused while the fields are not right."""
        self.refusal = self.fields.refusal()
        if self.refusal or self.work is not None:
            self.show_state()
            return
        self.problem, self.outrun, self.standing = "", False, None
        self.remedies.clear()
        inputs = JobInputs(**self.fields.read(), pieces=self._pieces())
        self.view.leave()
        if self.view.plan is None:
            self.view.clear()
        self.preview.clear()
        try:
            task = api.task(inputs)
        except Exception as reason:
            self.problem = sentence(reason)
            self.remedies.show_advice(one_line(reason), inputs)
            self.show_state()
            return
        titles, self.followed = titles_of(inputs), fingerprint_of(inputs.after)
        self.choice.begin(inputs)
        self.work = BackgroundWork(lambda progress: _make_plan(task, progress), None, _growing, digest_piece)
        known = {} if inputs.rack else titles
        self.work.interim.connect(lambda found: self._growing(*found, known))
        self.work.pieces.connect(self._pieces_found)
        self.work.progressed.connect(self.ongoing.report)
        self.work.progressed.connect(self._light)
        self.work.done.connect(lambda found: self._computed(inputs, *found, titles))
        self.work.failed.connect(lambda message: self._refused(inputs, message))
        self.work.cancelled.connect(lambda: self._not_computed(""))
        self.show_state()
        self.ongoing.begin(translate("ToolAxis", "Reading the part"))
        self.work.start()

    def draw(self):
        """Draw the plan that is shown, off the GUI thread, and open the window with its pictures."""
        plan = self.view.plan
        if plan is None or self.work is not None:
            return
        self.view.leave()
        self.work = BackgroundWork(lambda progress: drawn(plan, progress))
        self.work.progressed.connect(self.ongoing.report)
        self.work.done.connect(self._drawn)
        self.work.failed.connect(self._not_computed)
        self.work.cancelled.connect(lambda: self._drawn(()))
        self.show_state()
        self.ongoing.begin(translate("ToolAxis", "Drawing"))
        self.work.start()

    def play(self, wanted):
        """Run the tool along all operations of the plan that is shown, or end that.

        Parameters
        ----------
        wanted : bool
        """
        if not wanted or not self.ready:
            self.player.close()
        elif self.player.plan is None:
            self.player.show(self.view.plan, self.computed, self.view.operation_titles)

    def _drawn(self, pictures):
        self.work = None
        self.show_state()
        if pictures:
            show_pictures(pictures)

    def compute_with(self, count):
        """Compute again with a number of different axes.

        Parameters
        ----------
        count : int
        """
        if self.work is None:
            self.fields.set_count("orientations", count)
            self.compute()

    def compute_again(self, inputs):
        """Show other inputs in the fields, and compute with them.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
        """
        if self.work is None:
            self.fields.fill(inputs)
            self._edited()
            self.compute()

    def _pieces(self):
        """The sub-surfaces that are kept: those of the plan that is shown, else those that the panel began with.

        A rack is planned without any.
        """
        if self.fields.racks.chosen:
            return ()
        if self.view.plan is not None and self.view.locks.owners:
            found = self.view.locks.pieces(self.view.plan, every=self.keeps)
        else:
            found = self.given
        chosen = {(thing.Name, name) for thing, name in self.fields.faces.faces}
        return tuple(piece for piece in found if (piece.thing.Name, piece.name) in chosen)

    def stop(self):
        """Ask the computation to stop."""
        if self.work is not None:
            self.form.stop.setEnabled(False)
            self._tell(translate("ToolAxis", "Stopping"))
            self.work.cancel()

    def _growing(self, picture, face, titles):
        """The map of the axes looked at so far for one of the faces."""
        if self.work is not None:
            if not self.view.growing and self.growth.empty:
                self.form.tabs.setCurrentWidget(self.form.resultTab)
            self.view.show_growing(picture, face, titles)

    def _pieces_found(self, pieces):
        """What tools reach, and finished passes, while a rack is planned."""
        if self.work is not None:
            if self.growth.empty:
                self.view.begin_growing()
                self.form.tabs.setCurrentWidget(self.form.resultTab)
            self.growth.add(pieces)

    def _light(self, stage, _):
        self.choice.light(stage)

    def _computed(self, inputs, plan, pictures, titles):
        self.work = None
        self.growth.clear()
        if not plan.operations:
            self._not_computed("")
            return
        self.computed = None if self.outrun else inputs
        self.choice.show_planned(inputs, plan)
        self.view.show(plan, pictures, titles, AxisLocks(inputs, plan))
        self.remedies.show(plan, inputs)
        self.form.tabs.setCurrentWidget(self.form.resultTab)
        self.show_state()

    def _refused(self, inputs, message):
        """Say why nothing was computed, and offer what that advises."""
        advice = self.work.message
        self._not_computed(message)
        self.remedies.show_advice(advice, inputs)
        fit_pages(self.form, _PAGES)

    def _not_computed(self, message):
        self.work = None
        self.growth.clear()
        self.form.faces.clearSelection()
        self.problem = message
        if self.view.plan is None:
            self.view.clear()
        self.view.show_tool()
        self.show_state()
        if not message:
            self._tell(translate("ToolAxis", "Stopped; the document is unchanged."))

    # what happens to the document meanwhile

    def object_deleted(self, name):
        """A part is about to be deleted: take its faces off the list, and stop what is computed for them."""
        if self.operation is not None and self.operation.Name == name:
            self.operation = None  # what is planned again becomes a new one
        self.tools.forget(name)
        if self.fields.faces.remove_object(name):
            self.problem = translate("ToolAxis", "The part was deleted: select other faces")
        elif self.fields.earlier.remove_object(name):
            self.problem = translate("ToolAxis", "The earlier setup was deleted: choose another one, or none")
        elif self.fields.avoid.remove_object(name):
            self.problem = translate("ToolAxis", "A body to avoid was deleted: compute again without it")
        else:
            return
        self._leave()
        self.growth.clear()
        self.computed = None
        self.view.clear()
        self._changed()

    def object_changed(self, name):
        """A part, a body to avoid, or what carries one has changed: what was computed for it no longer counts."""
        things = {thing.Name: thing for thing, _ in self.fields.faces.faces}
        things |= {body.Name: body for body in self.fields.avoid.ticked}
        if any(one.Name == name for thing in things.values() for one in (thing, *chain_of(thing))):
            self.outrun = True
            self.setup_preview.show()
            if self.work is None:
                self._changed()

    def _forget_view(self):
        self.player.forget()
        self.preview.forget()
        self.growth.forget()
        self.setup_preview.forget()

    def _let_go(self):
        self.choice.leave()
        self.player.close()
        self.view.leave()
        self.preview.clear()
        self.growth.clear()
        self.setup_preview.clear()


def _growing(offered):
    """Picture and face of an intermediate result, None while it is too coarse; runs off the GUI thread."""
    face, found = offered
    picture = picture_of(face, found) if len(found.axis) >= _ENOUGH else None
    return None if picture is None else (picture, face)


def _make_plan(task, progress):
    """Plan and pictures; runs off the GUI thread."""
    from toolaxis.errors import Cancelled
    from toolaxis.progress import NO_PROGRESS

    plan = task(progress)
    pictures = {}
    for op in plan.operations:
        with suppress(Cancelled):  # the plan is there: it is shown, whoever pressed Stop after its last step
            progress.report(translate("ToolAxis", "drawing the map"), op.number - 1, len(plan.operations))
        pictures[op.number] = axis_picture(plan, op, NO_PROGRESS)
    return plan, pictures
