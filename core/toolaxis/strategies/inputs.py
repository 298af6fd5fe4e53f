"""Whether a strategy goes with what a plan is asked for: the one check for the command, for scripts and for FreeCAD."""

from math import isfinite

from toolaxis.errors import InvalidInput
from toolaxis.plan.choices import ISO
from toolaxis.strategies.registry import strategies, strategy_named
from toolaxis.strategies.strategy import SPHERE, Asked, Strategy

_NEEDED = {1: "one driven rotary axis", 2: "two driven rotary axes"}
_HAS = ("none", "one")


def check_strategy(name: str, asked: Asked) -> Strategy:
    """The strategy with a name, if it goes with what is asked for.

    Parameters
    ----------
    name : str
    asked : Asked

    Raises
    ------
    InvalidInput
        When there is no such strategy, or something does not go with it: one sentence, with the remedy.
    """
    strategy = strategy_named(name)
    check_roughness(name, asked.roughness)
    if strategy.moves:
        _check_moving(strategy, asked)
    elif any(one.moves and asked.method == one.name for one in strategies().values()):
        raise InvalidInput(f"method {asked.method!r} moves the axis: give it as the strategy instead")
    strategy.check(asked)
    if strategy.moves:
        _check_machine(strategy, asked)
    return strategy


def check_roughness(name: str, roughness: float | None) -> None:
    """Check that a roughness is given only to a strategy that looks at it, and one that can be kept.

    Parameters
    ----------
    name : str
    roughness : float or None
        Greatest Ra, mm.

    Raises
    ------
    InvalidInput
    """
    if roughness is None:
        return
    if not strategy_named(name).roughness:
        others = " or ".join(repr(one.name) for one in strategies().values() if one.roughness)
        raise InvalidInput(f"roughness applies to strategy {others} only, not to {name!r}: leave out the roughness, or "
                           "change the strategy")
    if not (isfinite(roughness) and roughness > 0):
        raise InvalidInput(f"roughness is {1000 * roughness:g} um: it must be finite and above zero")


def _check_moving(strategy: Strategy, asked: Asked) -> None:
    """Check what all strategies have in common that move the axis."""
    name = strategy.name
    if asked.method not in (SPHERE, name):
        raise InvalidInput(f"method {asked.method!r} is for fixed axes and strategy {name!r} moves the axis: leave out "
                           "one of the two")
    if asked.passes != ISO:
        raise InvalidInput(f"passes {asked.passes!r} need a fixed axis and strategy {name!r} moves the axis: leave out "
                           "one of the two")
    if asked.objective == "time":
        raise InvalidInput(f"strategy {name!r} minimises cutting length or number of passes, not time: leave out the "
                           "objective 'time'")
    if asked.orientations is not None:
        raise InvalidInput(f"strategy {name!r} moves the axis, so there are no shared axes to count: leave out the "
                           "number of orientations")
    if asked.greatest_step_over > 0 and strategy.own_spacing:
        raise InvalidInput(f"strategy {name!r} lays its passes by a rule of its own, without a greatest step-over: "
                           "leave out the step-over, or use fixed axes, 'sturz' or 'four-plus-one'")
    if asked.lead > 0 and strategy.own_spacing:
        raise InvalidInput(f"strategy {name!r} joins its passes by a rule of its own, without arcs of lead-in and "
                           "lead-out: leave out the lead, or use fixed axes, 'sturz' or 'four-plus-one'")
    if asked.least_lean > 0 and strategy.in_layers:
        raise InvalidInput(f"strategy {name!r} swings the axis about the ball's centre and keeps no least lean: leave "
                           "out the least lean, or use fixed axes")
    if asked.held:
        raise InvalidInput(f"strategy {name!r} moves the axis, but {asked.held}: remove the lock, or use fixed axes")


def _check_machine(strategy: Strategy, asked: Asked) -> None:
    """Check that there is a machine where one is needed, and that it drives the rotary axes."""
    name, machine = strategy.name, asked.machine
    if machine is None:
        if strategy.machine_use:
            raise InvalidInput(f"strategy {name!r} needs a machine, because it {strategy.machine_use}: {asked.remedy}")
        return
    driven = sum(not axis.by_hand for axis in machine.rotary)
    if driven < strategy.rotary_axes:
        raise InvalidInput(f"strategy {name!r} needs {_NEEDED[strategy.rotary_axes]} and {machine.name} has "
                           f"{_HAS[driven]}: name another machine, or leave out the strategy")
