"""The stock of a job, and the comment that says where its programs have their origin."""

import FreeCAD
from freecad.toolaxis.document.placement import matrix_of

#: Distance up to which origins and corners of the stock are the same, mm.
_CLOSE = 1e-6


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
        words = _difference(first, one)
        if words:
            raise InvalidInput(f"'{first.operation.Label}' and '{one.operation.Label}' have different {words}: "
                               "select those that go together, and make the jobs of each kind by themselves")


def _difference(first, one):
    """What of two operations does not go into one job; empty where they have the part's own origin and no stock."""
    if one.inputs.origin != first.inputs.origin:
        return "origins"
    away = FreeCAD.Vector(*(one.matrix[:3, 3] - first.matrix[:3, 3]).tolist()).Length
    if one.inputs.origin and away > _CLOSE:  # the same place of another part
        return "origins"
    boxes = [list(passes.operation.StockCorners) for passes in (first, one)]
    apart = [low.distanceToPoint(high) for low, high in zip(*boxes, strict=False)]
    same = one.inputs.stock_box == first.inputs.stock_box and len(boxes[0]) == len(boxes[1])
    return "" if same and max(apart, default=0.0) <= _CLOSE else "stocks"


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
