"""A zone of a sub-surface that its operation leaves to a clean-up tool."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: What is said of a face that no tool may touch.
AVOIDED = "which is to be avoided"


@dataclass(frozen=True, eq=False)
class Zone:
    """A connected piece of a sub-surface that is left higher than the scallop limit.

    Attributes
    ----------
    loops : tuple of (m, 2) arrays
        Closed loops in (u, v) of the sub-surface, the outer one first.
    area : float
        mm^2
    at_wall : bool
        Whether it is left as rest material: the tool may not stand there, for a wall or an obstacle, or no pass of it
        comes into a corner beside such a place; else it is an undercut at the border, so small that it may stay.
    elsewhere : float
        Area of it that other operations of the plan machine, mm^2.
    unreachable : float
        Area of what is left then that is proven to be out of reach of every tool of the plan, mm^2.
    avoided : tuple of str
        Labels of the faces to be avoided to which the cutter would come too near somewhere on it; "held side" too.
    """

    loops: tuple[Array, ...]
    area: float
    at_wall: bool = True
    elsewhere: float = 0.0
    unreachable: float = 0.0
    avoided: tuple[str, ...] = ()
