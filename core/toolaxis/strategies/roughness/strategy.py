"""The strategy `multiscale`: a roughness across the feed and an expected strip width, the rotary axes turning least."""

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

#: Ra unless given, mm.
ROUGHNESS = 1.6e-3


class Roughness(Strategy):
    """Strip width and roughness together."""

    name = "multiscale"
    title = "strip width and roughness"
    summary = "bull-nose finishing to a given --roughness and strip width with minimal rotary motion"
    note = ("Keeps to the roughness and strip width with the least rotary motion. Needs a bull nose and a machine (tab "
            "Job).")
    rank = 5
    own_spacing = True
    machine_use = "minimises the motion of its rotary axes"
    roughness = ROUGHNESS
    at_points = True

    @property
    def pictures(self) -> dict[str, str]:
        """Strip width and Ra over the face."""
        return {"roughness": "Strip width and roughness"}

    def check(self, asked: Asked) -> None:
        """Check that the cutter is a torus."""
        from toolaxis.strategies.roughness.feasible_area import check_bull_nose

        if asked.tool is not None:
            check_bull_nose(asked.tool, flat_too=False)

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """Passes that keep the roughness."""
        from toolaxis.strategies.roughness.plan import multiscale

        return multiscale(task, inputs.roughness, inputs.feedrate)

    def draw(self, plan: "Plan", op: "Operation", task: "FaceProblem", folder: "Path") -> None:
        """Draw strip width and Ra over the face, and what the rotary axes do."""
        from toolaxis.strategies.roughness.pictures import draw_roughness

        draw_roughness(plan, op, folder)


STRATEGY = Roughness()
