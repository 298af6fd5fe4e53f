"""What stands in a document of an operation, as the library's own plan, so that it can be judged."""

import json
from dataclasses import dataclass, replace
from math import pi

from freecad.toolaxis.document.children import child
from freecad.toolaxis.document.passes import read_back
from freecad.toolaxis.document.placement import matrix_of


@dataclass(frozen=True)
class OperationRecord:
    """An operation read out of its document.

    Attributes
    ----------
    path : toolaxis.cldata.toolpath.ToolPath
        From the commands of the Path object, in the document's space.
    matrix : (4, 4) array
        Frame of the plane, in the document's space.
    orientation : toolaxis.plan.orientation.Orientation
    details : dict
        Label and trim loops of the sub-surface.
    number : int
        Of the face.
    """

    path: object
    matrix: object
    orientation: object
    details: dict

    @classmethod
    def of(cls, operation):
        """Read an operation.

        Parameters
        ----------
        operation : App.DocumentObject

        Raises
        ------
        InvalidInput
            When it has no passes.
        """
        from toolaxis.errors import InvalidInput
        from toolaxis.plan.document import orientation_from

        passes = child(operation, "Path::Feature")
        if passes is None or len(passes.Path.Commands) < 2:
            raise InvalidInput(f"'{operation.Label}' has no passes to judge: recompute it first")
        path = read_back(passes, operation.Motions, operation.Starts)
        matrix = matrix_of(passes.Placement)
        found = replace(orientation_from(json.loads(operation.AxisMap)), axis=matrix[:3, 2])
        return cls(path, matrix, found, json.loads(operation.Details))

    def turned(self, placement, face):
        """The same on another blade.

        Parameters
        ----------
        placement : FreeCAD.Placement
            The turn, in the document's space.
        face : int
            Number of the face there.
        """
        turn = matrix_of(placement)
        ways = {name: getattr(self.path, name) @ turn[:3, :3].T for name in ("axis", "normal")}
        places = {name: getattr(self.path, name) @ turn[:3, :3].T + turn[:3, 3] for name in ("cc", "cl")}
        matrix, own = turn @ self.matrix, str(self.details["face"])
        suffix = self.details["label"].removeprefix(own) if self.details["label"].startswith(own) else ""
        return replace(self, path=replace(self.path, **ways, **places), matrix=matrix,
                       orientation=replace(self.orientation, axis=matrix[:3, 2]),
                       details=self.details | {"face": face, "label": f"{face}{suffix}"})

    def plan(self, part, bodies, tool, inputs):
        """The plan with this one operation.

        Parameters
        ----------
        part : toolaxis.shape.part.Part
        bodies : sequence of Part
        tool : toolaxis.tools.tool.Tool
        inputs : toolaxis.plan.plan.PlanInputs
        """
        from toolaxis.plan.operation import Operation
        from toolaxis.plan.plan import Plan

        part = self.joined(part)
        made = Operation(1, self.face(part), tool, self.orientation, self.path, self.frame)
        return Plan(part, (tool,), inputs, (made,), tuple(bodies), self.frame.origin, "complete")

    @property
    def frame(self):
        """The frame of the plane as the library's work coordinate system, in the document's space."""
        from toolaxis.machine.work_coordinates import WorkCoordinates

        m = self.matrix
        return WorkCoordinates(m[:3, 3], m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3])

    def joined(self, part):
        """The part with the faces as one that were machined as one.

        Parameters
        ----------
        part : toolaxis.shape.part.Part
        """
        from toolaxis.skin.join import join

        members = self.details.get("members")
        return join(part, members, corner=pi) if members and not part.face(members[0]).members else part

    def face(self, part):
        """The sub-surface, of the part as `joined` gives it.

        Parameters
        ----------
        part : toolaxis.shape.part.Part
        """
        import numpy as np

        from toolaxis.shape.kinks import split_at_kinks

        whole = part.face(self.details["face"])
        label = self.details["label"]
        face = next((piece for piece in split_at_kinks(whole) if piece.label == label), whole)
        region = self.details["region"]
        return face if region is None else face.trimmed(tuple(np.array(loop) for loop in region), label)
