"""Which faces of a part a rack machines as one: found apart from the document, before anything is computed."""

from freecad.toolaxis.document.read_shapes import ShapesRead, faces_by_number


def skins_task(inputs):
    """The search for the skins of a whole part, as a computation apart from its document.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
        With a rack.

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress`, and returns tuples of (object, "Face7") for each skin of two faces or
        more, narrow planes and cylinders that continue it among them; none where faces are machined by themselves, as
        when not all sculptured ones are chosen.

    Raises
    ------
    InvalidInput
        When a face is not there, or a value is out of range.
    """
    tools, job, source = inputs.tools(), inputs.job(), ShapesRead.of(inputs)
    names = faces_by_number(inputs)

    def compute(progress):
        from toolaxis.job.planning.pipeline import group_faces

        part, _ = source.read(progress)
        if not source.complete(part):
            return ()
        found = group_faces(part, tools, job, inputs.blades, progress)
        return tuple(tuple(names[number] for number in skin) for skin in found)

    return compute
