"""What operations were written as last: the folder and the program, kept with them, to be offered again."""

import json
from pathlib import Path

import FreeCAD
from freecad.toolaxis.document.machine import machine_of
from freecad.toolaxis.document.properties import Property, assign, ensure
from freecad.toolaxis.document.transaction import one_step

translate = FreeCAD.Qt.translate

_EXPORTED = (Property("String", "Exported", "Tool Axis", "Folder and program that were written last, JSON", True,
                      True),)


def keep_export(operations, folder, wish):
    """Keep what was written, as one undo step; none where it is the same as last time.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
        None where they were deleted meanwhile.
    folder : Path
    wish : freecad.toolaxis.services.export.Wish
    """
    if not operations:
        return
    document = operations[0].Document
    text = json.dumps({"folder": str(folder), "file": document.FileName, "dialect": wish.dialect,
                       "machine": wish.machine, "offset": wish.offset, "report": wish.report,
                       "standing": _standing_in(document)})
    if all(getattr(operation, "Exported", "") == text for operation in operations):
        return
    with one_step(document, translate("ToolAxis", "Export")):
        for operation in operations:
            touched = "Touched" in operation.State
            ensure(operation, _EXPORTED)
            assign(operation, Exported=text)
            if not touched:  # nothing that it was planned with
                operation.purgeTouched()


def kept_export(operations):
    """What operations were written as last, as far as it still holds.

    Parameters
    ----------
    operations : sequence of App.DocumentObject

    Returns
    -------
    dict
        dialect and report; folder, unless this is a copy of the document or the folder's place is gone; machine and
        offset, unless there was no program or the document's own machine was changed since.  Empty where nothing was
        written.
    """
    text = next(filter(None, (getattr(operation, "Exported", "") for operation in operations)), "")
    if not text:
        return {}
    kept, document = json.loads(text), operations[0].Document
    if kept.pop("file") not in ("", document.FileName) or not Path(kept["folder"]).parent.is_dir():
        del kept["folder"]
    if kept.pop("standing") != _standing_in(document) or not kept["machine"]:
        del kept["machine"], kept["offset"]
    return kept


def _standing_in(document):
    """The machine of a document and its place, as JSON has them."""
    thing = machine_of(document)
    return None if thing is None else [thing.Machine, *thing.Offset]
