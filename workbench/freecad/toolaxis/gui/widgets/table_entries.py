"""Entries of tables and lists, by the models of the widgets."""

from PySide import QtCore


def put(view, row, column, text, tip=None, **roles):
    """Write an entry of a table or a list.

    Entries are made, written and read by the widget's model, never as Python's objects of its items: these may end
    before the items do, or stay when the items are gone, and either takes FreeCAD down or is handed out for a widget.

    Parameters
    ----------
    view : QTableWidget or QListWidget
    row, column : int
        There is such a row.
    text : str
    tip : str, optional
    **roles
        Further data by the names of their roles, FontRole=font.
    """
    model, place = view.model(), view.model().index(row, column)
    model.setData(place, text, QtCore.Qt.EditRole)
    if tip is not None:
        model.setData(place, tip, QtCore.Qt.ToolTipRole)
    for role, value in roles.items():
        model.setData(place, value, getattr(QtCore.Qt, role))


def data_of(view, row, column=0, role=QtCore.Qt.DisplayRole):
    """What an entry of a table or a list holds; None where there is none.

    Parameters
    ----------
    view : QTableWidget or QListWidget
    row, column : int
    role : Qt.ItemDataRole
    """
    return view.model().index(row, column).data(role)


def append(view, text, **roles):
    """Add an entry to a list.

    Parameters
    ----------
    view : QListWidget
    text : str
    **roles
        As for `put`.
    """
    view.addItem(text)
    put(view, view.count() - 1, 0, text, **roles)


def fit_rows(table):
    """Make a table as high as its rows, and the rows as high as their text.

    Parameters
    ----------
    table : QTableWidget
    """
    row = table.fontMetrics().height() + 8
    table.verticalHeader().setMinimumSectionSize(row)
    table.verticalHeader().setDefaultSectionSize(row)
    head = table.horizontalHeader()
    height = row * table.rowCount() + 4 + (0 if head.isHidden() else head.sizeHint().height())
    table.setMinimumHeight(height)
    table.setMaximumHeight(height)
