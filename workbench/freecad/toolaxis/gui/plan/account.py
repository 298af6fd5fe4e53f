"""The account of a part that was planned with several tools, as a headline and as a table of the tools."""

from dataclasses import dataclass

import FreeCAD
from freecad.toolaxis.document.tool_colours import tool_colour
from freecad.toolaxis.gui.widgets.quantity import area_text, length_text, number_text
from freecad.toolaxis.gui.widgets.table_entries import fit_rows, put
from freecad.toolaxis.services.time_left import clock
from PySide import QtGui, QtWidgets

translate = FreeCAD.Qt.translate

#: Share below which a number is told as less than that, and area that counts as none, mm^2.
_LEAST, _NONE = 0.01, 5e-3


def percent(part, whole):
    """A share in percent: never 100 where something is missing, and never 0 where there is something.

    Parameters
    ----------
    part, whole : float
    """
    share = 100 * part / whole if whole > 0 else 0.0
    if part > _NONE and share < _LEAST:
        return f"< {number_text(_LEAST, 2, 2)} %"
    if whole - part > _NONE and share > 100 - _LEAST:
        return f"> {number_text(100 - _LEAST, 2, 2)} %"
    near = 0 < share < 0.1 or 99.9 < share < 100
    digits = 2 if near else 1
    return f"{number_text(share, digits, digits)} %"


def headline(account):
    """How much of the faces is machined, and in what time, as sentences.

    Parameters
    ----------
    account : freecad.toolaxis.document.plan_account.PlanAccount
    """
    rows = [(account.unreachable, translate("ToolAxis", "{} proven out of reach")),
            (account.open, translate("ToolAxis", "{} open")),
            (account.not_begun, translate("ToolAxis", "{} not begun"))]
    rest = [form.format(percent(area, account.area)) for area, form in rows if area > _NONE]
    told = translate("ToolAxis", "{} of {} machined").format(percent(account.machined, account.area),
                                                             area_text(account.area))
    text = " ".join([", ".join([told, *rest]) + ".", *texts_of_areas_aside(account.clamped, account.machined_before)])
    if not account.tools:
        return text
    used = translate("ToolAxis", "{} with {} of {} tools").format(clock(account.seconds), len(account.tools),
                                                                  account.offered)
    return f"{text} {', '.join([used, *count_texts(account.passes, account.step_over, account.axes)])}."


def texts_of_areas_aside(clamped, machined_before):
    """What of the faces is not asked for, a sentence for each reason.

    Parameters
    ----------
    clamped, machined_before : float
        mm^2 that lie in the clamped side, and that earlier setups machine.
    """
    rows = [(clamped, translate("ToolAxis", "Clamped in this setup: {}.")),
            (machined_before, translate("ToolAxis", "Machined in earlier setups: {}."))]
    return [form.format(area_text(area)) for area, form in rows if area > _NONE]


def count_texts(passes, step_over, axes):
    """Passes, mean step-over and different axes of a plan in words; what is not known is left out.

    Parameters
    ----------
    passes : int
    step_over : float
        mm
    axes : int
    """
    found = [translate("ToolAxis", "passes: {}").format(passes),
             translate("ToolAxis", "mean step-over {}").format(length_text(step_over))] if passes else []
    return [*found, translate("ToolAxis", "orientations: {}").format(axes)] if axes else found


def fill_tools(table, account):
    """Show what each tool machines and its time; hidden without an account.

    Parameters
    ----------
    table : QTableWidget
    account : freecad.toolaxis.document.plan_account.PlanAccount or None
    """
    table.setVisible(account is not None and bool(account.tools))
    if account is None:
        table.setRowCount(0)
        return
    heads = [translate("ToolAxis", "Tool"), translate("ToolAxis", "Area"), translate("ToolAxis", "Time")]
    rows = [(f"T{one.number} {one.name}", percent(one.area, account.area), clock(one.seconds))
            for one in account.tools]
    rows.append((translate("ToolAxis", "tool changes and index moves"), "", clock(account.between)))
    rows.append((translate("ToolAxis", "total"), percent(account.machined, account.area), clock(account.seconds)))
    told = [translate("ToolAxis", "{}: {} operations").format(rows[i][0], one.operations)
            for i, one in enumerate(account.tools)]
    _fill(table, heads, rows, [tool_colour(one.place) for one in account.tools], told)


@dataclass
class ReachedByTool:
    """What a tool reaches of the faces, and machines of them, as far as it is known while a plan is made.

    Attributes
    ----------
    colour : (r, g, b)
        From 0 to 1.
    number : int
        Place in the magazine.
    name : str
    reached : float
        Area on which it is the largest tool that reaches the faces, mm^2.
    machined : float
        mm^2
    """

    colour: tuple
    number: int
    name: str
    reached: float
    machined: float


def fill_reached(table, tools, area):
    """Show what tools reach and machine while a plan is made.

    Parameters
    ----------
    table : QTableWidget
    tools : sequence of ReachedByTool
    area : float
        Of the faces that were screened so far, mm^2.
    """
    table.setVisible(bool(tools))
    heads = [translate("ToolAxis", "Tool"), translate("ToolAxis", "Largest for"), translate("ToolAxis", "Machined")]
    rows = [(f"T{one.number} {one.name}", percent(one.reached, area),
             percent(one.machined, area) if one.machined else "") for one in tools]
    form = translate("ToolAxis", "{}: the largest tool that was found to reach, on {} of the area so far")
    told = [form.format(*row[:2]) for row in rows]
    _fill(table, heads, rows, [one.colour for one in tools], told)


def _fill(table, heads, rows, colours, told):
    """Fill a table whose first rows are tools: their colours, and what is told where the pointer is on them."""
    table.setEditTriggers(QtWidgets.QAbstractItemView.NoEditTriggers)
    table.setSelectionMode(QtWidgets.QAbstractItemView.NoSelection)
    table.setColumnCount(len(heads))
    table.setHorizontalHeaderLabels(heads)
    table.verticalHeader().setVisible(False)
    table.setRowCount(0)  # colours of rows that were there before
    table.setRowCount(len(rows))
    for i, cells in enumerate(rows):
        for k, text in enumerate(cells):
            put(table, i, k, text, text)
    for i, (colour, text) in enumerate(zip(colours, told, strict=True)):
        put(table, i, 0, rows[i][0], text, DecorationRole=QtGui.QColor.fromRgbF(*colour))
    head = table.horizontalHeader()
    for k in range(1, len(heads)):
        head.setSectionResizeMode(k, QtWidgets.QHeaderView.ResizeToContents)
    head.setSectionResizeMode(0, QtWidgets.QHeaderView.Stretch)
    fit_rows(table)
