"""All dialects: the modules beside this one that offer some, and their tool centre point controls."""

from collections.abc import Iterator
from types import ModuleType

from toolaxis.errors import InvalidInput
from toolaxis.plugins import modules_in, pick
from toolaxis.post import dialects as _package
from toolaxis.post.program import Dialect
from toolaxis.post.tcp_program import TipControl

#: What the command takes besides the dialects of programs: CL files, which need no machine.
APT = "apt"


def dialects() -> dict[str, Dialect]:
    """The dialects by name: `DIALECTS` of each module."""
    return {one.name: one for module in _modules() for one in module.DIALECTS}


def tip_controls() -> dict[str, TipControl]:
    """The tool centre point controls by the name of their dialect: `TIP_CONTROLS` of the modules that have some."""
    return {one.dialect.name: one for module in _modules() for one in getattr(module, "TIP_CONTROLS", ())}


def _modules() -> Iterator[ModuleType]:
    return (module for module in modules_in(_package) if module.__name__ != __name__)


def dialect_named(name: str) -> Dialect:
    """The dialect with a name.

    Parameters
    ----------
    name : str

    Raises
    ------
    InvalidInput
        When there is none.
    """
    return pick(dialects(), "dialect", name, APT)


def tip_control_of(dialect: Dialect) -> TipControl:
    """The tool centre point control of a dialect.

    Parameters
    ----------
    dialect : Dialect

    Raises
    ------
    InvalidInput
        When it has none, or none that is known for sure.
    """
    known = tip_controls()
    if dialect.name not in known:
        raise InvalidInput(f"the tool axis of the plan moves and dialect {dialect.name} has no tool centre point "
                           f"control here: use {', '.join(known)} or apt")
    return known[dialect.name]
