"""All strategies: the folders beside this module that offer one."""

from collections.abc import Mapping
from functools import cache

from toolaxis import strategies as _package
from toolaxis.plan.choices import ISO
from toolaxis.plugins import modules_in, pick
from toolaxis.strategies.strategy import Strategy


@cache
def strategies() -> Mapping[str, Strategy]:
    """The strategies by name, in the order in which they are listed."""
    found: list[Strategy] = [module.STRATEGY for module in modules_in(_package, "strategy")]
    found.sort(key=lambda one: (one.rank, one.name))
    return {one.name: one for one in found}


def strategy_named(name: str) -> Strategy:
    """The strategy with a name.

    Parameters
    ----------
    name : str

    Raises
    ------
    InvalidInput
        When there is none.
    """
    return pick(strategies(), "strategy", name)


def strategy_of(method: str) -> Strategy:
    """The strategy that a method in plan.json belongs to.

    Parameters
    ----------
    method : str

    Raises
    ------
    InvalidInput
        When no strategy has such a method.
    """
    known = {own: one for one in strategies().values() for own in one.methods}
    return pick(known, "method", method)


def title_of(method: str) -> str:
    """What a method is called in tables; its own name where no strategy has it.

    Parameters
    ----------
    method : str
        Or how passes lie, where a plan is compared with the same method's iso-parametric ones.
    """
    if method == ISO:
        return "iso-parametric passes"
    return next((one.methods[method] for one in strategies().values() if method in one.methods), method)
