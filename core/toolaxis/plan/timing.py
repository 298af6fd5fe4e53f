"""Where the time of an operation goes on a machine whose limits are known."""

from dataclasses import dataclass, replace

#: How sentences begin on paths whose axis moves: where the tip crawls, and what no machine time could be found for.
CRAWLING, UNTIMED = "the feed falls below", "not timed:"
MOTION_WARNINGS = (CRAWLING, UNTIMED)
#: Decimals in which angles are compared, rad.
_DIGITS = 9


@dataclass(frozen=True)
class Order:
    """What the order of operations comes to.

    Attributes
    ----------
    seconds : float
        Time between operations: to retract, turn the rotary axes, go over and come down, s.
    listed : float
        The same in the order in which the operations were planned, at the rotary angles that are best for that;
        infinite where something is in the way on it.
    bound : float
        What no order takes less than; `seconds` where that is proven to be the least.
    """

    seconds: float
    listed: float
    bound: float


@dataclass(frozen=True)
class MachiningTime:
    """Time by kind of motion, s.

    Attributes
    ----------
    cut, entry, exit, link : float
    index : float
        To turn the rotary axes from where they stood before, retracts included where the part's place is known.
    rotary : tuple of float
        Angles at which the rotary axes stand, rad; empty where they do not matter.
    """

    cut: float = 0.0
    entry: float = 0.0
    exit: float = 0.0
    link: float = 0.0
    index: float = 0.0
    rotary: tuple[float, ...] = ()

    @property
    def path(self) -> float:
        """All but the index move, s."""
        return self.cut + self.entry + self.exit + self.link

    @property
    def total(self) -> float:
        """All of it, s."""
        return self.path + self.index

    def __add__(self, other: "MachiningTime") -> "MachiningTime":
        return MachiningTime(self.cut + other.cut, self.entry + other.entry, self.exit + other.exit,
                             self.link + other.link, self.index + other.index)

    def at(self, rotary: tuple[float, ...], index: float) -> "MachiningTime":
        """The same path at rotary angles that were reached by an index move.

        Parameters
        ----------
        rotary : tuple of float
            rad
        index : float
            s
        """
        return replace(self, rotary=tuple(round(angle, _DIGITS) + 0.0 for angle in rotary), index=index)
