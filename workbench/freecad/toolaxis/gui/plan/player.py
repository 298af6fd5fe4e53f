"""Plays a plan that is in no document yet, below its result."""

from dataclasses import replace

import FreeCAD
from freecad.toolaxis.document.machine_limits import mounting_in
from freecad.toolaxis.gui.play.bar import PlayBar, PlayWidgets
from freecad.toolaxis.gui.widgets.fields import tell
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.playing import lay_out, look_out, played_of

translate = FreeCAD.Qt.translate


class PlanPlayer:
    """Plays the plan of a panel as long as its button is down.

    Parameters
    ----------
    document : App.Document
    form : QWidget
        Of plan.ui.
    preview : freecad.toolaxis.gui.plan.preview.Preview
        Whose tool is hidden meanwhile.
    """

    def __init__(self, document, form, preview):
        self.document, self.form, self.preview = document, form, preview
        self.bar = PlayBar(document, PlayWidgets(form.play, form.playSlide, form.playSpeed, form.playClock,
                                                 form.playPointer, form.playMet))
        self.plan = self.work = None
        form.playFrame.setVisible(False)

    def show(self, plan, inputs, titles):
        """Play a plan from its beginning.

        Parameters
        ----------
        plan : toolaxis.plan.plan.Plan
            With an operation that has passes.
        inputs : freecad.toolaxis.document.inputs.JobInputs
            What it was made with.
        titles : dict of int to str
            What its operations are called, by their numbers.
        """
        self.close()
        self.plan = plan
        self.form.playAll.setChecked(True)
        self.form.playFrame.setVisible(True)
        self.preview.show_tool(False)
        try:
            played = played_of(plan, titles)
            mounted = self._mounting(plan, played[0].tool)
            copies = collisions.copies_around(self.document, [inputs])
        except Exception as reason:
            self._fail(sentence(reason))
            return
        self.work = BackgroundWork(lambda progress: lay_out(played, mounted))
        self.work.done.connect(lambda laid: self._show_tour(laid, copies))
        self.work.failed.connect(self._fail)
        self.work.start()

    def close(self):
        """Take everything out of the view; the preview shows its tool again."""
        self._leave()
        if self.plan is None:
            return
        self.plan = None
        self.bar.leave()
        self.bar.clear()
        self.preview.show_tool(True)
        self.form.playAll.setChecked(False)
        self.form.playFrame.setVisible(False)

    def forget(self):
        """Let go without touching the view, which goes with its document."""
        self._leave()
        self.plan = None
        self.bar.forget()

    def _leave(self):
        if self.work is not None:
            self.work.leave()
            self.work = None

    def _mounting(self, plan, tool):
        """The machine that the plan is for where the part's place on its table is known, else that of the document."""
        if plan.machine is not None and plan.machine.table_from_part is not None:
            return replace(plan.machine, tool_length=tool.gauge_length)
        return mounting_in(self.document, tool)

    def _fail(self, text):
        self.work = None
        self.bar.give_up()
        tell(self.form.playMet, text, bad=True)

    def _show_tour(self, laid, copies):
        self.bar.show(laid)
        self.work = BackgroundWork(lambda progress: look_out(laid, copies, progress))
        self.work.done.connect(self._show_collisions)
        self.work.failed.connect(lambda text: self._fail(translate(
            "ToolAxis", "Collisions could not be checked: {}").format(text)))
        self.work.start()

    def _show_collisions(self, found):
        self.work = None
        self.bar.show_collisions(found)
