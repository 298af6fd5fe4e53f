"""What is found in the folder it stands in, strategies, dialects and cutters, and the choice of one by its name."""

from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules
from types import ModuleType
from typing import TypeVar

from toolaxis.errors import InvalidInput

_Offered = TypeVar("_Offered")


def modules_in(package: ModuleType, inner: str = "") -> Iterator[ModuleType]:
    """The modules of a package, or one of each of its sub-packages.

    Parameters
    ----------
    package : module
    inner : str
        Name of the module to take from each sub-package that has it; empty for the package's own modules.
    """
    for found in iter_modules(package.__path__, f"{package.__name__}."):
        if not inner and not found.ispkg:
            yield import_module(found.name)
        elif inner and found.ispkg and find_spec(f"{found.name}.{inner}") is not None:
            yield import_module(f"{found.name}.{inner}")


def pick(known: Mapping[str, _Offered], kind: str, name: str, *more: str) -> _Offered:
    """The one with a name.

    Parameters
    ----------
    known : mapping
    kind : str
        What it is, for the message: "strategy".
    name : str
    *more : str
        Further names that the caller takes itself.

    Raises
    ------
    InvalidInput
        When there is none.
    """
    if name not in known:
        raise InvalidInput(f"{kind} {name!r} is unknown: use {one_of([*known, *more])}")
    return known[name]


def one_of(names: Iterable[str]) -> str:
    """Names as a choice: "a, b or c".

    Parameters
    ----------
    names : iterable of str
    """
    *most, last = names
    return f"{', '.join(most)} or {last}" if most else last
