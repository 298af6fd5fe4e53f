"""How much of a part's faces a plan machines, and what stays open."""

from collections.abc import Sequence
from dataclasses import dataclass

from toolaxis.plan.operation import Operation
from toolaxis.plan.unplanned_area import HIDDEN, REST, UnplannedArea


@dataclass(frozen=True)
class PartAccount:
    """The faces that a plan was asked for, in mm^2 and mm.

    Attributes
    ----------
    area : float
        Of all sub-surfaces, those apart that finish what others leave, and of what is in no operation.
    machined : float
        What operations machine of it, without what they leave to a clean-up tool.
    unreachable : float
        What is proven to be out of reach of every tool.
    length : float
        Of all cuts, run-outs included.
    bound : float
        The ideal length of the operations' axes, to which passes tend as the scallop height goes to zero; 0 where that
        of one is not known.
    not_begun : float
        What was not begun when the plan was stopped: nothing is known of it.
    """

    area: float
    machined: float
    unreachable: float
    length: float
    bound: float
    not_begun: float = 0.0

    @staticmethod
    def of(operations: Sequence[Operation], unplanned: Sequence[UnplannedArea] = ()) -> "PartAccount":
        """What some operations come to.

        Parameters
        ----------
        operations : sequence of Operation
        unplanned : sequence of UnplannedArea
            What is in none of them.
        """
        done = [op for op in operations if op.done]
        area = sum(op.face.area for op in operations if not op.rest_of)
        area += sum(one.area for one in unplanned if one.why != REST)
        machined = sum(op.face.area * (1 - op.orientation.unreached) for op in done)
        ideals = [op.orientation.ideal_of_cut for op in done]
        bound = sum(ideals) if all(one > 0 for one in ideals) else 0.0
        machined = min(machined, area)
        proven = sum(op.unreachable if not op.done else sum(zone.unreachable for zone in op.zones) for op in operations)
        proven = min(proven, area - machined)
        not_begun = sum(one.area for one in unplanned if one.why != HIDDEN)
        not_begun = min(not_begun, area - machined - proven)
        length = sum(op.orientation.length for op in done)
        return PartAccount(float(area), float(machined), float(proven), float(length), float(bound), float(not_begun))

    @property
    def open(self) -> float:
        """What is neither machined nor proven to be out of reach although it was tried, mm^2."""
        return max(self.area - self.machined - self.unreachable - self.not_begun, 0.0)

    @property
    def gap(self) -> float | None:
        """By what share the cuts are longer than the ideal ones; None where these are not known."""
        return self.length / self.bound - 1 if self.bound > 0 else None
