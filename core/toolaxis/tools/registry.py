"""All kinds of cutters: the modules of `toolaxis.tools.cutters`, each of which offers one."""

from collections.abc import Mapping
from functools import cache

from toolaxis.plugins import modules_in, pick
from toolaxis.tools import cutters as _package
from toolaxis.tools.cutter import Cutter


@cache
def cutters() -> Mapping[str, Cutter]:
    """The kinds by name, in the order in which they are listed."""
    found: list[Cutter] = [module.CUTTER for module in modules_in(_package)]
    found.sort(key=lambda one: (one.rank, one.name))
    return {one.name: one for one in found}


def cutter_named(kind: str) -> Cutter:
    """The kind with a name.

    Parameters
    ----------
    kind : str

    Raises
    ------
    InvalidInput
        When there is none.
    """
    return pick(cutters(), "tool kind", kind)


def cutter_of_bit(shape: str) -> Cutter | None:
    """The kind as which a tool bit of FreeCAD or a tool of a CAM system's table is read; None for drills and the like.

    Parameters
    ----------
    shape : str
        Such as "Ballend", "ball end mill" or "Ball-nose".
    """
    word = "".join(letter for letter in shape.lower() if letter.isalpha())
    return next((one for one in cutters().values() if word in one.read_from), None)


def short_forms(last: str = "or") -> str:
    """An example of each kind's short form, as a clause.

    Parameters
    ----------
    last : str
        What stands before the last one; a comma where it is empty.
    """
    *most, end = (one.example for one in cutters().values())
    return f"{', '.join(most)}{f' {last} ' if last else ', '}{end}"
