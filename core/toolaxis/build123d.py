"""toolaxis in build123d: plans as its planes, locations, edges, faces and compounds.

    import build123d as bd
    import toolaxis as ta
    import toolaxis.build123d as txb

    part = bd.import_step("freeform.step")
    plan = ta.plan(part.faces().filter_by(bd.GeomType.BSPLINE), "torus:12x1", scallop=0.05)
    show(part, txb.compound(plan))
"""

import build123d as bd

from toolaxis.cad.ocp.export import compound_of
from toolaxis.cad.ocp.plan_shapes import AXIS, LINES, PART, OperationShapes, pieces, rest_of
from toolaxis.cldata.toolpath import Motion
from toolaxis.plan.plan import Plan

__all__ = ["compound", "locations", "passes", "planes", "sub_surfaces"]


def planes(plan: Plan) -> dict[str, bd.Plane]:
    """The work coordinate systems as planes: z along the tool axis, x along the mean feed, at the plan's datum.

    Parameters
    ----------
    plan : Plan

    Returns
    -------
    dict of str to build123d.Plane
        By the names of the operations that have an axis.
    """
    return {piece.name: _plane(piece) for piece in pieces(plan) if piece.done}


def locations(plan: Plan) -> dict[str, bd.Location]:
    """The work coordinate systems as locations; see `planes`.

    Parameters
    ----------
    plan : Plan
    """
    return {piece.name: bd.Location(piece.location) for piece in pieces(plan) if piece.done}


def passes(plan: Plan, links: bool = False) -> dict[str, bd.Compound]:
    """The passes of each operation, one edge each, in the part's frame; `.edges()` gives them as a ShapeList.

    Parameters
    ----------
    plan : Plan
    links : bool
        Entries, exits and links too, at the tool's tip.
    """
    kinds = tuple(Motion) if links else (Motion.CUT,)
    found = {}
    for piece in pieces(plan):
        if piece.done:
            found[piece.name] = bd.Compound(piece.passes(*kinds), label=piece.name, color=bd.Color(*LINES))
    return found


def sub_surfaces(plan: Plan) -> dict[str, bd.Face]:
    """The sub-surface of each operation, coloured and labelled, those without an axis too.

    Parameters
    ----------
    plan : Plan
    """
    from toolaxis.report.figures.map_colouring import colours_of

    colours = colours_of(plan)
    found = {}
    for piece in pieces(plan):
        colour = bd.Color(*colours[piece.operation.number])
        found[piece.name] = bd.Face(piece.face, label=piece.surface_name, color=colour)
    return found


def compound(plan: Plan, part: "bd.Shape | None" = None) -> bd.Compound:
    """The plan as a labelled and coloured tree to show or to export: part, sub-surfaces, and passes and axes.

    Every operation is a child of its own name that stands at its work coordinate system.

    Parameters
    ----------
    plan : Plan
    part : build123d.Shape, optional
        What is drawn as the part; its faces that are not machined unless given.
    """
    shown = rest_of(plan) if part is None else compound_of([part.wrapped])  # a shape can have one parent only
    body = bd.Compound(shown, label="part", color=bd.Color(*PART))
    operations = [_operation(piece) for piece in pieces(plan) if piece.done]
    return bd.Compound(label="plan", children=[body, *sub_surfaces(plan).values(), *operations])


def _operation(piece: OperationShapes) -> bd.Compound:
    """Passes and axis of an operation, placed at its work coordinate system."""
    lines = bd.Compound(piece.passes(local=True), label="passes", color=bd.Color(*LINES))
    axis = bd.Edge(piece.axis(), label="axis", color=bd.Color(*AXIS))
    made = bd.Compound(label=piece.name, children=[lines, axis])
    made.location = bd.Location(piece.location)
    return made


def _plane(piece: OperationShapes) -> bd.Plane:
    frame = piece.operation.frame
    assert frame is not None
    origin, x, z = (tuple(map(float, row)) for row in (frame.origin, frame.x, frame.z))
    return bd.Plane(origin=origin, x_dir=x, z_dir=z)
