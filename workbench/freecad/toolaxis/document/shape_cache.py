"""What was found out of the shapes that were looked at last: whole plans ask for it hundreds of times."""

#: The shapes, each with what is known of it, and how many are kept.
_SEEN, _KEPT = [], 6


def known_of(shape):
    """A dictionary for what depends on a shape and on where it stands alone; the same one for the same shape.

    Parameters
    ----------
    shape : Part.Shape
    """
    for one, known in _SEEN:  # holding the shape itself, so that none of another shape has its place in memory
        if one.isPartner(shape) and one.Orientation == shape.Orientation and one.Placement == shape.Placement:
            return known  # `isSame` also asks by which steps it came to stand there
    known = {}
    _SEEN.insert(0, (shape, known))
    del _SEEN[_KEPT:]
    return known
