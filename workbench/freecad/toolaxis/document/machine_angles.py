"""Machines for documents: which there are, where the document stands on one, and at which angles it holds an axis."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
from freecad.toolaxis.document.preferences import machines_folder

translate = FreeCAD.Qt.translate

#: A machine among the limits of the axis: "machine:bc-table-table@0,0,60".
PREFIX = "machine:"


def available():
    """The machines to pick from: those of the library, of the user's folder, and of FreeCAD.

    Returns
    -------
    dict of str to str
        What to load, a name of the library or a file, by what is shown.
    """
    from toolaxis.machine.library import library

    found = {name: name for name in library()}
    for folder in folders():
        for path in sorted(path for ending in ("*.toml", "*.fcm") for path in folder.glob(ending)):
            found.setdefault(path.stem if path.stem not in found else path.name, str(path))
    return found


def offered(document):
    """Machines as limits of the axis, (what is shown, text): that of the document with its place, then all others.

    Parameters
    ----------
    document : App.Document
    """
    from freecad.toolaxis.document.machine import machine_of

    found, standing = [], machine_of(document)
    if standing is not None:
        found.append((standing.Label, text_of(standing.Machine, tuple(standing.Offset))))
    return found + [(translate("ToolAxis", "machine {}").format(shown), text_of(name))
                    for shown, name in available().items()]


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


def limits_from(text, tool):
    """What the library takes as machine or limits of the axis; None for none.

    Parameters
    ----------
    text : str
        Short form, a machine's included.
    tool : toolaxis.tools.tool.Tool
    """
    return mounting(text, tool) if text.startswith(PREFIX) else text or None


@dataclass(frozen=True, eq=False)
class Held:
    """One way in which a machine holds the axis of an operation.

    Attributes
    ----------
    rotary : (m,) array
        Angles, rad, in the machine's steps.
    reason : str
        Why it is none, in words; empty where the machine can.
    meeting : tuple of str
        Names of bodies that meet.
    """

    rotary: object
    reason: str
    meeting: tuple = ()

    def text(self, machine):
        """The angles as the table shows them, degrees.

        Parameters
        ----------
        machine : toolaxis.machine.machine.Machine
        """
        import numpy as np

        return "  ".join(f"{axis.name} {round(float(np.degrees(angle)), 3) + 0.0:g}\u00b0"
                         for axis, angle in zip(machine.rotary, self.rotary, strict=True)) or "-"


def ways_to_hold(mounted, axis, tips):
    """All solutions of a machine for the axis of an operation, with what speaks against each.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
    axis : (3,) array
        In the document's space.
    tips : (n, 3) array
        mm

    Returns
    -------
    list of Held
        Two with two rotary axes; none where the machine cannot turn there at all.
    """
    import numpy as np

    from toolaxis.machine.kinematics import rotary_angles

    machine = mounted.machine
    found = rotary_angles(machine, np.asarray(axis)[None], table_from_part=mounted.table_from_part)
    if not found.reached[0]:
        return []
    made = []
    for row, within in zip(found.joints[0], found.within[0], strict=True):
        rotary = np.array([axis.rounded(angle) for axis, angle in zip(machine.rotary, row, strict=True)])
        made.append(Held(rotary, *_against(mounted, rotary, within, tips)))
    return made


def _against(mounted, rotary, within, tips):
    """What speaks against a solution, and the bodies that meet."""
    import numpy as np

    from toolaxis.machine.body_poses import meeting_at
    from toolaxis.machine.kinematics import linear_coordinates
    from toolaxis.machine.setup import in_tenths

    machine = mounted.machine
    if not within:
        beyond = [axis.name for axis, angle in zip(machine.rotary, rotary, strict=True)
                  if not axis.low - 1e-9 <= angle <= axis.high + 1e-9]
        return f"{' and '.join(beyond) or 'an axis'} beyond its range", ()
    if not mounted.judges_travel:
        return "", ()
    at = linear_coordinates(machine, tips, rotary, float(mounted.tool_length), mounted.table_from_part)
    out = [(float(axis.excess(at[:, k]).max()), axis.name) for k, axis in enumerate(machine.linear)]
    if max(out)[0] > 0:
        return f"{max(out)[1]} leaves its travel by {in_tenths(max(out)[0])} mm", ()
    if not mounted.judges_bodies:
        return "", ()
    ends = np.unique(np.concatenate([tips.argmin(axis=0), tips.argmax(axis=0)]))
    apart, names = meeting_at(machine, rotary[None], tips[ends], float(mounted.tool_length), mounted.table_from_part)
    meeting = [pair for pair, distance in zip(names, apart[0], strict=True) if distance < 0]
    if meeting:
        (one, other), depth = names[int(np.argmin(apart[0]))], -float(apart[0].min())
        return f"the {one} meets the {other} by {in_tenths(depth)} mm", tuple(sorted({*sum(meeting, ())}))
    return "", ()


def in_order(mounted, operations):
    """For each operation the solutions, and the one that is taken: the nearest to the one before that can be held.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
    operations : sequence of (axis, tips) or (axis, tips, tool length)
        The length, mm, where it is not that of the mounting; None where it is not known.

    Returns
    -------
    list of (list of Held, int)
        The number is -1 where none can be held.
    """
    from dataclasses import replace

    import numpy as np

    stand, found = np.zeros(len(mounted.machine.rotary)), []
    for axis, tips, *length in operations:
        ways = ways_to_hold(replace(mounted, tool_length=length[0]) if length else mounted, axis, tips)
        good = [k for k, way in enumerate(ways) if not way.reason]
        taken = min(good, key=lambda k: float(np.abs(ways[k].rotary - stand).max(initial=0.0)), default=-1)
        stand = ways[taken].rotary if taken >= 0 else stand
        found.append((ways, taken))
    return found


def texts_of(machine, ways, taken):
    """The angles of an operation as its property holds them, the solution that is taken first.

    Parameters
    ----------
    machine : toolaxis.machine.machine.Machine
    ways : sequence of Held
    taken : int
    """
    order = sorted(range(len(ways)), key=lambda k: k != taken)
    return [ways[k].text(machine) + (f" ({ways[k].reason})" if ways[k].reason else "") for k in order]


def ranges_along(mounted, path):
    """How far the rotary axes turn along a path whose axis moves, as the property of an operation holds it.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
    path : toolaxis.cldata.toolpath.ToolPath

    Returns
    -------
    list of str
        "B: -12.5\u00b0 \u2026 30\u00b0" for each axis; the reason alone where the machine cannot follow.
    """
    import numpy as np

    from toolaxis.errors import InvalidInput
    from toolaxis.feed.continuous_ik import following

    try:
        found = following(mounted.machine, path, mounted.table_from_part, float(mounted.tool_length or 0.0))
    except InvalidInput as reason:
        return [str(reason)]
    ends = np.round(np.degrees([found.rotary.min(axis=0), found.rotary.max(axis=0)]), 3) + 0.0
    return [f"{axis.name}: {low:g}\u00b0 \u2026 {high:g}\u00b0" for axis, low, high in zip(
        mounted.machine.rotary, *ends, strict=True)]
