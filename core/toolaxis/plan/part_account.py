"""How much of a part's faces a plan machines, and what stays open."""

from collections.abc import Sequence
from dataclasses import dataclass

from toolaxis.plan.operation import Operation


@dataclass(frozen=True)
class PartAccount:
    """The faces that a plan was asked for, in mm^2 and mm.

    Attributes
    ----------
    area : float
        Of all sub-surfaces, those apart that finish what others leave.
    machined : float
        What operations machine of it, without what they leave to a clean-up tool.
    unreachable : float
        What is proven to be out of reach of every tool.
    length : float
        Of all cuts, run-outs included.
    bound : float
        The ideal length of the operations' axes, to which passes tend as the scallop height goes to zero; 0 where that
        of one is not known.
    """

    area: float
    machined: float
    unreachable: float
    length: float
    bound: float

    @staticmethod
    def of(operations: Sequence[Operation]) -> "PartAccount":
        """What some operations come to.

        Parameters
        ----------
        operations : sequence of Operation
        """
        done = [op for op in operations if op.done]
        area = sum(op.face.area for op in operations if not op.rest_of)
        machined = sum(op.face.area * (1 - op.orientation.unreached) for op in done)
        ideals = [op.orientation.ideal_of_cut for op in done]
        bound = sum(ideals) if all(one > 0 for one in ideals) else 0.0
        machined = min(machined, area)
        proven = sum(op.unreachable if not op.done else sum(zone.unreachable for zone in op.zones) for op in operations)
        return PartAccount(float(area), float(machined), float(min(proven, area - machined)),
                           float(sum(op.orientation.length for op in done)), float(bound))

    @property
    def open(self) -> float:
        """What is neither machined nor proven to be out of reach, mm^2."""
        return max(self.area - self.machined - self.unreachable, 0.0)

    @property
    def gap(self) -> float | None:
        """By what share the cuts are longer than the ideal ones; None where these are not known."""
        return self.length / self.bound - 1 if self.bound > 0 else None
