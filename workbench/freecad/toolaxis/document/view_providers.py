"""How objects of ours get their view providers: the window brings them, and without a window there are none."""

_attaching = []


def bring_views(attach):
    """Let objects that are made from now on look as the window has it.

    Parameters
    ----------
    attach : callable
        Takes an object with its proxy, and gives it its view provider.
    """
    _attaching[:] = [attach]


def attach_view(thing):
    """Give a new object its view provider, where there is a window.

    Parameters
    ----------
    thing : App.DocumentObject
        With its proxy.
    """
    for attach in _attaching:
        attach(thing)
