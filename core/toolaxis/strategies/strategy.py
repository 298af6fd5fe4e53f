"""What every strategy offers: its names, what it needs, the check of its inputs, its passes and its pictures.

Each folder beside this module whose `strategy.py` offers an object `STRATEGY` is a strategy; `registry` finds them.
What is imported there costs next to nothing, since the command asks for names and help before it works: the geometry of
a strategy is imported where it is checked, planned or drawn.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from toolaxis.plan.choices import ISO

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from toolaxis.cldata.toolpath import ToolPath
    from toolaxis.machine.machine import Machine
    from toolaxis.plan.operation import Operation
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.plan import Plan, PlanInputs
    from toolaxis.search.face_problem import FaceProblem
    from toolaxis.tools.tool import Tool

#: The strategy with fixed axes: what is taken unless another one is asked for.
INDEXED = "indexed"
#: How fixed axes are found unless another way is asked for.
SPHERE = "sphere"


@dataclass(frozen=True)
class Asked:
    """What a plan is asked for, as far as strategies look at it.

    Attributes
    ----------
    tool : Tool or None
        None where it is not known yet: nothing is said about it then.
    machine : Machine or None
        None where there is none.
    method, objective : str
    roughness : float or None
        Greatest Ra, mm; None where none is given.
    orientations : int, "auto" or None
        Greatest number of different axes.
    held : str
        Which axis or feed is to be kept, as a clause ("a sub-surface of face 3 has a lock"); empty for none.
    remedy : str
        How a machine is given where a strategy misses one.
    passes : str
        One of `toolaxis.plan.choices.PASSES`.
    least_lean : float
        Least angle between the axis of a ball end and the normal at its contacts, rad; 0 for none.
    greatest_step_over : float
        Greatest distance of neighbouring passes, mm; 0 for none.
    lead : float
        Radius of lead-in and lead-out, mm; 0 for none.
    """

    tool: "Tool | None"
    machine: "Machine | None"
    method: str = SPHERE
    objective: str = "length"
    roughness: float | None = None
    orientations: int | str | None = None
    held: str = ""
    remedy: str = "name a machine"
    passes: str = ISO
    least_lean: float = 0.0
    greatest_step_over: float = 0.0
    lead: float = 0.0


class Strategy(Protocol):
    """A way to machine a sub-surface, with a fixed axis or with one that moves while it cuts.

    Attributes
    ----------
    name : str
        Word for the command and for scripts; where the axis moves, the method in plan.json too.
    title : str
        In plain words, for tables and lists ("five axes, constant lead").
    summary : str
        What it does, as the command's help says it.
    note : str
        What it does and needs, as FreeCAD's panel says it below the choice.
    rank : int
        Place in lists; those of one rank stand by name.
    rotary_axes : int
        Driven rotary axes of a machine that it moves while it cuts; 0 for a fixed axis.
    machine_use : str
        What it does with a machine that it cannot do without ("clamps one of its rotary axes"); empty where it needs
        none.
    roughness : float
        Ra that it keeps unless another is given, mm; 0 where it looks at none.
    in_layers : bool
        Whether it goes around blades in layers: faces are closed to rings first, whatever their iso-parametric lines do
        there, and what it leaves lies beyond the first and the last layer.
    at_points : bool
        Whether the cutter on the machined face is checked at points only.
    compared : bool
        Whether a comparison of methods takes it too, where the machine drives the axes.
    own_spacing : bool
        Whether it lays and joins passes by a rule of its own, which knows of no greatest step-over and no lead-in.
    promise : str
        How the reason begins that tells that it did what it is there for; empty where all its passes do.
    """

    name: str
    title: str
    summary: str
    note: str = ""
    rank: int = 100
    rotary_axes: int = 2
    machine_use: str = ""
    roughness: float = 0.0
    in_layers: bool = False
    at_points: bool = False
    compared: bool = False
    own_spacing: bool = False
    promise: str = ""

    @property
    def pictures(self) -> Mapping[str, str]:
        """Titles of what `draw` draws, by the end of the file's name ("angle" for op01-face1-angle.png)."""
        return {}

    @property
    def moves(self) -> bool:
        """Whether the axis moves while it cuts."""
        return self.rotary_axes > 0

    @property
    def methods(self) -> Mapping[str, str]:
        """Titles of the ways to find an axis that it knows, by their names in plan.json."""
        return {self.name: self.title}

    def check(self, asked: Asked) -> None:
        """Check what only this strategy needs; what all have in common is checked by `inputs.check_strategy`.

        Parameters
        ----------
        asked : Asked

        Raises
        ------
        InvalidInput
            In one sentence with the remedy.
        """
        return

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """What a sub-surface is machined with, and the proven passes.

        Parameters
        ----------
        task : FaceProblem
            Its objective is "length" or "passes" where the axis moves.
        inputs : PlanInputs
        start : (3,) array, optional
            The axis for which the sub-surface was cut out of its face; for fixed axes.

        Returns
        -------
        Orientation
            Without an axis where there is none, with the reasons; with a lead where the axis moves.
        ToolPath or None

        Raises
        ------
        InvalidInput
            When the sub-surface is none for it.
        Cancelled
            When the user asked to stop.
        """
        ...

    def draw(self, plan: "Plan", op: "Operation", task: "FaceProblem", folder: "Path") -> None:
        """Draw what is to be seen of an operation besides its passes, as PNG files.

        Parameters
        ----------
        plan : Plan
        op : Operation
            With a path where the axis moves.
        task : FaceProblem
        folder : Path
        """
        return
