"""A machine among the limits of the axis, as a text: which there are, and where the document stands on its table."""

from contextlib import suppress
from pathlib import Path

from freecad.toolaxis.document.machine import machine_of
from freecad.toolaxis.document.preferences import machines_folder

#: How such a text begins: "machine:bc-table-table@0,0,60".
PREFIX = "machine:"


def available():
    """The machines to pick from: those of the library, of the user's folder, and of FreeCAD.

    Returns
    -------
    dict of str to str
        What to load, a name of the library or a file, by what is shown.
    """
    from toolaxis.machine.library import library

    found = {name: name for name in sorted(library(), key=lambda name: (not _has_bodies(name), name))}
    for folder in folders():
        for path in sorted(path for ending in ("*.toml", "*.fcm") for path in folder.glob(ending)):
            found.setdefault(path.stem if path.stem not in found else path.name, str(path))
    return found


def _has_bodies(name):
    """Whether a machine of the library has bodies: one without cannot be seen, and nothing meets it."""
    from toolaxis.errors import InvalidInput
    from toolaxis.machine.library import load_machine

    with suppress(InvalidInput):  # that is said when it is chosen
        return bool(load_machine(name).bodies)
    return False


def offered(document):
    """Machines as limits of the axis, (what is shown, text): that of the document with its place, then all others.

    Parameters
    ----------
    document : App.Document
    """
    found, standing = [], machine_of(document)
    if standing is not None:
        found.append((standing.Label, text_of(standing.Machine, tuple(standing.Offset))))
    return found + [(shown, text_of(name)) for shown, name in available().items()]


def folders():
    """The user's own folders of machines that exist: that of the preferences, and FreeCAD's."""
    named = machines_folder()
    found = []
    with suppress(RuntimeError):  # the home of somebody who has none
        found += [Path(named).expanduser()] if named else []
    with suppress(Exception):  # a FreeCAD that keeps no machines
        import Path.Preferences as CamPreferences

        found.append(Path(str(CamPreferences.getAssetPath())) / "Machine")
    return [folder for folder in found if folder.is_dir()]


def text_of(machine, offset=None):
    """A machine with the place of the document on its table, as it stands among the limits of the axis.

    Parameters
    ----------
    machine : str
        Name or file.
    offset : (3,) sequence of float, optional
        Where the document's origin stands on the table, mm; None where that is not known.
    """
    return PREFIX + machine + ("" if offset is None else "@" + ",".join(f"{value:.12g}" for value in offset))


def read_text(text):
    """The machine and the place of a text, (str, (3,) array or None).

    Parameters
    ----------
    text : str

    Raises
    ------
    InvalidInput
        When it names none, or the place is none.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.job.inputs.spec import offset_from

    name, _, place = text.removeprefix(PREFIX).rpartition("@") if "@" in text else (text.removeprefix(PREFIX), "", "")
    if not text.startswith(PREFIX) or not name:
        raise InvalidInput(f"limits {text!r} name no machine: write machine:bc-table-table@0,0,60")
    return name, offset_from(place) if place else None


def mounting(text, tool):
    """The machine of a text with the document on its table and a tool in its spindle.

    Parameters
    ----------
    text : str
    tool : toolaxis.tools.tool.Tool

    Raises
    ------
    InvalidInput
        When there is no such machine, or its file does not describe one.
    """
    from toolaxis.cad.machines import load_machine
    from toolaxis.machine.setup import Mounting

    name, offset = read_text(text)
    return Mounting(load_machine(name), offset, tool.gauge_length)


def mounting_in(document, tool):
    """The machine of a document with the document on its table and a tool in its spindle; None without one.

    Parameters
    ----------
    document : App.Document
    tool : toolaxis.tools.tool.Tool

    Raises
    ------
    InvalidInput
        When its file does not describe one any more.
    """
    standing = machine_of(document)
    return None if standing is None else mounting(text_of(standing.Machine, tuple(standing.Offset)), tool)


def limits_from(text, tool):
    """What the library takes as machine or limits of the axis; None for none.

    Parameters
    ----------
    text : str
        Short form, a machine's included.
    tool : toolaxis.tools.tool.Tool
    """
    return mounting(text, tool) if text.startswith(PREFIX) else text or None
