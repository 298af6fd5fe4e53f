"""The strategy `sturz`: five axes with the best constant lead."""

from typing import TYPE_CHECKING

from toolaxis.strategies.strategy import Strategy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from toolaxis.cldata.toolpath import ToolPath
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.plan import PlanInputs
    from toolaxis.search.face_problem import FaceProblem


class ConstantLead(Strategy):
    """The same lead everywhere along the feed: what fixed axes are compared with."""

    name = "sturz"
    title = "five axes, constant lead"
    summary = "simultaneous five-axis milling with the best constant lead"
    note = "The axis leans by a constant angle from the normal, along the feed."
    rank = 1
    at_points = True
    compared = True

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """The best constant lead and its passes."""
        from toolaxis.strategies.constant_lead.search import sturz

        return sturz(task)


STRATEGY = ConstantLead()
