"""What a program is made from: the machine and the inputs, a plan and its stations, and what a user says about it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import isfinite

from numpy.typing import ArrayLike

from toolaxis.errors import InvalidInput
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.tools.tool import Tool


@dataclass(frozen=True, eq=False, kw_only=True)
class ProgramContext:
    """What every block of a program may depend on besides motions.

    Attributes
    ----------
    mounting : Mounting
    inputs : PlanInputs
        Spindle speed and feed rates, of the tool in the spindle.
    name : str
        Of the program; letters, digits, points, dashes and underscores are kept.
    tool_number : int
        Its place in the machine's magazine.
    retract : float or None
        Machine coordinate of Z at which rotary axes may turn, mm, for controls that are told it.
    clamp, unclamp : tuple of str
        Words that hold and let go the rotary axes around an index move.
    """

    mounting: Mounting
    inputs: PlanInputs
    name: str = "toolaxis"
    tool_number: int = 1
    retract: float | None = None
    clamp: tuple[str, ...] = ()
    unclamp: tuple[str, ...] = ()

    @property
    def machine(self) -> Machine:
        """The machine of the mounting."""
        return self.mounting.machine


@dataclass(frozen=True, eq=False, kw_only=True)
class Program(ProgramContext):
    """All that a dialect needs to write a plan.

    Attributes
    ----------
    mounting, inputs, name, tool_number, retract, clamp, unclamp
        As for `ProgramContext`.
    plan : Plan
    stations : tuple of IndexedPosition
    """

    plan: Plan
    stations: tuple[IndexedPosition, ...] = ()

    def with_tool(self, tool: Tool) -> "Program":
        """The same with a tool of the plan in the spindle, at its feed and speed.

        Parameters
        ----------
        tool : Tool
        """
        return replace(self, tool_number=tool.number or 1, inputs=self.plan.inputs.at_rates_of(tool))


@dataclass(frozen=True)
class Options:
    """What a user may say about a program.

    Attributes
    ----------
    retract : float, optional
        Machine coordinate of Z, mm, at which rotary axes may turn; the upper end of Z's travel unless given.
    clamp, unclamp : tuple of str
        Words around an index move, such as M10; the dialect's own unless given.
    angles : mapping of int to (m,) array_like
        Rotary angles already chosen for operations, by their numbers, rad; those with the least turn unless given.

    Raises
    ------
    InvalidInput
        When the retract is not finite or a word is none.
    """

    retract: float | None = None
    clamp: tuple[str, ...] = field(default=())
    unclamp: tuple[str, ...] = field(default=())
    angles: Mapping[int, ArrayLike] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.retract is not None and not isfinite(self.retract):
            raise InvalidInput(f"retract is {self.retract} mm: a finite machine coordinate of Z is needed")
        for word in (*self.clamp, *self.unclamp):
            if not (word[:1].isalpha() and word.isascii() and word.isalnum()):
                raise InvalidInput(f"clamp word {word!r} is none: use words such as M10, joined by commas")
