"""What of the faces that were asked for is in no operation of a plan, and why."""

from typing import NamedTuple

#: What was not begun when the plan was stopped, what an operation leaves for smaller tools that were not begun, and
#: what of a face lies under another one as the skin of both is seen.
NOT_BEGUN, REST, HIDDEN = "not_begun", "rest_not_begun", "hidden"


class UnplannedArea(NamedTuple):
    """A face, or some of it, that is in no operation.

    face : int, its number;  label : str;  area : float, mm^2 of it;  whole : bool, whether nothing of the face is in an
    operation;  why : str, one of the words of this module, of which `REST` is area that an operation has and leaves;
    point : tuple of three float, mm, in the middle of what is hidden, empty elsewhere;  beneath : str, label of the
    face that hides it.
    """

    face: int
    label: str
    area: float
    whole: bool
    why: str
    point: tuple[float, ...] = ()
    beneath: str = ""
