"""The cutter at a two-point contact, cut across the feed: to scale, and how high its edge is above the face."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import BLUE, GREY, ORANGE, VERMILION, figure
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.two_point.rings import FRONT, MIDDLE, ContactSet, CornerCircles, rings, stand_of

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
    cut = np.flatnonzero(op.path.kind == Motion.CUT)
    some = cut[:: max(len(cut) // _PLACES, 1)]
    found = nearest(op.face, op.path.cc[some])
    on = found.distance < 1e-6
    some, uv = some[on], found.uv[on]
    if not len(some):
        return
    d = op.face.evaluate(uv)
    setting = ContactSet(op.face, op.tool, uv, d.su if op.orientation.feed == "u" else d.sv, plan.inputs.scallop,
                         plan.inputs.allowance_of(op.face), plan.inputs.tolerance)
    stand = stand_of(setting, op.path.cl[some], op.path.axis[some])
    sides = np.abs(rings(setting, stand).sides).max(axis=1)
    best = int(np.argmin(np.where(stand.lift > 0.9 * stand.lift.max(), sides, np.inf)))
    one = setting.rows(np.array([best]))
    ring = rings(one, stand.rows(np.array([best])))
    contacts_picture(one, ring, op.name).savefig(folder / f"{op.name}-contacts.png")


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
    beside, height = (foot - origin) @ frame.left[0], ring.height[0]
    touches = _touching(height[FRONT])
    lean = float(np.degrees(np.arccos(np.clip(ring.axis[0] @ frame.normal[0], -1, 1))))
    made = figure(11.0, 4.6)
    made.suptitle(f"{name}: {setting.tool.name} leaning {lean:.2f}° along the feed, tolerance {setting.tolerance:g} mm"
                  + (f", stock {setting.allowance:g} mm" if setting.allowance else ""))
    _to_scale(made.add_subplot(1, 2, 1), setting, ring, beside[FRONT][touches])
    ax = made.add_subplot(1, 2, 2)
    ax.axhspan(0, 1000 * setting.tolerance, color=ORANGE, alpha=0.25, linewidth=0, label="within the tolerance")
    ax.plot(beside[FRONT], 1000 * height[FRONT], color=BLUE, linewidth=1.6, label="front edge of the cutter")
    ax.axhline(0, color=GREY, linewidth=1.2)
    ax.plot(beside[FRONT][touches], 1000 * height[FRONT][touches], "o", color=VERMILION, label="contact")
    low, high = _strip(beside[FRONT], height[FRONT], setting.tolerance)
    ax.annotate("", (low, 1150 * setting.tolerance), (high, 1150 * setting.tolerance),
                arrowprops={"arrowstyle": "<->", "color": GREY})
    ax.text((low + high) / 2, 1180 * setting.tolerance, f"strip {abs(high - low):.1f} mm", ha="center", va="bottom")
    wide = 0.6 * abs(high - low)
    ax.set(xlim=(-wide + (low + high) / 2, wide + (low + high) / 2),
           ylim=(-400 * setting.tolerance, 2200 * setting.tolerance), xlabel="beside the contact, mm",
           ylabel="height above what is to stay, µm")
    ax.legend(loc="upper center", ncols=3, fontsize=8, frameon=False)
    return made


def _touching(height: Array) -> list[int]:
    """The lowest point of each half of the edge, where it touches: by at most a fifteenth of what lies between them."""
    lows = [int(np.argmin(height[:MIDDLE + 1])), MIDDLE + int(np.argmin(height[MIDDLE:]))]
    room = max(float(height[MIDDLE]) / 15, 5e-4)
    return sorted({k for k in lows if height[k] <= room})


def _strip(beside: Array, height: Array, tolerance: float) -> tuple[float, float]:
    """Ends of the strip within the tolerance around the contact."""
    ends = []
    for order in (range(MIDDLE, -1, -1), range(MIDDLE, len(height))):
        rows = list(order)
        above = height[rows] > tolerance * (1 + 1e-6)
        k = int(np.argmax(above)) if above.any() else len(rows) - 1
        share = (tolerance - height[rows[k - 1]]) / (height[rows[k]] - height[rows[k - 1]]) if k and above[k] else 1.0
        ends.append(float(beside[rows[k - 1]] + share * (beside[rows[k]] - beside[rows[k - 1]])))
    return ends[0], ends[1]


def _to_scale(ax: Axes, setting: ContactSet, ring: CornerCircles, touches: Array) -> None:
    """The section itself: the face along the line under the edge, and the bottom of the cutter seen along the feed."""
    frame, offset = setting.frame, setting.tool.corner_radius
    origin = setting.face.evaluate(setting.uv).point[0]
    foot, normal = setting.face.evaluate(ring.uv[0]).point, setting.face.normal(ring.uv[0])
    edge = foot + (ring.height[0] + setting.offset)[:, None] * normal - offset * normal
    ground = foot + setting.allowance * normal
    rows = np.append(np.arange(len(edge)), 0)
    left, up = frame.left[0], frame.normal[0]
    front = foot[FRONT] - origin
    ax.fill_between(front @ left, front @ up, (front @ up).min() - 6, color=GREY, alpha=0.35, linewidth=0)
    ax.plot((ground[FRONT] - origin) @ left, (ground[FRONT] - origin) @ up, color=GREY, linewidth=1.2)
    bottom = edge[rows] - origin
    ax.fill(bottom @ left, bottom @ up, color=BLUE, alpha=0.25)
    ax.plot(bottom @ left, bottom @ up, color=BLUE, linewidth=1.4)
    at = np.interp(touches, np.sort((foot[FRONT] - origin) @ left),
                   ((ground[FRONT] - origin) @ up)[np.argsort((foot[FRONT] - origin) @ left)])
    ax.plot(touches, at, "o", color=VERMILION)
    ax.set(aspect="equal", xlabel="beside the contact, mm", ylabel="along the normal, mm",
           title="face and bottom of the cutter, seen along the feed")
    ax.title.set_fontsize(9)
