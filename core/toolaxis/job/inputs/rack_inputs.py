"""What is planned with one tool only, and refused where several are given."""

from typing import NamedTuple

from toolaxis.errors import InvalidInput
from toolaxis.plan.choices import DIVIDED


class RackInputs(NamedTuple):
    """What is asked for beside several tools: the method, whether its axis moves, the sub-surfaces of each face, and
    whether each of the others is."""

    method: str
    moves: bool
    regions: int | str | None = None
    orientations: bool = False
    division: bool = False
    compare: bool = False


def check_rack_inputs(asked: RackInputs) -> None:
    """Check that several tools can be planned with what is asked for.

    Parameters
    ----------
    asked : RackInputs

    Raises
    ------
    InvalidInput
        When something is asked for that is planned with one tool.
    """
    other = not asked.moves and asked.method not in DIVIDED
    found = {"a moving axis": asked.moves, f"the method {asked.method}": other,
             "a number of regions": asked.regions not in (None, 1, "auto"),
             "orientations": asked.orientations, "a division by hand": asked.division,
             "a comparison": asked.compare}
    for name, is_asked in found.items():
        if is_asked:
            raise InvalidInput(f"{name} is planned with one tool and several are given: name one tool")
