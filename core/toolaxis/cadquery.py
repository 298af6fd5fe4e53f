"""toolaxis in CadQuery: importing this module adds methods to `cadquery.Workplane`; plans come back as its own objects.

    import cadquery as cq
    import toolaxis.cadquery as txq

    part = cq.importers.importStep("freeform.step")
    plan = part.faces("not %PLANE").toolAxes("torus:12x1", scallop=0.05)
    show_object(txq.assembly(plan))

`part.faces(...).toolAxes(tool, scallop, ...)` plans the selected faces as `toolaxis.plan` does, `part.passEdges(plan)`
puts the passes on the stack, and `part.workCoordinates(plan, "op01-face1")` is a workplane at those coordinates.
"""

from typing import Any

import cadquery as cq

from toolaxis.cad.ocp.plan_shapes import AXIS, LINES, PART, OperationShapes, piece_of, pieces, rest_of
from toolaxis.cldata.toolpath import Motion
from toolaxis.job.planning.pipeline import plan as planned
from toolaxis.plan.plan import Plan
from toolaxis.tools.tool import Tool

__all__ = ["assembly", "locations", "passes", "planes", "sub_surfaces"]


def planes(plan: Plan) -> dict[str, cq.Plane]:
    """The work coordinate systems as planes: z along the tool axis, x along the mean feed, at the plan's datum.

    Parameters
    ----------
    plan : Plan

    Returns
    -------
    dict of str to cadquery.Plane
        By the names of the operations that have an axis.
    """
    return {piece.name: _plane(piece) for piece in pieces(plan) if piece.done}


def locations(plan: Plan) -> dict[str, cq.Location]:
    """The work coordinate systems as locations; see `planes`.

    Parameters
    ----------
    plan : Plan
    """
    return {piece.name: cq.Location(piece.location) for piece in pieces(plan) if piece.done}


def passes(plan: Plan, links: bool = False) -> dict[str, cq.Compound]:
    """The passes of each operation, one edge each, in the part's frame.

    Parameters
    ----------
    plan : Plan
    links : bool
        Entries, exits and links too, at the tool's tip.
    """
    kinds = tuple(Motion) if links else (Motion.CUT,)
    return {piece.name: cq.Compound(piece.passes(*kinds))
            for piece in pieces(plan) if piece.done}


def sub_surfaces(plan: Plan) -> dict[str, cq.Face]:
    """The sub-surface of each operation, those without an axis too.

    Parameters
    ----------
    plan : Plan
    """
    return {piece.name: cq.Face(piece.face) for piece in pieces(plan)}


def assembly(plan: Plan, part: "cq.Workplane | cq.Shape | None" = None) -> cq.Assembly:
    """The plan as an assembly to show or to save: part, coloured sub-surfaces, and passes and axes.

    Every operation is a child of its own name that stands at its work coordinate system.

    Parameters
    ----------
    plan : Plan
    part : cadquery.Workplane or Shape, optional
        What is drawn as the part; its faces that are not machined unless given.
    """
    from toolaxis.report.figures.map_colouring import colours_of

    made = cq.Assembly(name="plan")
    made.add(cq.Compound(rest_of(plan)) if part is None else part, name="part", color=cq.Color(*PART))
    colours = colours_of(plan)
    for piece in pieces(plan):
        made.add(cq.Face(piece.face), name=piece.surface_name, color=cq.Color(*colours[piece.operation.number]))
        if piece.done:
            made.add(_operation(piece), name=piece.name, loc=cq.Location(piece.location))
    return made


def _operation(piece: OperationShapes) -> cq.Assembly:
    """Passes and axis of an operation in its work coordinates."""
    made = cq.Assembly(name=piece.name)
    made.add(cq.Compound(piece.passes(local=True)), name="passes", color=cq.Color(*LINES))
    made.add(cq.Edge(piece.axis()), name="axis", color=cq.Color(*AXIS))
    return made


def _plane(piece: OperationShapes) -> cq.Plane:
    frame = piece.operation.frame
    assert frame is not None
    return cq.Plane(*(cq.Vector(*map(float, row)) for row in (frame.origin, frame.x, frame.z)))


def _tool_axes(self: cq.Workplane, tool: "Tool | str", scallop: float, **settings: Any) -> Plan:
    """Plan the selected faces, or all sculptured ones where none are selected.

    Parameters
    ----------
    tool : Tool or str
    scallop : float
        mm
    **settings
        Those of `toolaxis.plan`.
    """
    return planned(self, tool, scallop, **settings)


def _pass_edges(self: cq.Workplane, plan: Plan, operation: "str | int | None" = None) -> cq.Workplane:
    """Put the passes of a plan, or of one of its operations, on the stack as edges.

    Parameters
    ----------
    plan : Plan
    operation : str or int, optional
        Name or number.
    """
    wanted = pieces(plan) if operation is None else (piece_of(plan, operation),)
    return self.newObject([cq.Edge(edge) for piece in wanted for edge in piece.edges()])


def _work_coordinates(self: cq.Workplane, plan: Plan, operation: "str | int") -> cq.Workplane:
    """A workplane at the work coordinate system of an operation, z along its tool axis.

    Parameters
    ----------
    plan : Plan
    operation : str or int
        Name or number.
    """
    made = self.newObject([])
    made.plane = _plane(piece_of(plan, operation))
    return made


for _name, _method in {"toolAxes": _tool_axes, "passEdges": _pass_edges, "workCoordinates": _work_coordinates}.items():
    setattr(cq.Workplane, _name, _method)
