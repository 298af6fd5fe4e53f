"""What an orientation comes to, as rows of a table."""

import FreeCAD
import numpy as np
from freecad.toolaxis.gui.widgets.quantity import fine_text, length_text
from freecad.toolaxis.gui.widgets.table_entries import fit_rows, put
from freecad.toolaxis.services.messages import lines_of, shown
from freecad.toolaxis.services.time_left import clock
from PySide import QtWidgets

translate = FreeCAD.Qt.translate


def outcome_name(outcome):
    """The outcome of a search as the user reads it.

    Parameters
    ----------
    outcome : str
        One of `toolaxis.plan.orientation.OUTCOMES`.
    """
    return {"optimal": translate("ToolAxis", "optimal (proven)"), "feasible": translate("ToolAxis", "feasible"),
            "infeasible": translate("ToolAxis", "infeasible (proven)"),
            "not_found": translate("ToolAxis", "none found"),
            "cancelled": translate("ToolAxis", "cancelled")}.get(outcome, outcome)


def sentences(found):
    return lines_of(found.reasons)


def _room(found, name):
    if name not in found.clearance:
        return translate("ToolAxis", "not checked")
    value = found.clearance[name]
    return length_text(value) if np.isfinite(value) else translate("ToolAxis", "nothing near")


def _angle(y, x):
    return f"{np.degrees(np.arctan2(y, x)) + 0.0:.2f}°"


def measures(found, seconds=0.0):
    """Rows of the result table: (name, text) pairs.

    Parameters
    ----------
    found : toolaxis.plan.orientation.Orientation
    seconds : float
        Time of its passes and links, s; 0 where it is not known.
    """
    rows = [(translate("ToolAxis", "Outcome"), outcome_name(found.outcome))]
    there = found.axis is not None
    texts = [(translate("ToolAxis", "Passes"), lambda: str(found.passes)),
             (translate("ToolAxis", "Strip width"), lambda: length_text(found.average_strip_width)),
             (translate("ToolAxis", "Cutting length"), lambda: length_text(found.length)),
             *([(translate("ToolAxis", "Machining time"), lambda: clock(seconds))] if seconds > 0 else []),
             *([(translate("ToolAxis", "Excess over ideal length"),
                 lambda: f"{100 * (found.length / found.ideal_of_cut - 1):.1f} %")] if found.ideal > 0 else []),
             (translate("ToolAxis", "Max. gouge"), lambda: fine_text(found.gouge)),
             (translate("ToolAxis", "Cutter clearance"), lambda: _room(found, "cutter")),
             (translate("ToolAxis", "Shank clearance"), lambda: _room(found, "shank")),
             (translate("ToolAxis", "Holder clearance"), lambda: _room(found, "holder")),
             (translate("ToolAxis", "Rest material"), lambda: f"{100 * found.unreached:.1f} %"),
             *([] if found.lead is None else [(translate("ToolAxis", "Mean lean"),
                                               lambda: f"{np.degrees(found.lead) + 0.0:.2f}°")]),
             (translate("ToolAxis", "Tilt from Z"), lambda: _angle(np.hypot(*found.axis[:2]), found.axis[2])),
             (translate("ToolAxis", "Rotation about Z"), lambda: _angle(found.axis[1], found.axis[0]))]
    return rows + [(name, text() if there else "-") for name, text in texts]


def fill(table, columns):
    """Fill a result table.

    Parameters
    ----------
    table : QTableWidget
    columns : list of (str, list of (str, str))
        Heading and the rows of `measures`; one column alone without a heading has none.
    """
    table.horizontalHeader().setVisible(any(name for name, _ in columns))
    table.setEditTriggers(QtWidgets.QAbstractItemView.NoEditTriggers)
    table.setSelectionMode(QtWidgets.QAbstractItemView.NoSelection)
    table.setColumnCount(len(columns))
    table.setRowCount(len(columns[0][1]) if columns else 0)
    table.setHorizontalHeaderLabels([name for name, _ in columns])
    if columns:
        table.setVerticalHeaderLabels([name for name, _ in columns[0][1]])
    for k, (_, rows) in enumerate(columns):
        for i, (_, text) in enumerate(rows):
            put(table, i, k, text, text)
    table.verticalHeader().setVisible(True)
    table.horizontalHeader().setSectionResizeMode(QtWidgets.QHeaderView.Stretch)
    fit_rows(table)


def fill_baselines(table, rows):
    """Show what other methods come to; hidden where there are none.

    Parameters
    ----------
    table : QTableWidget
    rows : sequence of toolaxis.plan.baseline.Baseline
    """
    heads = [translate("ToolAxisPlan", "Method"), translate("ToolAxisPlan", "Orientations"),
             translate("ToolAxis", "Passes"), translate("ToolAxis", "Cutting length")]
    table.setVisible(bool(rows))
    table.setEditTriggers(QtWidgets.QAbstractItemView.NoEditTriggers)
    table.setSelectionMode(QtWidgets.QAbstractItemView.NoSelection)
    table.setColumnCount(len(heads))
    table.setHorizontalHeaderLabels(heads)
    table.verticalHeader().setVisible(False)
    table.setRowCount(len(rows))
    for i, row in enumerate(rows):
        name = shown(row.shown)
        cells = [name, str(row.orientations), str(row.passes), length_text(row.length)]
        if not row.complete:
            cells[3] = translate("ToolAxis", "{} of {} sub-surfaces").format(row.machined, row.sub_surfaces)
        for k, text in enumerate(cells):
            put(table, i, k, text, f"{name}: {shown(row.reason)}" if row.reason else text)
    table.horizontalHeader().setSectionResizeMode(QtWidgets.QHeaderView.ResizeToContents)
    table.horizontalHeader().setStretchLastSection(True)
    fit_rows(table)
