"""What is offered by a click where something was refused: another tool or height, a division, a rack, or no limits."""

from dataclasses import replace

import FreeCAD
from freecad.toolaxis.document.strategies import INDEXED
from freecad.toolaxis.gui.plan.outcome import left_to_clean_up
from freecad.toolaxis.gui.widgets.quantity import length_text
from PySide import QtCore

from toolaxis.job.inputs.tool_library import GENERAL_RACK
from toolaxis.plan.remedies import Remedy, remedies_advised, remedies_of

translate = FreeCAD.Qt.translate

#: Share of the area that several tools leave, from which on other tools are offered.
_LEFT = 1e-3


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
        self._offer(inputs, offers_for(plan, inputs))

    def show_advice(self, text, inputs):
        """Offer what a sentence advises that says why nothing was computed.

        Parameters
        ----------
        text : str
            English; empty for none.
        inputs : freecad.toolaxis.document.inputs.JobInputs
        """
        self._offer(inputs, advice_of(text, inputs) if text else [])

    def _offer(self, inputs, found):
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


def offers_for(plan, inputs):
    """What may help with a plan: what the library knows of its tool, then other ways to plan.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    inputs : freecad.toolaxis.document.inputs.JobInputs
        What it was made with.

    Returns
    -------
    list of toolaxis.plan.remedies.Remedy
        Also with the names "strategy", "rack" and "most_tools".
    """
    if inputs.rack:
        left = plan.account.area - plan.account.machined
        return _of_rack(inputs) if plan.outcome != "cancelled" and left > _LEFT * plan.account.area else []
    found = list(remedies_of(plan, inputs.divides))
    lost = any(not op.done for op in plan.operations)
    if inputs.moves:
        found = [one for one in found if one.name != "regions"]
        return found[:2] + ([Remedy("strategy", INDEXED, 0.0)] if lost else [])
    fits = all(one.name not in ("tool", "stickout") for one in found) and not left_to_clean_up(plan)
    if not (fits or inputs.divides or inputs.compare):
        found = [*found[:2], Remedy("rack", GENERAL_RACK, 0.0)]
    return found


def _of_rack(inputs):
    """What may help where several tools leave something."""
    found = [Remedy("most_tools", 0, 1.0)] if inputs.most_tools else []
    if GENERAL_RACK not in inputs.rack:
        found.append(Remedy("rack", GENERAL_RACK, 0.5))
    if inputs.limits:
        found.append(Remedy("limits", "", 0.1))
    return found


def advice_of(text, inputs):
    """What a sentence advises.

    Parameters
    ----------
    text : str
        English.
    inputs : freecad.toolaxis.document.inputs.JobInputs
        Of a rack only heights are changed: its tools are what they are.
    """
    from toolaxis.errors import ToolAxisError

    try:
        tool = max(inputs.tools(), key=lambda one: one.radius)
    except ToolAxisError:  # sizes that make no tool have no remedy that is known
        return []
    found = remedies_advised([text], tool, (inputs.scallop, inputs.tolerance), inputs.divides or inputs.moves)
    return [one for one in found if not inputs.rack or one.name in ("scallop", "tolerance")]


def words_of(remedy):
    """What a button says.

    Parameters
    ----------
    remedy : toolaxis.plan.remedies.Remedy
    """
    if remedy.name in ("stickout", "scallop", "tolerance"):
        forms = {"stickout": translate("ToolAxis", "Stick-out {}"),
                 "scallop": translate("ToolAxis", "Scallop height {}"),
                 "tolerance": translate("ToolAxis", "Tolerance {}")}
        return forms[remedy.name].format(length_text(remedy.value))
    if remedy.name == "tool":
        kind, _, sizes = remedy.value.partition(":")
        lengths = [length_text(float(size), 0) for size in sizes.split("x")]
        if kind == "ball":
            return translate("ToolAxis", "Ball end D{}").format(lengths[0])
        return translate("ToolAxis", "Bull nose D{}, R{}").format(*lengths)
    return {"regions": translate("ToolAxis", "Divide into sub-surfaces"),
            "strategy": translate("ToolAxis", "Use fixed axes"), "rack": translate("ToolAxis", "Use the general rack"),
            "most_tools": translate("ToolAxis", "Allow any number of tools"),
            "limits": translate("ToolAxis", "Remove axis limits")}[remedy.name]


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
    if remedy.name == "rack":
        words = {"rack": (*inputs.rack, remedy.value), "pieces": ()}
    if remedy.name == "most_tools":
        words = {"most_tools": None}
    return replace(inputs, **words)
