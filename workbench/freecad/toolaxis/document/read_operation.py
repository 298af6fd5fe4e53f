"""What stands in a document of an operation, as the library's own plan, so that it can be judged."""

import json
from dataclasses import dataclass, replace
from math import inf

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
            raise InvalidInput(f"'{operation.Label}' has no passes to verify: recompute it first")
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
        matrix[:3, 3] = self.matrix[:3, 3]  # all operations have one origin
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
        from toolaxis.plan.plan import Plan

        part = self.joined(part)
        made = self.operation(1, part, tool)
        part = part if inputs.stock == 0 else part.with_stock(inputs.stock, self.stock_faces(part))
        return Plan(part, (tool,), inputs, (made,), tuple(bodies), self.frame.origin, "complete")

    def operation(self, number, part, tool):
        """The operation as the library knows it, with what it leaves.

        Parameters
        ----------
        number : int
        part : toolaxis.shape.part.Part
            As `joined` gives it.
        tool : toolaxis.tools.tool.Tool
        """
        from toolaxis.plan.document import zones_from
        from toolaxis.plan.operation import Operation

        return Operation(number, self.face(part), tool, self.orientation, self.path,
                         None if self.path is None else self.frame, zones_from(self.details.get("zones", ())),
                         unreachable=self.details.get("unreachable", 0.0))

    def stock_faces(self, part):
        """Numbers of the faces that had stock when the operation was planned.

        Parameters
        ----------
        part : toolaxis.shape.part.Part
            As `joined` gives it.
        """
        return set(self.details.get("stock_faces", ())) | set(part.face(self.details["face"]).numbers)

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
        return join(part, members, inf, inf) if members and not part.face(members[0]).members else part

    def face(self, part):
        """The sub-surface, of the part as `joined` gives it.

        Parameters
        ----------
        part : toolaxis.shape.part.Part
        """
        from toolaxis.plan.document import sub_surface_from

        return sub_surface_from(part, self.details["face"], self.details["label"], self.details["region"])
