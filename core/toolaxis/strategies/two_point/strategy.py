"""The strategy `two-point`: a flat end or torus that touches concave faces at two points."""

from typing import TYPE_CHECKING

from toolaxis.strategies.strategy import Asked, Strategy

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from toolaxis.cldata.toolpath import ToolPath
    from toolaxis.plan.operation import Operation
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.plan import Plan, PlanInputs
    from toolaxis.search.face_problem import FaceProblem


class TwoPoint(Strategy):
    """Two contacts where the face is hollow, one elsewhere."""

    name = "two-point"
    title = "two-point contact"
    summary = "simultaneous five-axis milling in which a flat end or torus touches concave faces at two points"
    note = "The cutter touches the face at two points where it is concave. Needs a flat end mill or bull nose."
    rank = 2
    own_spacing = True
    promise = "two contacts on"

    @property
    def pictures(self) -> dict[str, str]:
        """The cutter at its contacts."""
        return {"contacts": "Two-point contact"}

    def check(self, asked: Asked) -> None:
        """Check that the cutter has a flat bottom."""
        from toolaxis.strategies.two_point.rings import check_bottom

        if asked.tool is not None:
            check_bottom(asked.tool)

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """Passes with two contacts where they can be had."""
        from toolaxis.strategies.two_point.search import two_point

        return two_point(task)

    def draw(self, plan: "Plan", op: "Operation", task: "FaceProblem", folder: "Path") -> None:
        """Draw the cutter at the widest of its two-point contacts."""
        from toolaxis.strategies.two_point.pictures import draw_contacts

        draw_contacts(plan, op, folder)


STRATEGY = TwoPoint()
