"""How tool and machine go along operations and from one to the next: up, change the tool, turn, over, down."""

from dataclasses import dataclass

import numpy as np

#: Shares of a way between two operations at which it is up, turned and over.
_UP, _TURNED, _OVER = 0.2, 0.6, 0.8
#: Height above both ends where Z has no upper end, and of a tool without a machine above all passes, mm.
_ABOVE, _CLEAR = 100.0, 30.0


@dataclass(frozen=True, eq=False)
class MachineTour:
    """A machine on its way along the passes of operations, and the index moves between them.

    Attributes
    ----------
    machine : toolaxis.machine.machine.Machine
    legs : tuple of (n, 3 + m) array
        Linear coordinates, mm, and rotary angles, rad, at each point of each operation.
    """

    machine: object
    legs: tuple

    @classmethod
    def through(cls, mounted, stations, lengths=None):
        """A journey through operations.

        Parameters
        ----------
        mounted : toolaxis.machine.setup.Mounting
        stations : sequence of ((n, 3) or (3,) array, (n, m) or (m,) array)
            Tips in the document's space, mm, and rotary angles, rad; one tip alone is a station without passes.
        lengths : sequence of float or None, optional
            Of the tool at each station, mm; that of the mounting unless given.
        """
        from toolaxis.machine.kinematics import linear_coordinates

        lengths = [mounted.tool_length] * len(stations) if lengths is None else lengths
        legs = []
        for (tips, rotary), length in zip(stations, lengths, strict=True):
            tips = np.atleast_2d(tips)
            angles = np.broadcast_to(rotary, (len(tips), np.shape(rotary)[-1]))
            at = linear_coordinates(mounted.machine, tips, angles, float(length or 0), mounted.table_from_part)
            legs.append(np.concatenate([at, angles], axis=1))
        return cls(mounted.machine, tuple(legs))

    @property
    def joints(self):
        """Joint coordinates at the beginning of each operation, (k, 3 + m)."""
        return np.array([leg[0] for leg in self.legs])

    @property
    def top(self):
        """Where Z is up, mm."""
        high = self.machine.linear[2].high
        return float(high) if np.isfinite(high) else max(float(leg[:, 2].max()) for leg in self.legs) + _ABOVE

    def station(self, way):
        """The station whose tool is in the spindle: from up there on the next one's.

        Parameters
        ----------
        way : float
            As for `at`.
        """
        way = min(max(float(way), 0.0), len(self.legs) - 1.0)
        return int(way) + int(way - int(way) > _UP + 1e-9)

    def along(self, station, motion, share):
        """Joint coordinates on the passes of an operation, (3 + m,).

        Parameters
        ----------
        station, motion : int
            Motion k ends at point k.
        share : float
            Of the motion, 0 to 1.
        """
        leg = self.legs[station]
        k = min(max(motion, 0), len(leg) - 1)
        before = leg[max(k - 1, 0)]
        return before + share * (leg[k] - before)

    def at(self, way):
        """Joint coordinates on the way between operations, (3 + m,).

        Parameters
        ----------
        way : float
            A whole number is the end of a station, counted from 0, the last one its beginning; between two of them
            lies the index move.
        """
        way = min(max(float(way), 0.0), len(self.legs) - 1.0)
        k = min(int(way), max(len(self.legs) - 2, 0))
        share = way - k
        here, there = self.legs[k][-1].copy(), self.legs[min(k + 1, len(self.legs) - 1)][0]
        if share <= 0:
            return here
        if share >= 1:
            return there.copy()
        top = max(self.top, here[2], there[2])
        turned = np.clip((share - _UP) / (_TURNED - _UP), 0, 1)
        over = np.clip((share - _TURNED) / (_OVER - _TURNED), 0, 1)
        found = here + np.concatenate([[over, over, 0.0], np.full(len(here) - 3, turned)]) * (there - here)
        up = np.clip(share / _UP, 0, 1)
        down = np.clip((share - _OVER) / (1 - _OVER), 0, 1)
        found[2] = here[2] + up * (top - here[2]) if share <= _UP else top + down * (there[2] - top)
        return found


@dataclass(frozen=True, eq=False)
class ToolTour:
    """The tool alone on its way along the passes of operations; between them up, over and down, with no machine.

    Attributes
    ----------
    tips, axes : tuple of (n, 3) array
        In the document's space, mm; unit vectors from tip to spindle.
    """

    tips: tuple
    axes: tuple

    @classmethod
    def through(cls, paths):
        """A journey through paths.

        Parameters
        ----------
        paths : sequence of toolaxis.cldata.toolpath.ToolPath
        """
        return cls(tuple(path.cl for path in paths), tuple(path.axis for path in paths))

    def along(self, station, motion, share):
        """Tip and axis on the passes of an operation, each (3,); parameters as for `MachineTour.along`."""
        k = min(max(motion, 0), len(self.tips[station]) - 1)
        rows = [(every[station][max(k - 1, 0)], every[station][k]) for every in (self.tips, self.axes)]
        tip, axis = (before + share * (after - before) for before, after in rows)
        return tip, axis / np.linalg.norm(axis)

    def between(self, station, share):
        """Tip and axis on the way from one operation to the next, each (3,).

        Parameters
        ----------
        station : int
            The operation that it comes from.
        share : float
            0 to 1.
        """
        here, there = ((self.tips[k][row], self.axes[k][row]) for k, row in ((station, -1), (station + 1, 0)))
        every = np.concatenate(self.tips)
        lifts = [max(float((every @ axis).max() - tip @ axis), 0.0) + _CLEAR for tip, axis in (here, there)]
        raised = [tip + lift * axis for (tip, axis), lift in zip((here, there), lifts, strict=True)]
        up, down = np.clip(share / _UP, 0, 1), np.clip((share - _OVER) / (1 - _OVER), 0, 1)
        over = np.clip((share - _UP) / (_OVER - _UP), 0, 1)
        if share <= _UP:
            return here[0] + up * (raised[0] - here[0]), here[1]
        if share >= _OVER:
            return raised[1] + down * (there[0] - raised[1]), there[1]
        return raised[0] + over * (raised[1] - raised[0]), _turn_between(here[1], there[1], over)


def _turn_between(one, other, share):
    """A direction on the shortest turn from one to another, (3,)."""
    angle = float(np.arccos(np.clip(one @ other, -1.0, 1.0)))
    if angle < 1e-9:
        return one
    if angle > np.pi - 1e-6:
        from toolaxis.numeric.vectors import perpendicular

        side = perpendicular(one)[0]
        return np.cos(share * angle) * one + np.sin(share * angle) * side
    return (np.sin((1 - share) * angle) * one + np.sin(share * angle) * other) / np.sin(angle)


def corners(body, around=24):
    """Points whose hull is a body, or nearly so where it is round, machine coordinates, (n, 3) mm.

    Parameters
    ----------
    body : toolaxis.machine.bodies.MachineBody
    around : int
        Points around a circle.
    """
    if body.kind == "box":
        low, high = body.points.min(axis=0), body.points.max(axis=0)
        return np.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]]
                         for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    if body.kind == "cylinder":
        from toolaxis.numeric.vectors import perpendicular, unit

        way = unit(body.points[1] - body.points[0])
        x = perpendicular(way)[0]
        turn = np.linspace(0, 2 * np.pi, 2 * around, endpoint=False)[:, None]
        ring = body.radius * (np.cos(turn) * x + np.sin(turn) * np.cross(way, x))
        return np.concatenate([end + ring for end in body.points])
    if not body.radius:
        return body.points
    k = np.arange(around**2) + 0.5
    z, turn = 1 - 2 * k / around**2, np.pi * (1 + 5**0.5) * k
    ball = np.stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z], axis=1)
    return body.convex.support(ball)


def places(mounted, joints):
    """Where all bodies of a machine stand, rigid motions from machine coordinates into the document's space.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
    joints : (3 + m,) array

    Returns
    -------
    dict of str to (4, 4) array
        By what carries them; "bed" always among them.
    """
    from toolaxis.machine.body_poses import axes_carrying, bed_from_body, part_from_bed

    machine, rotary = mounted.machine, joints[3:]
    part_from = part_from_bed(machine, rotary, mounted.table_from_part)
    found = {"bed": part_from}
    for name in {body.carried for body in machine.bodies} - {"bed"}:
        matrix = bed_from_body(machine, name, rotary)
        matrix[:3, 3] += machine.directions @ axes_carrying(machine, name) @ joints[:3]
        found[name] = part_from @ matrix
    return found


def meeting(mounted, joints):
    """Names of bodies on both sides of a machine that meet, and by how much at most, mm.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
    joints : (3 + m,) array

    Returns
    -------
    set of str, float
    """
    from toolaxis.machine.body_poses import meeting_at
    from toolaxis.machine.kinematics import forward

    if not mounted.judges_bodies:
        return set(), 0.0
    length = float(mounted.tool_length)
    tip, _ = forward(mounted.machine, joints[None], length, mounted.table_from_part)
    apart, names = meeting_at(mounted.machine, joints[None, 3:], tip, length, mounted.table_from_part)
    bad = [(pair, -float(distance)) for pair, distance in zip(names, apart[0], strict=True) if distance < 0]
    return {name for pair, _ in bad for name in pair}, max((depth for _, depth in bad), default=0.0)
