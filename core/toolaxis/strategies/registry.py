"""All strategies: the folders beside this module that offer one."""

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules

from toolaxis import strategies as _package
from toolaxis.errors import InvalidInput
from toolaxis.strategies.strategy import Strategy


@cache
def strategies() -> Mapping[str, Strategy]:
    """The strategies by name, in the order in which they are listed."""
    found: list[Strategy] = []
    for folder in iter_modules(_package.__path__, f"{_package.__name__}."):
        module = f"{folder.name}.strategy"
        if folder.ispkg and find_spec(module) is not None:
            found.append(import_module(module).STRATEGY)
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
    known = strategies()
    if name not in known:
        raise InvalidInput(f"strategy is {name!r}: use {_one_of(known)}")
    return known[name]


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
    if method not in known:
        raise InvalidInput(f"method is {method!r}: use {_one_of(known)}")
    return known[method]


def title_of(method: str) -> str:
    """What a method is called in tables; its own name where no strategy has it.

    Parameters
    ----------
    method : str
    """
    return next((one.methods[method] for one in strategies().values() if method in one.methods), method)


def _one_of(names: Mapping[str, object]) -> str:
    *most, last = names
    return f"{', '.join(most)} or {last}"
