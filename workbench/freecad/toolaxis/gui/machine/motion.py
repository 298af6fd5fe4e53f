"""How a machine goes from operation to operation, as joint coordinates: up, change the tool, turn, over, down."""

from dataclasses import dataclass

import numpy as np

#: Shares of a way between two operations at which it is up, turned and over.
_UP, _TURNED, _OVER = 0.2, 0.6, 0.8
#: Height above both ends where Z has no upper end, mm.
_ABOVE = 100.0


@dataclass(frozen=True, eq=False)
class MachineTour:
    """Stations of a machine and the index moves between them.

    Attributes
    ----------
    machine : toolaxis.machine.machine.Machine
    joints : (n, 3 + m) array
        Linear coordinates, mm, and rotary angles, rad, at each station.
    """

    machine: object
    joints: np.ndarray

    @classmethod
    def through(cls, mounted, stations, lengths=None):
        """A journey through stations.

        Parameters
        ----------
        mounted : toolaxis.machine.setup.Mounting
        stations : sequence of ((3,) array, (m,) array)
            Tips in the document's space, mm, and rotary angles, rad.
        lengths : sequence of float or None, optional
            Of the tool at each station, mm; that of the mounting unless given.
        """
        from toolaxis.machine.kinematics import linear_coordinates

        lengths = [mounted.tool_length] * len(stations) if lengths is None else lengths
        rows = [np.concatenate([linear_coordinates(mounted.machine, tip[None], rotary, float(length or 0),
                                                   mounted.table_from_part)[0], rotary])
                for (tip, rotary), length in zip(stations, lengths, strict=True)]
        return cls(mounted.machine, np.array(rows))

    @property
    def top(self):
        """Where Z is up, mm."""
        high = self.machine.linear[2].high
        return float(high) if np.isfinite(high) else float(self.joints[:, 2].max()) + _ABOVE

    def station(self, way):
        """The station whose tool is in the spindle: from up there on the next one's.

        Parameters
        ----------
        way : float
            As for `at`.
        """
        way = min(max(float(way), 0.0), len(self.joints) - 1.0)
        return int(way) + int(way - int(way) > _UP + 1e-9)

    def at(self, way):
        """Joint coordinates on the way, (3 + m,).

        Parameters
        ----------
        way : float
            A whole number is a station, counted from 0; between two of them lies the index move.
        """
        way = min(max(float(way), 0.0), len(self.joints) - 1.0)
        k = min(int(way), max(len(self.joints) - 2, 0))
        share = way - k
        here, there = self.joints[k].copy(), self.joints[min(k + 1, len(self.joints) - 1)]
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
