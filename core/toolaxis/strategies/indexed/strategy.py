"""The strategy `indexed`: one fixed axis for each sub-surface, by one of several methods."""

from typing import TYPE_CHECKING

from toolaxis.errors import InvalidInput
from toolaxis.plugins import pick
from toolaxis.strategies.strategy import INDEXED, SPHERE, Asked, Strategy

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from toolaxis.cldata.toolpath import ToolPath
    from toolaxis.plan.operation import Operation
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.plan import Plan, PlanInputs
    from toolaxis.search.face_problem import FaceProblem

#: The method that goes by what the linear axes of a machine do.
JERK = "jerk"
#: How fixed axes are found, and what each way is called.
METHODS = {SPHERE: "best of the hemisphere", "sectors": "sectors of zhu2016", JERK: "most jerk along the passes",
           "roman": "Roman's rule", "normal": "mean normals", "one": "one fixed axis", "ball": "ball end, mean normal"}
#: Methods that search as another one does.
_SEARCHES = {"ball": "normal"}


class Indexed(Strategy):
    """The best fixed axis."""

    name = INDEXED
    title = "fixed axes (3+2)"
    summary = "one fixed axis for each sub-surface"
    rank = 0
    rotary_axes = 0

    @property
    def methods(self) -> dict[str, str]:
        """Ways to find a fixed axis."""
        return METHODS

    @property
    def pictures(self) -> dict[str, str]:
        """Axes, strips, and how well they are estimated."""
        return {"axes": "Tool axes", "widths": "Strip widths", "estimate": "Estimate and count"}

    def check(self, asked: Asked) -> None:
        """Check the method and its machine, and that axes which it names itself are neither to be shared nor kept.

        Raises
        ------
        InvalidInput
        """
        pick(METHODS, "method", asked.method)
        if asked.orientations is not None and asked.method != SPHERE:
            raise InvalidInput(f"method {asked.method!r} chooses one axis for each sub-surface, so the number of "
                               "orientations cannot be limited: leave out one of the two")
        if asked.method == JERK:
            from toolaxis.machine.feed_polytopes import check_jerk_stated

            check_jerk_stated(asked.machine, asked.remedy)
        if asked.held and asked.method == "one":
            raise InvalidInput(f"method 'one' uses one axis for all sub-surfaces, but {asked.held}: leave out the "
                               "method, or remove the lock")

    def plan(self, task: "FaceProblem", inputs: "PlanInputs",
             start: "NDArray[np.float64] | None" = None) -> "tuple[Orientation, ToolPath | None]":
        """The fixed axis that the method finds, and its passes."""
        from toolaxis.search.fixed_axis import find_axis

        return find_axis(task, _SEARCHES.get(inputs.method, inputs.method), start)

    def draw(self, plan: "Plan", op: "Operation", task: "FaceProblem", folder: "Path") -> None:
        """Draw the map of axes and the strip widths, and the study of estimate and count where methods are compared."""
        from toolaxis.strategies.indexed.pictures import draw_fixed_axis

        draw_fixed_axis(plan, op, task, folder)


STRATEGY = Indexed()
