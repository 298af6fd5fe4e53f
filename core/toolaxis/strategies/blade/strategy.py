"""The strategy `blade`: layers around a blade, one rotary axis swinging with least peak acceleration."""

from typing import TYPE_CHECKING, ClassVar

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


class BladeStrategy(Strategy):
    """Tool angles of least peak acceleration."""

    name = "blade"
    title = "blade, least acceleration"
    summary = ("a ball end follows layers around blades; one rotary axis swings one way only, with the least "
               "acceleration")
    note = ("A ball end goes around a blade in layers while one rotary axis swivels. Needs a ball end; of the faces "
            "around a blade one is enough.")
    rank = 3
    rotary_axes = 1
    in_layers = True
    own_spacing = True
    at_points = True
    #: Of `toolaxis.strategies.blade.schedule.CURVES`: how tool angles are chosen.
    curve: ClassVar[str] = "least"

    @property
    def pictures(self) -> dict[str, str]:
        """Tool angles, and the axes along a layer."""
        return {"angles": "Tool angles in the S-theta plane", "motion": "Motion of the axes"}

    def check(self, asked: Asked) -> None:
        """Check that the cutter ends in a ball."""
        from toolaxis.strategies.blade.plan import check_ball

        if asked.tool is not None:
            check_ball(asked.tool)

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """Layers around the blade."""
        from toolaxis.strategies.blade.plan import blade

        return blade(task, curve=self.curve)

    def draw(self, plan: "Plan", op: "Operation", task: "FaceProblem", folder: "Path") -> None:
        """Draw the tool angles of one layer, and what the machine's axes do along it."""
        from toolaxis.strategies.blade.pictures import draw_blade

        draw_blade(plan, op, task, folder, self.curve)


STRATEGY = BladeStrategy()
