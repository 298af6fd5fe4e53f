"""The cutter at a two-point contact, cut across the feed: to scale, and how high its edge is above the face."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import BLUE, GREY, ORANGE, VERMILION, figure
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.two_point.rings import FRONT, MIDDLE, SIDES, ContactSet, CornerCircles, rings, stand_of

Array = NDArray[np.float64]

#: Places of a path among which the one with two contacts is chosen.
_PLACES = 200


def draw_contacts(plan: Plan, op: Operation, folder: Path) -> None:
    """Draw the cutter where its strip is about the widest with two contacts, of some places of the path.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    folder : Path
    """
    assert op.path is not None
    cuts = np.flatnonzero(op.path.kind == Motion.CUT)
    some = cuts[:: max(len(cuts) // _PLACES, 1)]
    found = nearest(op.face, op.path.cc[some])
    is_on_face = found.distance < 1e-6
    some, uv = some[is_on_face], found.uv[is_on_face]
    if not len(some):
        return
    d = op.face.evaluate(uv)
    feed = d.su if op.orientation.feed == "u" else d.sv
    contacts = ContactSet(op.face, op.tool, uv, feed, plan.inputs.scallop, plan.inputs.allowance_of(op.face),
                          plan.inputs.tolerance)
    postures = stand_of(contacts, op.path.cl[some], op.path.axis[some])
    # Of the places with about the greatest lift, and with it the widest strip, the one whose sides agree best.
    is_wide = postures.lift > 0.9 * postures.lift.max()
    sides = np.abs(rings(contacts, postures).sides).max(axis=1)
    best = np.array([int(np.argmin(np.where(is_wide, sides, np.inf)))])
    contact = contacts.rows(best)
    ring = rings(contact, postures.rows(best))
    contacts_picture(contact, ring, op.name).savefig(folder / f"{op.name}-contacts.png")


def contacts_picture(setting: ContactSet, ring: CornerCircles, name: str) -> Figure:
    """A section across the feed through one contact, and the height of the cutter's edge over it.

    Parameters
    ----------
    setting : ContactSet
        Of one contact.
    ring : CornerCircles
    name : str
        Of the operation.
    """
    frame = setting.frame
    foot = setting.face.evaluate(ring.uv[0]).point
    origin = setting.face.evaluate(setting.uv).point[0]
    beside = (foot - origin) @ frame.left[0]
    edge = _FrontEdge(beside[FRONT], ring.height[0][FRONT])
    cosine = np.clip(ring.axis[0] @ frame.normal[0], -1, 1)
    lean = float(np.degrees(np.arccos(cosine)))
    stock = f", stock {setting.allowance:g} mm" if setting.allowance else ""
    made = figure(11.0, 4.6)
    made.suptitle(f"{name}: {setting.tool.name} leaning {lean:.2f}° along the feed, "
                  f"tolerance {setting.tolerance:g} mm{stock}")
    touches = _touching(edge.height)
    _to_scale(made.add_subplot(1, 2, 1), setting, ring, edge.beside[touches])
    _draw_heights(made.add_subplot(1, 2, 2), edge, touches, setting.tolerance)
    return made


class _FrontEdge(NamedTuple):
    """The front edge of a cutter across the feed: beside the contact, and above what is to stay, (n,) mm each."""

    beside: Array
    height: Array


def _draw_heights(ax: Axes, edge: _FrontEdge, touches: list[int], tolerance: float) -> None:
    """The height of the edge, with the tolerance and the strip that lies within it."""
    micrometres = 1000 * edge.height
    ax.axhspan(0, 1000 * tolerance, color=ORANGE, alpha=0.25, linewidth=0, label="within the tolerance")
    ax.plot(edge.beside, micrometres, color=BLUE, linewidth=1.6, label="front edge of the cutter")
    ax.axhline(0, color=GREY, linewidth=1.2)
    ax.plot(edge.beside[touches], micrometres[touches], "o", color=VERMILION, label="contact")
    low, high = _strip(edge.beside, edge.height, tolerance)
    middle, width = (low + high) / 2, abs(high - low)
    arrow = 1150 * tolerance
    ax.annotate("", (low, arrow), (high, arrow), arrowprops={"arrowstyle": "<->", "color": GREY})
    ax.text(middle, 1180 * tolerance, f"strip {width:.1f} mm", ha="center", va="bottom")
    ax.set(xlim=(middle - 0.6 * width, middle + 0.6 * width), ylim=(-400 * tolerance, 2200 * tolerance),
           xlabel="beside the contact, mm", ylabel="height above what is to stay, µm")
    ax.legend(loc="upper center", ncols=3, fontsize=8, frameon=False)


def _touching(height: Array) -> list[int]:
    """The lowest point of each half of the edge, where it touches: by at most a fifteenth of what lies between them."""
    lows = [int(np.argmin(height[:MIDDLE + 1])), MIDDLE + int(np.argmin(height[MIDDLE:]))]
    room = max(float(height[MIDDLE]) / 15, 5e-4)
    return sorted({k for k in lows if height[k] <= room})


def _strip(beside: Array, height: Array, tolerance: float) -> tuple[float, float]:
    """Ends of the strip within the tolerance around the contact."""
    backwards, onwards = SIDES
    return (_end_of_strip(beside[backwards], height[backwards], tolerance),
            _end_of_strip(beside[onwards], height[onwards], tolerance))


def _end_of_strip(beside: Array, height: Array, tolerance: float) -> float:
    """Where an edge that sets out from the contact rises above the tolerance; its end where it does not."""
    is_above = height > tolerance * (1 + 1e-6)
    k = int(np.argmax(is_above)) if is_above.any() else len(height) - 1
    share = 1.0
    if k and is_above[k]:
        share = (tolerance - height[k - 1]) / (height[k] - height[k - 1])
    return float(beside[k - 1] + share * (beside[k] - beside[k - 1]))


def _to_scale(ax: Axes, setting: ContactSet, ring: CornerCircles, touches: Array) -> None:
    """The section itself: the face along the line under the edge, and the bottom of the cutter seen along the feed."""
    frame = setting.frame
    origin = setting.face.evaluate(setting.uv).point[0]
    foot = setting.face.evaluate(ring.uv[0]).point
    normal = setting.face.normal(ring.uv[0])
    arc_middles = foot + (ring.height[0] + setting.offset)[:, None] * normal
    edge = arc_middles - setting.tool.corner_radius * normal
    ground = foot[FRONT] + setting.allowance * normal[FRONT]

    def _in_section(points: Array) -> tuple[Array, Array]:
        """Beside the contact and along its normal, mm."""
        relative = points - origin
        return relative @ frame.left[0], relative @ frame.normal[0]

    face_x, face_y = _in_section(foot[FRONT])
    ground_x, ground_y = _in_section(ground)
    bottom_x, bottom_y = _in_section(np.concatenate([edge, edge[:1]]))
    ax.fill_between(face_x, face_y, face_y.min() - 6, color=GREY, alpha=0.35, linewidth=0)
    ax.plot(ground_x, ground_y, color=GREY, linewidth=1.2)
    ax.fill(bottom_x, bottom_y, color=BLUE, alpha=0.25)
    ax.plot(bottom_x, bottom_y, color=BLUE, linewidth=1.4)
    order = np.argsort(face_x)
    contact_y = np.interp(touches, face_x[order], ground_y[order])
    ax.plot(touches, contact_y, "o", color=VERMILION)
    ax.set(aspect="equal", xlabel="beside the contact, mm", ylabel="along the normal, mm",
           title="face and bottom of the cutter, seen along the feed")
    ax.title.set_fontsize(9)
