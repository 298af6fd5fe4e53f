"""What the hemisphere map shows, as arrays: computed off the GUI thread, drawn by `widget`."""

from dataclasses import dataclass, field

import numpy as np
from freecad.toolaxis.gui.widgets.quantity import fine_text
from freecad.toolaxis.services.messages import shown

from toolaxis.numeric.equal_area import equal_area, from_equal_area
from toolaxis.numeric.vectors import perpendicular
from toolaxis.plan.orientation import REASONS
from toolaxis.report.figures.splat_renderer import mean_direction

#: Pixels along the side of the picture that is computed once.
SIDE = 420
#: Reasons measured as angles; the others are lengths.
_ANGLES = (1, 2, 3)


@dataclass(eq=False)
class AxisPicture:
    """The axes that a search looked at, and which of them each pixel of the disc stands for.

    Attributes
    ----------
    axes : (n, 3) array
    width : (n,) array
        Average strip width by screening, mm; NaN where forbidden.
    passes : (n,) array
        By screening; inf where forbidden.
    reason : (n,) array of int
    amount : (n,) array
        By how much the reason's limit is missed, mm or rad.
    pole, right : (3,) array
        Centre of the map (the mean normal), and the direction of its x.
    nearest : (SIDE, SIDE) array of int
        Row of the nearest axis, -1 off the disc; the first row of pixels is the top.
    marks : dict of str to (k, 3) array
        "chosen", "mean normal", "Roman's rule", "other lobes".
    planned : (float, int) or None
        Strip width, mm, and number of passes as they were made with the chosen axis.
    """

    axes: np.ndarray
    width: np.ndarray
    passes: np.ndarray
    reason: np.ndarray
    amount: np.ndarray
    pole: np.ndarray
    right: np.ndarray
    nearest: np.ndarray
    marks: dict = field(default_factory=dict)
    planned: tuple | None = None

    def mark_chosen(self, found):
        """Mark the axis of an orientation, with what its passes came to; no axis takes the mark away.

        Parameters
        ----------
        found : toolaxis.plan.orientation.Orientation
        """
        self.marks.pop("chosen", None)
        self.planned = None
        if found.axis is not None:
            self.marks["chosen"] = np.atleast_2d(found.axis)
            self.planned = (float(found.average_strip_width), int(found.passes)) if found.passes else None

    @property
    def span(self):
        """Strip widths at the ends of the colour scale, mm."""
        free = self.width[np.isfinite(self.width)]
        if not len(free):
            return 0.0, 1.0
        low, high = float(np.percentile(free, 3)), float(free.max())
        return (low, high) if high > low else (0.9 * low, high)

    @property
    def reasons(self):
        """Codes of the reasons that occur on the disc."""
        return sorted({int(code) for code in self.reason[np.unique(self.nearest[self.nearest >= 0])]} - {0})

    def direction(self, x, y):
        """The axis at a place on the map, (3,), or None off the disc.

        Parameters
        ----------
        x, y : float
            The disc has radius 1; y points up.
        """
        return None if x * x + y * y > 1.0 else from_equal_area([[x, y]], self.pole, self.right)[0]

    def place(self, axes):
        """Places of axes on the map, (k, 2); those behind the border are left out.

        Parameters
        ----------
        axes : (k, 3) array
        """
        places = equal_area(axes, self.pole, self.right)
        return places[np.linalg.norm(places, axis=1) <= 1.0 + 1e-9]

    def row(self, axis):
        """Row of the axis that was looked at nearest to a direction.

        Parameters
        ----------
        axis : (3,) array
        """
        return int(np.argmax(self.axes @ axis))


def missed(code, amount):
    """By how much the limit of a reason is missed, as text in FreeCAD's units; empty where that is not known.

    Parameters
    ----------
    code : int
    amount : float
        mm or rad.
    """
    if not (np.isfinite(amount) and amount > 0):
        return ""
    if code in _ANGLES:
        return f"{np.degrees(amount):.1f}°"
    return fine_text(amount)


def reason_name(code):
    """Why an axis is forbidden, in a few words.

    Parameters
    ----------
    code : int
        Index into `toolaxis.plan.orientation.REASONS`.
    """
    return shown(REASONS[int(code)])


def picture_of(face, found):
    """The picture of a map, with the mean normal marked; None where nothing was looked at.

    Parameters
    ----------
    face : toolaxis.shape.face.Face
    found : toolaxis.plan.orientation.AxisMap or None
    """
    from scipy.spatial import cKDTree

    if found is None or not len(found.axis):
        return None
    pole = mean_direction(face.normal(face.grid(24, 24)))
    right = perpendicular(pole)[0]
    line = (np.arange(SIDE) + 0.5) / SIDE * 2.0 - 1.0
    x, y = np.meshgrid(line, -line)
    flat = np.stack([x.ravel(), y.ravel()], axis=1)
    nearest = cKDTree(found.axis).query(from_equal_area(flat, pole, right))[1]
    nearest = np.where((flat**2).sum(axis=1) <= 1.0, nearest, -1).reshape(SIDE, SIDE)
    free = (found.reason == 0) & np.isfinite(found.length) & (found.length > 0)
    width = np.where(free, face.area / np.where(free, found.length, 1.0), np.nan)
    return AxisPicture(found.axis, width, found.passes, found.reason.astype(int), found.amount, pole, right, nearest,
                       {"mean normal": pole[None]})


def marked(picture, found):
    """The picture with the chosen axis and those of the other lobes marked.

    Parameters
    ----------
    picture : AxisPicture
    found : toolaxis.plan.orientation.Orientation
    """
    lobes = [lobe.axis for lobe in found.lobes if lobe.axis is not None]
    if lobes:
        picture.marks["other lobes"] = np.array(lobes)
    picture.mark_chosen(found)
    return picture


def axis_picture(plan, op, progress):
    """The picture of an operation's map, with all its marks, or None where the search left none.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    op : toolaxis.plan.operation.Operation
    progress : toolaxis.progress.Progress
    """
    from toolaxis.errors import ToolAxisError
    from toolaxis.job.planning.edit_axis import rule_of_thumb

    picture = picture_of(op.face, op.orientation.map)
    if picture is None:
        return None
    try:
        picture.marks["Roman's rule"] = rule_of_thumb(plan, op, progress)[None]
    except ToolAxisError:  # no plane of projection: nothing to mark
        progress.check()
    return marked(picture, op.orientation)
