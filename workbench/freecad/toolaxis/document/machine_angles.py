"""At which rotary angles a machine holds the axis of an operation, and what speaks against each."""

from dataclasses import dataclass, replace


@dataclass(frozen=True, eq=False)
class AxisSolution:
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
    list of AxisSolution
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
        made.append(AxisSolution(rotary, *_against(mounted, rotary, within, tips)))
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
        return f"the {one} collides with the {other} by {in_tenths(depth)} mm", tuple(sorted({*sum(meeting, ())}))
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
    ways : sequence of AxisSolution
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
