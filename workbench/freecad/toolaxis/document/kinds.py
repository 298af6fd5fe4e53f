"""What stands in the document after planning; nothing here needs a window."""


def _type_of(thing):
    return getattr(getattr(thing, "Proxy", None), "Type", "")


def is_operation(thing):
    """Whether an object is an operation of Tool Axis.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return _type_of(thing) == "ToolAxisOperation"


def is_plan(thing):
    """Whether an object is a whole plan of Tool Axis, with its operations in it.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return _type_of(thing) == "ToolAxisPlan"


def operations_in(group):
    """The operations in a group and in the groups in it, in their order; links to operations are none.

    Parameters
    ----------
    group : App.DocumentObject
    """
    found = []
    for thing in group.Group:
        if is_operation(thing):
            found.append(thing)
        elif thing.TypeId == "App::DocumentObjectGroup":
            found += operations_in(thing)
    return found


def plan_of(operation):
    """The whole plan that an operation belongs to; None where it stands alone.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    for above in operation.InList:
        if is_plan(above) and operation in above.Group:
            return above
        if above.TypeId == "App::DocumentObjectGroup" and operation in above.Group:
            found = plan_of(above)
            if found is not None:
                return found
    return None
