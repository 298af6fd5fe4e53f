"""Strategies that move the axis while it cuts: which there are, and whether one goes with what a job is given."""

import FreeCAD
from freecad.toolaxis.document.machine_limits import PREFIX, mounting

translate = FreeCAD.Qt.translate

INDEXED, BLADES = "indexed", ("blade", "blade-keys")
#: As the panel offers them; the first one has fixed axes.
STRATEGIES = (INDEXED, "four-plus-one", "two-point", "sturz", "multiscale", *BLADES)
#: The strategy that looks at the roughness, and the Ra that it keeps unless another is given, micrometres.
ROUGH, ROUGHNESS = "multiscale", 1.6
#: Strategies that follow the rotary axes of a machine, and what they do with them.
_ON_MACHINES = {"four-plus-one": "clamps one rotary axis of a machine and turns the other",
                ROUGH: "has the rotary axes of a machine turn least"}

#: How the reason begins that tells how much of the passes has two contacts.
TWICE = "two contacts on"


def check_strategy(inputs):
    """Check that a job's strategy goes with its tool, machine and method.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.Inputs

    Raises
    ------
    InvalidInput
        In one sentence with the remedy.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.job.inputs.spec import by_strategy, check_five_axes, roughness_for
    from toolaxis.strategies.blade.plan import check_ball
    from toolaxis.strategies.roughness.feasible_area import check_bull_nose
    from toolaxis.strategies.two_point.rings import check_bottom

    strategy = inputs.strategy
    by_strategy(strategy, inputs.method, inputs.objective)
    if strategy == INDEXED:
        return
    if inputs.orientations is not None:
        raise InvalidInput(f"strategy {strategy!r} moves the axis, so that sub-surfaces share none: leave out the "
                           "number of axes")
    held = next((piece for piece in inputs.pieces if piece.locked or piece.feed), None)
    if held is not None:
        raise InvalidInput(f"strategy {strategy!r} moves the axis, and axis or feed of {held.name}{held.suffix} are "
                           "locked: take the lock away, or choose fixed axes")
    tool = inputs.assembled()
    if strategy == "two-point":
        check_bottom(tool)
    elif strategy == ROUGH:
        roughness_for(strategy, inputs.roughness / 1000)
        check_bull_nose(tool, flat_too=False)
    elif strategy in BLADES:
        check_ball(tool)
    if inputs.limits.startswith(PREFIX):
        check_five_axes(mounting(inputs.limits, tool).machine, strategy)
    elif strategy in _ON_MACHINES:
        raise InvalidInput(f"strategy {strategy!r} {_ON_MACHINES[strategy]}: choose a machine among the limits of the "
                           "tool axis")


def asked_of(inputs):
    """What `toolaxis.plan` is given for the strategy of a job, as keyword arguments.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.Inputs
    """
    return {"strategy": inputs.strategy, "roughness": inputs.roughness / 1000 if inputs.strategy == ROUGH else None}


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
    if method not in STRATEGIES or plan.outcome == "cancelled" or not operations:
        return
    one, done = operations[0], [op for op in operations if op.done]
    if not done:
        why = (one.orientation.reasons or (f"outcome {one.orientation.outcome}",))[0]
        raise UnsupportedGeometry(f"strategy {method!r} does not serve face {one.face.label}: {why}")


def needs(strategy):
    """What a strategy does and needs, as the panel says it below the choice.

    Parameters
    ----------
    strategy : str
        One of `STRATEGIES`.
    """
    blade = translate("ToolAxis", "A ball end goes around a blade in layers, one rotary axis swings. Needs a ball "
                                  "end; of the faces around a blade one is enough.")
    return {
        "four-plus-one": translate("ToolAxis", "One rotary axis is clamped, the other turns along the passes. Needs a "
                                               "machine on the tab Limits."),
        "two-point": translate("ToolAxis", "The cutter touches the face at two points where that is hollow. "
                                           "Needs a flat end or bull nose."),
        "sturz": translate("ToolAxis", "The axis leans by one angle from the normal, along the feed."),
        ROUGH: translate("ToolAxis", "Keeps roughness and strip width, the rotary axes turn least. Needs a bull nose "
                                     "and a machine on the tab Limits."),
        "blade": blade, "blade-keys": blade}.get(strategy, "")
