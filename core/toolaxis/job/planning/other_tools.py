"""Faces that take much longer with their tools than others were reckoned to take: which, and what is better."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from toolaxis.job.planning.face_by_face import area_machined
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS, PlanInputs
from toolaxis.regions.tool_choice import ToolChain
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

#: How many times the reckoned cutting time passes take, about: they run out, and their narrowest place sets the strip.
_MADE = 1.4
#: What other tools have to promise of a face: a share of the cutting time that was made, and s.  And of all such faces
#: together: a share of the time of the whole plan, as all of them are planned once more.
_SHARE, _SECONDS, _OF_ALL = 0.2, 8.0, 0.1
#: Share of the cutting time of a face that its other tools have to promise still when some of them are done.
_STILL = 0.1
#: Share of a face's area that may stay open more.
_SAME = 0.01


class ReckonedFace(NamedTuple):
    """What the choice of tools said of a sub-surface: first : its first tool;  chains : what was to choose from."""

    first: int
    chains: tuple[ToolChain, ...]


@dataclass(frozen=True)
class ReckonedTimes:
    """What the choice of tools said that the faces of a part take.

    Attributes
    ----------
    reckoned : dict
        Of each face, by its number, and of each of its sub-surfaces.
    """

    reckoned: dict[int, list[ReckonedFace]] = field(default_factory=dict)

    def add(self, faces: Sequence[Face], chosen: ToolChain, chains: Sequence[ToolChain]) -> None:
        """Keep what was said of a sub-surface and those that are alike.

        Parameters
        ----------
        faces : sequence of Face
        chosen : ToolChain
        chains : sequence of ToolChain
            All that were to choose from.
        """
        for face in faces:
            if chosen.tools:
                self.reckoned.setdefault(face.number, []).append(ReckonedFace(chosen.tools[0], tuple(chains)))

    def find_slow_faces(self, made: Sequence[Operation], inputs: PlanInputs,
                        allowed: Collection[int]) -> dict[int, list[int]]:
        """The faces whose operations take much longer than smaller tools may, by the first of these tools.

        Parameters
        ----------
        made : sequence of Operation
            Of all faces.
        inputs : PlanInputs
        allowed : collection of int
            Numbers of the tools that may be used.

        Returns
        -------
        dict of int to list of int
            Numbers of tools, with those of faces; empty where all of them together would save little of the plan.
        """
        found: dict[int, list[int]] = {}
        promised = 0.0
        for number, sub_surfaces in self.reckoned.items():
            own = [op for op in made if op.face.number == number]
            if len(sub_surfaces) != 1 or any(op.failed for op in own):
                continue
            reckoned = sub_surfaces[0]
            spent = sum(op.seconds(inputs.feedrate, inputs.rapid) for op in own)
            others = _chains_of_smaller(reckoned, allowed)
            if not others:
                continue
            best = min(others, key=_likely_seconds)
            saved = spent - _times_reckoned(spent, reckoned) * _likely_seconds(best)
            if saved >= max(_SECONDS, _SHARE * spent):
                found.setdefault(best.tools[0], []).append(number)
                promised += saved
        return found if promised >= _OF_ALL * seconds_of(made, frozenset(), inputs) else {}


def tools_of(operations: Iterable[Operation]) -> frozenset[Tool]:
    """The tools of operations that have an axis.

    Parameters
    ----------
    operations : iterable of Operation
    """
    return frozenset(op.tool for op in operations if op.done)


def seconds_of(operations: Sequence[Operation], tools: frozenset[Tool], inputs: PlanInputs) -> float:
    """Time of operations, with an index move for each and a change for each further tool, s.

    Parameters
    ----------
    operations : sequence of Operation
    tools : frozenset of Tool
        That others use.
    inputs : PlanInputs
    """
    cut = sum(op.seconds(inputs.feedrate, inputs.rapid) + INDEX_SECONDS for op in operations if op.done)
    return cut + CHANGE_SECONDS * len(tools_of(operations) - tools)


def takes_less_time(one: Sequence[Operation], other: Sequence[Operation], tools: frozenset[Tool],
                    inputs: PlanInputs) -> bool:
    """Whether some operations take less time than others on the same face, and machine as much.

    Parameters
    ----------
    one, other : sequence of Operation
    tools : frozenset of Tool
        That further operations use.
    inputs : PlanInputs
    """
    area = sum(op.face.area for op in other)
    if area_machined(one) < area_machined(other) - _SAME * area:
        return False
    return seconds_of(one, tools, inputs) <= seconds_of(other, tools, inputs) - INDEX_SECONDS


def may_take_less_time(one: Sequence[Operation], other: Sequence[Operation], still: Collection[Tool],
                       inputs: PlanInputs) -> bool:
    """Whether some operations, with those that are yet to come, may take much less time than others on the same face.

    What is yet to come is reckoned to take as long for its area as with the others.

    Parameters
    ----------
    one, other : sequence of Operation
        The first of them, which are made; and all others.
    still : collection of Tool
        That are yet to come.
    inputs : PlanInputs
    """
    made = [op for op in one if op.done]
    if not made:
        return True
    whole = [op for op in other if op.done]
    later = [op for op in whole if op.tool in still] or whole
    left = max(area_machined(whole) - area_machined(made), 0.0)
    spent = seconds_of(whole, frozenset(), inputs)
    rate = seconds_of(later, tools_of(later), inputs) / max(area_machined(later), 1e-9)
    return seconds_of(made, frozenset(), inputs) + rate * left <= spent - max(_SECONDS, _STILL * spent)


def _likely_seconds(chain: ToolChain) -> float:
    """What the cuts of a chain take when it is made, about, and what it leaves, s: into how many sub-surfaces faces
    fall, and so how many index moves there are, nobody knows before."""
    return _MADE * (chain.seconds - INDEX_SECONDS * len(chain.tools)) + chain.charge


def _chains_of_smaller(face: ReckonedFace, allowed: Collection[int]) -> list[ToolChain]:
    """The chains that begin with a smaller tool than was taken, of tools that may be used."""
    smaller = [chain for chain in face.chains if chain.tools and chain.tools[0] > face.first]
    return [chain for chain in smaller if set(chain.tools) <= set(allowed)]


def _times_reckoned(spent: float, face: ReckonedFace) -> float:
    """How many times what was said of the tools that were taken their cuts took in the end, at least once.

    What makes them longer, such as places that interrupt passes, is there for other tools too.
    """
    said = [_likely_seconds(chain) for chain in face.chains if chain.tools and chain.tools[0] == face.first]
    return max(1.0, spent / max(min(said, default=spent), 1e-9))
