"""Strategies as the add-on offers them: the library's with their texts translated, and its check of a job's inputs."""

from math import radians

import FreeCAD
from freecad.toolaxis.document.machine_limits import PREFIX, mounting

from toolaxis.strategies.registry import strategies, strategy_of
from toolaxis.strategies.strategy import INDEXED as INDEXED
from toolaxis.strategies.strategy import SPHERE, Asked

translate = FreeCAD.Qt.translate

#: As the panel offers them; the first one has fixed axes.
STRATEGIES = tuple(strategies())
#: The Ra of jobs whose strategy looks at none, or that give none, micrometres.
ROUGHNESS = max(1000 * one.roughness for one in strategies().values())


def keeps_roughness(strategy):
    """Whether a strategy looks at the roughness; of none that does not exist.

    Parameters
    ----------
    strategy : str
    """
    return strategy in STRATEGIES and strategies()[strategy].roughness > 0


def check_strategy(inputs):
    """Check that a job's strategy goes with its tool, machine and method.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Raises
    ------
    InvalidInput
        In one sentence with the remedy.
    """
    from toolaxis.strategies import inputs as library

    tool = machine = None
    if inputs.strategy != INDEXED or inputs.method != SPHERE:  # else neither matters, and they take time to read
        tool = inputs.tools()[0]
        machine = mounting(inputs.limits, tool).machine if inputs.limits.startswith(PREFIX) else None
    held = next((piece for piece in inputs.pieces if piece.locked or piece.feed), None)
    library.check_strategy(inputs.strategy, Asked(
        tool, machine, inputs.method, inputs.objective, _roughness_of(inputs), inputs.orientations,
        "" if held is None else f"axis or feed of {held.name}{held.suffix} are locked",
        "choose a machine among the limits of the tool axis", inputs.passes, radians(inputs.least_lean),
        inputs.greatest_step_over, inputs.lead))


def _roughness_of(inputs):
    """Ra in mm, as it is planned with; None where the strategy looks at none."""
    return inputs.roughness / 1000 if keeps_roughness(inputs.strategy) else None


def asked_of(inputs):
    """What `toolaxis.plan` is given for the strategy of a job, as keyword arguments.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    """
    return {"strategy": inputs.strategy, "roughness": _roughness_of(inputs)}


def refuse_in_vain(plan):
    """Refuse a plan in which a strategy that moves the axis came to nothing.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan

    Raises
    ------
    UnsupportedGeometry
        When no sub-surface has passes.
    """
    from toolaxis.errors import UnsupportedGeometry

    method, operations = plan.inputs.method, plan.operations
    if not strategy_of(method).moves or plan.outcome == "cancelled" or not operations:
        return
    one, done = operations[0], [op for op in operations if op.done]
    if not done:
        why = (one.orientation.reasons or (f"outcome {one.orientation.outcome}",))[0]
        raise UnsupportedGeometry(f"strategy {method!r} does not serve face {one.face.label}: {why}")


def titles():
    """What the strategies are called, as the panel offers them."""
    return [translate("ToolAxisPlan", one.title) for one in strategies().values()]


def needs(strategy):
    """What a strategy does and needs, as the panel says it below the choice.

    Parameters
    ----------
    strategy : str
        One of `STRATEGIES`.
    """
    note = strategies()[strategy].note
    return translate("ToolAxis", note) if note else ""


def picture_titles():
    """What the pictures of strategies are called, by the end of their files' names."""
    return {kind: translate("ToolAxis", title) for one in strategies().values() for kind, title in one.pictures.items()}
