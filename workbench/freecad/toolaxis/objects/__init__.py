"""What stands in the document after planning; nothing here needs a window."""


def is_operation(thing):
    """Whether an object is an operation of Tool Axis.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return getattr(getattr(thing, "Proxy", None), "Type", "") == "ToolAxisOperation"
