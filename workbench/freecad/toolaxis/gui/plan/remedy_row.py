"""What is offered by a click where a face has no axis: a longer stick-out, another cutter, several axes, no limits."""

from dataclasses import replace

import FreeCAD
from freecad.toolaxis.gui.widgets.quantity import length_text
from PySide import QtCore

translate = FreeCAD.Qt.translate


class RemedyRow(QtCore.QObject):
    """Buttons below the message of the planning panel.

    Parameters
    ----------
    form : QWidget
        Of plan.ui.
    """

    chosen = QtCore.Signal(object)
    """The inputs with the remedy that was clicked."""

    def __init__(self, form):
        super().__init__(form)
        self.buttons = [form.remedy1, form.remedy2, form.remedy3]
        self.offers = []
        for k, button in enumerate(self.buttons):
            button.clicked.connect(lambda _=False, k=k: self._choose(k))
        self.clear()

    def show(self, plan, inputs):
        """Offer what may help with a plan.

        Parameters
        ----------
        plan : toolaxis.plan.plan.Plan
        inputs : freecad.toolaxis.document.inputs.JobInputs
            What it was made with.
        """
        from toolaxis.plan.remedies import remedies_of

        found = () if inputs.rack or inputs.moves else remedies_of(plan, inputs.divides)
        self.offers = [(one, use_remedy(inputs, one)) for one in found[:len(self.buttons)]]
        for k, button in enumerate(self.buttons):
            if k < len(self.offers):
                button.setText(words_of(self.offers[k][0]))
            button.setVisible(k < len(self.offers))

    def clear(self):
        """Offer nothing."""
        self.offers = []
        for button in self.buttons:
            button.setVisible(False)

    def _choose(self, k):
        if k < len(self.offers):
            self.chosen.emit(self.offers[k][1])


def words_of(remedy):
    """What a button says.

    Parameters
    ----------
    remedy : toolaxis.plan.remedies.Remedy
    """
    if remedy.name == "stickout":
        return translate("ToolAxis", "Stick-out {}").format(length_text(remedy.value))
    if remedy.name == "tool":
        return translate("ToolAxis", "Ball end D{}").format(length_text(float(remedy.value.partition(":")[2])))
    if remedy.name == "regions":
        return translate("ToolAxis", "Divide into sub-surfaces")
    return translate("ToolAxis", "Without limits")


def use_remedy(inputs, remedy):
    """Inputs with a remedy.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    remedy : toolaxis.plan.remedies.Remedy
    """
    words = {remedy.name: remedy.value}
    if remedy.name == "tool":
        # the shank and the edge were those of the other cutter
        words |= {"shank": (), "flute_length": 0.0, "tool_number": 0, "tool_title": ""}
    return replace(inputs, **words)
