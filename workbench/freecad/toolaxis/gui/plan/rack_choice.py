"""The choice between one tool and a rack, and the list of the rack's tools."""

from pathlib import Path

import FreeCAD
from freecad.toolaxis.document.cam_probe import tool_libraries
from freecad.toolaxis.gui.widgets.table_entries import append
from freecad.toolaxis.services.background import sentence
from freecad.toolaxis.services.messages import lines_of
from PySide import QtWidgets

from toolaxis.job.inputs.tool_library import GENERAL_RACK, load_library, racks

translate = FreeCAD.Qt.translate

#: Sources that stand for a dialog.
_FILE, _FOLDER = "file", "folder"
_FILES = "*.toml *.fctl *.csv *.json *.tools *.fctb"


class RackChoice:
    """One tool, a rack that is known, or a library file or folder that the user names.

    Parameters
    ----------
    form : QWidget
        Of plan.ui.
    """

    def __init__(self, form):
        self.form, self.combo, self.number = form, form.rack, form.mostTools
        self._slots, self._sources = [], []
        self._shown, self._before = None, 0
        self._add(translate("ToolAxis", "one tool (tab Tool)"), ())
        self._add(translate("ToolAxis", "general rack"), (GENERAL_RACK,))
        for name in racks():
            if name != GENERAL_RACK:
                self._add(name, (name,))
        for name, file in tool_libraries():
            self._add(translate("ToolAxis", "FreeCAD's library {}").format(name), (file,))
        self._add(translate("ToolAxis", "library file..."), _FILE)
        self._add(translate("ToolAxis", "folder of tools..."), _FOLDER)
        self.combo.currentIndexChanged.connect(self._changed)
        self.number.valueChanged.connect(self._tell)
        self._show()

    def _add(self, title, source, place=None):
        place = len(self._sources) if place is None else place
        self._sources.insert(place, source)
        self.combo.insertItem(place, title)

    def on_change(self, slot):
        """Call a slot without arguments whenever another rack is chosen, or another number of tools.

        Parameters
        ----------
        slot : callable
        """
        self._slots.append(slot)

    @property
    def chosen(self):
        """Sources of the tools, a tuple of str; empty for one tool."""
        source = self._sources[max(self.combo.currentIndex(), 0)]
        return source if isinstance(source, tuple) else ()

    @property
    def most(self):
        """Greatest number of tools; None for any number, and for one tool."""
        return (self.number.value() or None) if self.chosen else None

    def choose(self, rack, most):
        """Show a rack, known or not.

        Parameters
        ----------
        rack : tuple of str
        most : int or None
        """
        self.number.setValue(most or 0)
        if rack not in self._sources:
            self._add(", ".join(Path(one).name for one in rack), rack, self._sources.index(_FILE))
        self.combo.setCurrentIndex(self._sources.index(rack))

    def _changed(self, index):
        source = self._sources[max(index, 0)]
        if source in (_FILE, _FOLDER):
            self._ask(source)
            return
        self._before = index
        self._show()
        self._tell()

    def _ask(self, kind):
        """Let the user name a library; the choice is as it was where none is named."""
        title = translate("ToolAxis", "Tools")
        if kind == _FILE:
            files = translate("ToolAxis", "Tool libraries ({})").format(_FILES)
            name, _ = QtWidgets.QFileDialog.getOpenFileName(self.form, title, "", files)
        else:
            name = QtWidgets.QFileDialog.getExistingDirectory(self.form, title)
        if name:
            self.choose((name,), self.number.value())
        else:
            self.combo.setCurrentIndex(self._before)

    def _tell(self, *_):
        for slot in self._slots:
            slot()

    def _show(self):
        """Show the tools of the rack that is chosen, and what is to be said of them."""
        form, rack = self.form, self.chosen
        for widget in (form.rackGroup, form.mostTools, form.mostToolsLabel):
            widget.setVisible(bool(rack))
        if not rack or rack == self._shown:
            return
        self._shown = rack
        form.rackTools.clear()
        try:
            found = load_library(rack)
        except Exception as reason:  # what is wrong with it stands above too
            form.rackNote.setText(sentence(reason))
            return
        for tool in found.tools:
            append(form.rackTools, f"T{tool.number} {tool.shop_name}" if tool.number else tool.shop_name)
        form.rackNote.setText(lines_of(found.warnings))
