"""The tools that the panel offers in place of typing one: of CAM jobs, of the document, of the library."""

import FreeCAD
from freecad.toolaxis.document.cam_probe import speeds
from freecad.toolaxis.gui.plan.selection import tools_in
from freecad.toolaxis.services.background import sentence
from freecad.toolaxis.services.tools import cutter_of

translate = FreeCAD.Qt.translate

_TYPED = 0


class ToolOffer:
    """Fills the fields of the tool with the one that is chosen.

    Parameters
    ----------
    document : App.Document
    form : QWidget
        Of plan.ui.
    fields : freecad.toolaxis.gui.plan.form.PlanForm
    """

    def __init__(self, document, form, fields):
        self.combo, self.fields = form.tool, fields
        self._tools = tools_in(document)
        self.combo.addItem(translate("ToolAxis", "typed in below"))
        self.combo.addItems([name for name, _ in self._tools])

    def take(self, index):
        """Show the tool at a place of the list; why that cannot be, or empty.

        Parameters
        ----------
        index : int
        """
        if index == _TYPED:
            return ""
        try:
            found = self._tools[index - 1][1]
            self.fields.take_tool(cutter_of(found), (None, None) if isinstance(found, str) else speeds(found))
        except Exception as reason:  # a tool of a shape that there is no cutter for: said, nothing changed
            self.combo.setCurrentIndex(_TYPED)
            return sentence(reason)
        return ""

    def forget(self, name):
        """Take a tool of the document that is about to be deleted off the list.

        Parameters
        ----------
        name : str
        """
        for k, (_, thing) in reversed(list(enumerate(self._tools))):
            if getattr(thing, "Name", None) == name:  # a name of the library of tools has none
                del self._tools[k]
                self.combo.removeItem(k + 1)
