"""The strategy `four-plus-one`: one rotary axis clamped, the other turning along the passes."""

from typing import TYPE_CHECKING

from toolaxis.strategies.strategy import Strategy

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from toolaxis.cldata.toolpath import ToolPath
    from toolaxis.plan.operation import Operation
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.plan import Plan, PlanInputs
    from toolaxis.search.face_problem import FaceProblem


class FourPlusOne(Strategy):
    """The best clamped angle of either rotary axis."""

    name = "four-plus-one"
    title = "4+1 axes"
    summary = "one rotary axis of the machine clamped at the best angle, the other turning along the passes"
    note = "One rotary axis is clamped, the other rotates along the passes. Needs a machine (tab Job)."
    rank = 4
    machine_use = "clamps one of its rotary axes and turns the other"
    at_points = True

    @property
    def pictures(self) -> dict[str, str]:
        """The free angle."""
        return {"angle": "Rotating axis"}

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """The best clamped angle and its passes; the best fixed axis where that is shorter."""
        from toolaxis.strategies.four_plus_one.search import four_plus_one

        return four_plus_one(task)

    def draw(self, plan: "Plan", op: "Operation", task: "FaceProblem", folder: "Path") -> None:
        """Draw the angle of the axis that turns, over the face and along the passes."""
        from toolaxis.strategies.four_plus_one.pictures import draw_free_angle

        draw_free_angle(plan, op, folder)


STRATEGY = FourPlusOne()
