"""The stock of a job, and the comment that says where its programs have their origin."""

import FreeCAD
from freecad.toolaxis.document.placement import matrix_of


def place_stock(job, group, frame):
    """Put the stock of the operations into a job, a box along the document's axes whatever the job's own.

    Parameters
    ----------
    job : App.DocumentObject
    group : sequence of freecad.toolaxis.cam.job_setup.Passes
    frame : FreeCAD.Placement
        Of the job, in the document's space.

    Returns
    -------
    bool
        Whether the operations have any: else the stock is left as FreeCAD made it.
    """
    import Path.Main.Stock as Stock

    corners = next((one.operation.StockCorners for one in group if one.operation.StockCorners), None)
    if corners is None:
        return False
    low, high = corners
    former = job.Stock
    stands = frame.inverse().multiply(FreeCAD.Placement(low, FreeCAD.Rotation()))
    job.Stock = Stock.CreateBox(job, high - low, stands)
    job.Stock.Proxy.execute(job.Stock)
    if former is not None:
        job.Document.removeObject(former.Name)
    return True


def check_one_setup(group):
    """Check that the operations of one job have one origin and one stock.

    Parameters
    ----------
    group : sequence of freecad.toolaxis.cam.job_setup.Passes

    Raises
    ------
    InvalidInput
        When two of them differ.
    """
    from toolaxis.errors import InvalidInput

    first = group[0]
    for one in group:
        for name, words in (("origin", "origins"), ("stock_box", "stocks")):
            if getattr(one.inputs, name) != getattr(first.inputs, name):
                raise InvalidInput(f"'{first.operation.Label}' and '{one.operation.Label}' have different {words}: "
                                   "select those that go together, and make the jobs of each kind by themselves")


def origin_comments(one, frame):
    """What a program says of its origin before its first motion; nothing where that is the part's own.

    English, and without brackets inside: controls know no other letters.

    Parameters
    ----------
    one : freecad.toolaxis.cam.job_setup.Passes
    frame : FreeCAD.Placement
        Of the job, in the document's space: its origin is that of the program.

    Returns
    -------
    list of str
    """
    from toolaxis.shape.work_origin import describe_origin

    words = describe_origin(one.inputs.origin)
    if not words:
        return []
    point = " ".join(f"{value + 0.0:.4f}" for value in matrix_of(frame)[:3, 3])
    return [f"(ORIGIN: {words}, in the document at {point})"]
