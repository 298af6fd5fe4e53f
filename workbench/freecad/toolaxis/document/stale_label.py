"""Labels of operations and plans: in the tree they end with a word while the results are stale."""

from freecad.toolaxis.document.properties import Property, assign

#: What every object has whose label can end with that word.
MARK = Property("String", "StaleMark", "Tool Axis", "What the label ends with while the results are stale", True, True)


def plain_label(thing):
    """The label of an object without the word that tells that it is stale.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return thing.Label.removesuffix(getattr(thing, "StaleMark", ""))


def mark_label(thing, word):
    """Let the label of an object end with a word; an empty one takes it away.

    Parameters
    ----------
    thing : App.DocumentObject
    word : str
        As the user reads it, with a space before it.
    """
    label = plain_label(thing)
    assign(thing, StaleMark=word)
    assign(thing, Label=label + word)
