"""What belongs to an operation: frame, passes, tool and maps; what of it is missing, and what goes with it."""

import FreeCAD
from freecad.toolaxis.document.axis_lines import is_lines
from freecad.toolaxis.document.kinds import is_operation, is_plan, operations_in
from freecad.toolaxis.document.properties import assign
from freecad.toolaxis.document.sub_surface_shape import colour_view, is_shown
from freecad.toolaxis.document.verdict_maps import colour

#: FreeCAD's own coordinate systems, the newer first; documents of either kind are opened in both.
FRAMES = ("Part::LocalCoordinateSystem", "PartDesign::CoordinateSystem")
#: Name of the group that planning makes, at least how it begins.
GROUP = "Orientations"
#: What a placement is called in expressions of objects, and in those of links.
_PLACES = ("Placement", "LinkPlacement")
_FEATURES = ("App::Line", "App::Plane", "App::Point")


def child(operation, kind):
    """The object of a type in an operation; None without one.

    Parameters
    ----------
    operation : App.DocumentObject
    kind : str
    """
    return next((thing for thing in operation.Group if thing.isDerivedFrom(kind)), None)


def frame_of(operation):
    """The work coordinate system of an operation; None without one.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    return next(filter(_is_frame, operation.Group), None)


def _is_frame(thing):
    return thing.TypeId in FRAMES and "Frame" in thing.PropertiesList


def _is_passes(thing):
    return thing.TypeId == "Path::Feature"


def _is_map(thing):
    return thing.TypeId == "Mesh::Feature" and "Deviation" in thing.PropertiesList


def _is_tool(thing):
    return getattr(getattr(thing, "Proxy", None), "Type", "") == "ToolAxisTool"


def belongings(operation):
    """The objects in an operation that it was given here; what a user has put there is not among them.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    kinds = (_is_frame, _is_passes, _is_map, is_shown, is_lines, _is_tool)
    return [thing for thing in operation.Group if any(kind(thing) for kind in kinds)]


def loose(operation):
    """Axes and planes that a work coordinate system left behind, where a FreeCAD opened them but not the system.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    there = (operation.Document.getObject(name) for name in operation.FrameFeatures)
    return [thing for thing in there if thing is not None and thing.TypeId in _FEATURES and not thing.InList]


def missing(operation, without=None):
    """What an operation that was planned does not have any more, sentences.

    Parameters
    ----------
    operation : App.DocumentObject
    without : App.DocumentObject, optional
        An object that is about to be deleted.
    """
    if not operation.Motions:
        return []
    there = [thing for thing in operation.Group if without is None or thing.Name != without.Name]
    reasons = []
    if not any(map(_is_frame, there)):
        reasons.append("its work coordinate system is missing (deleted, or of a kind that this FreeCAD does not know)")
    if not any(map(_is_passes, there)):
        reasons.append("its passes are missing")
    return reasons


def note(operation, without=None):
    """Mark an operation stale for what it does not have any more, at once and without a look at the shapes.

    Parameters
    ----------
    operation : App.DocumentObject
    without : App.DocumentObject, optional
        An object that is about to be deleted.
    """
    new = [reason for reason in missing(operation, without) if reason not in operation.StaleReasons]
    if new:
        _untie(operation, without)
        assign(operation, StaleReasons=[*operation.StaleReasons, *new], Stale=True)


def _untie(operation, without):
    """Let what stood on something that is gone stay where it is, else FreeCAD complains at every recompute."""
    own = [thing for thing in belongings(operation) if without is None or thing.Name != without.Name]
    tied = [] if any(map(_is_frame, own)) else [thing for thing in own if _is_passes(thing)]
    if not any(map(_is_passes, own)):
        tied += [thing for thing in own if not _is_frame(thing) and not is_shown(thing)]
    for thing in tied:
        _let_stand(thing)


def _followers(thing):
    """What follows a part, or what carries it, by an expression; FreeCAD's own list of them has gaps after an undo."""
    found = list(thing.InList)
    if any((is_operation(one) or is_plan(one)) and thing not in one.Group for one in found):
        words = f"{thing.Name}.Placement", f"<<{thing.Label}>>.Placement"
        found += [one for one in thing.Document.Objects
                  if any(word in text for _, text in one.ExpressionEngine for word in words)]
    return [one for one in found if is_shown(one) or _is_frame(one) or "Turn" in one.PropertiesList]


def _let_stand(thing):
    """Let an object stay where it is instead of following another one."""
    for name, _ in list(thing.ExpressionEngine):
        if name.lstrip(".") in _PLACES:
            thing.setExpression(name, None)


class DeletionObserver:
    """Follows all documents: what belongs to an operation goes with it, and what is deleted alone is told.

    Nothing is done while FreeCAD itself undoes or redoes: it brings back, or takes away, what was recorded.

    Attributes
    ----------
    going : set of str
        Names of the operations and plans that are just being deleted, with what belongs to them.
    followers : list
        What is told of operations: `deleted(thing, going)` before one of them, a turned copy of one, or a whole plan is
        deleted.
    """

    def __init__(self):
        self.going, self.followers = set(), []

    def slotDeletedObject(self, thing):
        """Called by FreeCAD before an object is deleted."""
        document = thing.Document
        if document is None or document.Transacting or document.Restoring:
            return
        if is_operation(thing) or is_plan(thing) or "Turn" in thing.PropertiesList:
            for follower in self.followers:
                follower.deleted(thing, self.going)
        if is_operation(thing):
            self._take(document, thing)
            return
        if is_plan(thing):
            self._take_plan(document, thing)
            return
        for one in _followers(thing):
            _let_stand(one)
        for above in thing.InList:
            if is_operation(above) and above.Name not in self.going and thing in above.Group:
                note(above, thing)

    def slotUndoDocument(self, document):
        """Called by FreeCAD after a step was undone."""
        for thing in filter(_is_map, document.Objects):
            colour(thing)
        for thing in filter(is_shown, document.Objects):
            colour_view(thing)

    slotRedoDocument = slotUndoDocument

    def _take(self, document, operation):
        self.going.add(operation.Name)
        try:
            turned = [thing for thing in operation.InList if thing.TypeId == "App::Link"
                      and "Turn" in thing.PropertiesList]
            going = [*turned, *belongings(operation), *loose(operation), *self._empty_group(operation)]
            for name in [thing.Name for thing in going]:
                if document.getObject(name) is not None:
                    document.removeObject(name)
        finally:
            self.going.discard(operation.Name)

    def _take_plan(self, document, plan):
        self.going.add(plan.Name)
        try:
            inner = [thing for thing in plan.Group if thing.TypeId == "App::DocumentObjectGroup"]
            links = [one for group in inner for one in group.Group if one.TypeId == "App::Link"]
            for name in [thing.Name for thing in (*links, *operations_in(plan), *inner)]:
                if document.getObject(name) is not None:
                    document.removeObject(name)
        finally:
            self.going.discard(plan.Name)

    def _empty_group(self, operation):
        """The group of planning, where this was its last operation and it is not deleted itself just now."""
        if not _deleted_alone(operation.Document):
            return []
        return [above for above in operation.InList if above.Name not in self.going
                and ((above.TypeId == "App::DocumentObjectGroup" and above.Name.startswith(GROUP)) or is_plan(above))
                and all(one.Name in self.going for one in above.Group)]


def _deleted_alone(document):
    """Whether the user deletes operations, not what they stand in: FreeCAD then still holds on to that."""
    if not FreeCAD.GuiUp:
        return True
    import FreeCADGui

    chosen = FreeCADGui.Selection.getSelection(document.Name)
    return not any(thing.TypeId != "App::DocumentObjectGroupPython" and hasattr(thing, "Group") for thing in chosen)
