"""A plan in pieces for CAD: each operation's sub-surface, its work coordinate system, and passes and axis in it."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from toolaxis.cad.ocp.export import compound_of, face_shape, frame_location, path_edges, polyline_edge
from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan

#: Length of a drawn tool axis as a share of the diagonal of its sub-surface.
_REACH = 0.4
#: Colours, red, green and blue from 0 to 1, of what is not machined, of passes and of tool axes.
PART, LINES, AXIS = (0.86, 0.86, 0.86), (0.0, 0.28, 0.55), (0.1, 0.1, 0.1)


@dataclass(frozen=True, eq=False)
class OperationShapes:
    """What CAD shows of an operation; shapes are made when they are asked for.

    Attributes
    ----------
    operation : Operation
    """

    operation: Operation

    @property
    def name(self) -> str:
        """Name of the operation."""
        return self.operation.name

    @property
    def surface_name(self) -> str:
        """What its sub-surface is called."""
        return f"{self.name}-surface"

    @cached_property
    def face(self) -> Any:
        """The sub-surface, TopoDS_Face."""
        return face_shape(self.operation.face)

    @property
    def local_face(self) -> Any:
        """The same in work coordinates."""
        frame = self.operation.frame
        assert frame is not None
        return face_shape(self.operation.face.transformed(np.linalg.inv(frame.part_from_work)))

    @property
    def done(self) -> bool:
        """Whether there are passes and a work coordinate system."""
        return self.operation.path is not None and self.operation.frame is not None

    @cached_property
    def location(self) -> Any:
        """Where its work coordinate system stands on the part, TopLoc_Location."""
        assert self.operation.frame is not None
        return frame_location(self.operation.frame)

    def edges(self, *kinds: Motion, local: bool = False) -> list[Any]:
        """Its passes, or motions of other kinds, as edges.

        Parameters
        ----------
        *kinds : Motion
            Cuts unless given.
        local : bool
            In its work coordinates instead of the part's.
        """
        path, frame = self.operation.path, self.operation.frame
        return [] if path is None else path_edges(path, *kinds, frame=frame if local else None)

    def passes(self, *kinds: Motion, local: bool = False) -> Any:
        """Its passes, or motions of other kinds, kind after kind, as one shape, TopoDS_Compound; see `edges`."""
        return compound_of([edge for kind in kinds or (Motion.CUT,) for edge in self.edges(kind, local=local)])

    def axis(self) -> Any:
        """A line along the tool axis over the sub-surface, in work coordinates, TopoDS_Edge."""
        frame = self.operation.frame
        assert frame is not None
        foot, reach = frame.from_part(frame.shown_at)[0], _REACH * self.operation.face.diagonal
        return polyline_edge(foot + np.array([[0.0, 0.0, 0.0], [0.0, 0.0, reach]]))


def pieces(plan: Plan) -> tuple[OperationShapes, ...]:
    """The pieces of a plan, in the order of its operations.

    Parameters
    ----------
    plan : Plan
    """
    return tuple(OperationShapes(op) for op in plan.operations)


def piece_of(plan: Plan, operation: str | int) -> OperationShapes:
    """The piece of one operation that has a work coordinate system.

    Parameters
    ----------
    plan : Plan
    operation : str or int
        Its name, or its number from 1.

    Raises
    ------
    InvalidInput
        When the plan has no such operation, or it has no axis.
    """
    found = [piece for piece in pieces(plan) if operation in (piece.name, piece.operation.number)]
    if not found:
        names = ", ".join(op.name for op in plan.operations[:4]) or "none"
        raise InvalidInput(f"operation {operation!r} does not exist: the plan has {len(plan.operations)} ({names}"
                           f"{', ...' if len(plan.operations) > 4 else ''})")
    if not found[0].done:
        raise InvalidInput(f"operation {found[0].name} has no axis and no work coordinate system: "
                           f"{'; '.join(found[0].operation.orientation.reasons) or 'it was left as rest material'}")
    return found[0]


def rest_of(plan: Plan) -> Any:
    """The faces of the part that no operation machines, as one shape, TopoDS_Compound.

    Parameters
    ----------
    plan : Plan
    """
    machined = {number for op in plan.operations for number in op.face.numbers}
    return compound_of([face_shape(face) for face in plan.part.faces if not machined.intersection(face.numbers)])
