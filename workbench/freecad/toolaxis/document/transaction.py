"""One undo step for a change of a document, or no change at all."""

from contextlib import contextmanager, suppress


@contextmanager
def one_step(document, name):
    """Make what the block does one undo step; when it fails, nothing of it stays, with undo or without.

    Parameters
    ----------
    document : App.Document
    name : str
        Of the step, as the menu shows it.
    """
    before = {thing.Name for thing in document.Objects}
    document.openTransaction(name)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        for thing in [one.Name for one in document.Objects if one.Name not in before]:
            with suppress(Exception):  # removed with its parent
                document.removeObject(thing)
        raise
    document.commitTransaction()


def remove(things):
    """Remove objects with all that stands in them.

    Parameters
    ----------
    things : sequence of App.DocumentObject
    """
    for thing in things:
        remove(list(getattr(thing, "Group", ()) if hasattr(thing, "addObject") else ()))
        thing.Document.removeObject(thing.Name)
