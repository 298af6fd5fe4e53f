"""Blades in the tree: a group for each, with operations in the first, and links to them, turned, in the others."""

import FreeCAD
from freecad.toolaxis.document.placement import carried, placement_from
from freecad.toolaxis.document.properties import Property, assign, ensure
from freecad.toolaxis.document.sub_surface_shape import is_shown
from freecad.toolaxis.document.transaction import remove

translate = FreeCAD.Qt.translate

_BLADE = (Property("Integer", "Blade", "Tool Axis", "Number of the blade", True),)
_LINK = (
    Property("Placement", "Turn", "Tool Axis", "Rotation about the wheel's axis, in the part's own frame", True),
    Property("String", "Face", "Tool Axis", "The face of this blade", True),
    Property("Vector", "Axis", "Result", "Tool axis from tip to spindle, as planned, in document coordinates", True),
    Property("Length", "Gouge", "Result", "Upper bound of the gouge in the machined faces", True),
    Property("String", "Clearance", "Result", "Lower bounds of clearances, proven on this blade", True))
#: Greatest distance of the points of a turned copy from the turned points, mm.
_EXACT = 1e-6
#: Links of which more do not show their passes at first.
_MANY = 24


def turned_copies(operation):
    """The links that show an operation turned to other blades.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    return [thing for thing in operation.Document.Objects if thing.TypeId == "App::Link"
            and "Turn" in thing.PropertiesList and thing.LinkedObject == operation]


def turn_between(source, copy):
    """The rigid motion that brings the path of one operation onto that of another, (4, 4); None where none does.

    Parameters
    ----------
    source, copy : toolaxis.plan.operation.Operation
    """
    import numpy as np

    if source.path is None or copy.path is None or len(source.path.cl) != len(copy.path.cl):
        return None
    here = np.concatenate([source.path.cl, source.path.cl + source.path.axis])
    there = np.concatenate([copy.path.cl, copy.path.cl + copy.path.axis])
    middle, other = here.mean(axis=0), there.mean(axis=0)
    u, _, vt = np.linalg.svd((here - middle).T @ (there - other))
    turn = (vt.T * [1, 1, np.sign(np.linalg.det(vt.T @ u.T))]) @ u.T
    if np.abs((here - middle) @ turn.T + other - there).max() > _EXACT:
        return None
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, other - turn @ middle
    return matrix


def quiet(things):
    """Let links show passes and sub-surfaces alone: tools and work coordinate systems of all blades hide the part.

    Of very many, only the sub-surfaces are shown at first: their ways in rapid traverse hide the part too.

    Parameters
    ----------
    things : sequence of App.DocumentObject
        Links of blades, up to date; others are left as they are.
    """
    links = [one for one in things if one.TypeId == "App::Link" and "Turn" in one.PropertiesList]
    kind = "Path::Feature" if len(links) <= _MANY else ""
    for link in links:
        for thing in () if link.LinkedObject is None else link.LinkedObject.Group:
            if not is_shown(thing) and thing.TypeId != kind:
                link.setElementVisible(thing.Name, False)


class PlanTree:
    """Where the operations of a plan stand in the tree, and the links for those that are turned copies.

    Parameters
    ----------
    document : App.Document
    group : App.DocumentObject
        Of the plan.
    plan : toolaxis.plan.plan.Plan

    Attributes
    ----------
    copies : dict of int to (int, (4, 4) array)
        Turned copies by number: the number of the original, and the turn.
    things : list of App.DocumentObject
        Links and groups that were made or kept.
    """

    def __init__(self, document, group, plan):
        self.document, self.group, self.plan = document, group, plan
        self.copies, self.things = {}, []
        by_number = {op.number: op for op in plan.operations}
        for copy, source in ({} if plan.blades is None else plan.blades.copies).items():
            turn = turn_between(by_number[source], by_number[copy])
            if turn is not None:
                self.copies[copy] = source, turn
            elif not by_number[copy].done and not by_number[source].done:
                self.copies[copy] = source, None  # nothing to be turned: the original says why
        self._groups = {thing.Blade: thing for thing in group.Group if "Blade" in thing.PropertiesList}
        self._used = set()

    def place_of(self, op):
        """The group of an operation: its blade's, or the plan's.

        Parameters
        ----------
        op : toolaxis.plan.operation.Operation
        """
        blade = None if self.plan.blades is None else self.plan.blades.blade_of(op.face.number)
        return self.group if blade is None else self._blade(blade)

    def _blade(self, number):
        self._used.add(number)
        if number not in self._groups:
            made = self.document.addObject("App::DocumentObjectGroup", "Blade")
            ensure(made, _BLADE)
            made.Blade = number
            made.Label = translate("ToolAxis", "Blade {}").format(number)
            self.group.addObject(made)
            self._groups[number] = made
        return self._groups[number]

    def finish(self, made, chain, left):
        """Make the links, and remove what the plan does not have any more.

        Parameters
        ----------
        made : list of App.DocumentObject
            The operations in the order of the plan, copies left out.
        chain : sequence of App.DocumentObject
            What carries the part along, `freecad.toolaxis.document.placement.chain_of`.
        left : list of App.DocumentObject
            Operations that stood there and are none of the plan's.
        """
        of = dict(zip((op.number for op in self.plan.operations if op.number not in self.copies), made, strict=True))
        old = {(thing.LinkedObject.Name if thing.LinkedObject else "", group.Blade): thing
               for group in self._groups.values() for thing in group.Group if thing.TypeId == "App::Link"}
        for op in self.plan.operations:
            source, turn = self.copies.get(op.number, (0, None))
            if turn is None:
                continue
            group = self._blade(self.plan.blades.blade_of(op.face.number))
            link = old.pop((of[source].Name, group.Blade), None) or self._link_operation(of[source], group)
            self._fill(link, op, turn, chain)
            self.things.append(link)
        unused = [thing for number, thing in self._groups.items() if number not in self._used]
        remove([*old.values(), *left])
        remove([thing for thing in unused if not thing.Group])
        self.things += [thing for number, thing in sorted(self._groups.items()) if number in self._used]

    def _link_operation(self, operation, group):
        link = self.document.addObject("App::Link", "Turned")
        link.LinkedObject = operation
        link.LinkTransform = True
        ensure(link, _LINK)
        group.addObject(link)
        return link

    def _fill(self, link, op, turn, chain):
        here = carried(chain)
        assign(link, Turn=here.inverse().multiply(placement_from(turn)).multiply(here), Face=f"Face{op.face.number}",
               Gouge=max(float(op.orientation.gouge), 0.0), Axis=FreeCAD.Vector(*map(float, op.orientation.axis)),
               Clearance=", ".join(f"{name} {value:.3f} mm" for name, value in op.orientation.clearance.items()))
        link.Label = translate("ToolAxis", "Face {} (turned copy)").format(op.face.label)
        names = " * ".join(f"{one.Name}.Placement" for one in chain)
        link.setExpression("Placement", f"{names} * Turn * minvert({names})")
