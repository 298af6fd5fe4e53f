"""Make the figures of the manual from the library itself: `make docs`."""

import shutil
import tempfile
from math import cos, radians, sin
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc

import toolaxis as ta
from toolaxis.job.output.pictures import draw_plan
from toolaxis.report.figures.plots import BLUE, GREEN, GREY, ORANGE, VERMILION, figure

HERE = Path(__file__).parent / "figures"
PART = Path(__file__).resolve().parents[2] / "examples" / "freeform.step"
DPI = 110


def arrow(ax: Axes, start: tuple[float, float], way: tuple[float, float], name: str, colour: str) -> None:
    """A named vector."""
    end = (start[0] + way[0], start[1] + way[1])
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.8,
                                            "shrinkA": 0, "shrinkB": 0})
    size = (way[0]**2 + way[1]**2) ** 0.5
    gap = 0.3 + 0.35 * len(name)
    ax.text(end[0] + gap * way[0] / size, end[1] + gap * way[1] / size, name, color=colour, fontsize=12,
            ha="center", va="center", style="italic")


def cutter(ax: Axes, tool: ta.Tool, tip: np.ndarray, lean: float, top: float) -> None:
    """The silhouette of a cutter whose axis leans in the picture's plane."""
    half = tool.profile.polyline(0.01)
    half = np.vstack([half[half[:, 1] < top], [np.interp(top, half[:, 1], half[:, 0]), top]])
    outline = np.vstack([half, (half * [-1, 1])[::-1]])
    turn = np.array([[cos(lean), -sin(lean)], [sin(lean), cos(lean)]])
    rows = outline @ turn + tip
    ax.fill(*rows.T, facecolor="#F5CC59", edgecolor="black", linewidth=0.8, alpha=0.55)


def contact() -> None:
    """The contact frame: feed, normal, left, axis, lead and tilt."""
    made = figure(10.0, 4.2)
    lead_ax, tilt_ax = made.subplots(1, 2)
    tool, lead = ta.Tool.torus(diameter=12, corner_radius=2), radians(25)
    s = np.linspace(-10, 12, 200)
    for ax, along, other, name in ((lead_ax, "f", "left points into the picture", "lead"),
                                   (tilt_ax, "left", "f points out of the picture", "tilt")):
        ax.fill_between(s, -5, 0.006 * s**2, color="#CCCCCC")
        ax.plot(s, 0.006 * s**2, color="black")
        axis, flat = np.array([sin(lead), cos(lead)]), np.array([-cos(lead), sin(lead)])
        # Eq. (1) in the plane: contact at the origin, normal (0, 1).
        tip = np.array([0.0, tool.corner_radius]) + tool.flat_radius * flat - tool.corner_radius * axis
        cutter(ax, tool, tip, lead, 13.0)
        arrow(ax, (0, 0), (0, 8), "n", BLUE)
        arrow(ax, (0, 0), (8, 0), along, GREEN)
        arrow(ax, tuple(tip), tuple(17 * axis), "T", VERMILION)
        ax.add_patch(Arc(tuple(tip), 20, 20, theta1=90 - 25, theta2=90, color=GREY))
        ax.plot([tip[0], tip[0]], [tip[1], tip[1] + 11], color=GREY, linewidth=0.8, linestyle="--")
        ax.text(tip[0] + 2.2, tip[1] + 10.7, name, fontsize=10, color="#444444")
        ax.plot(0, 0, "o", color="black", markersize=4)
        ax.set_title(f"{name}: {other}", fontsize=10)
        ax.set_aspect("equal")
        ax.set_axis_off()
        ax.set_xlim(-11, 13)
        ax.set_ylim(-5, 19)
    made.savefig(HERE / "contact.png", dpi=DPI)


def tool() -> None:
    """Cutter, shank and holder with their measures."""
    made = figure(5.0, 7.5)
    ax = made.subplots()
    one = ta.Tool.torus(diameter=12, corner_radius=2, flute_length=22, stickout=50, shank=[(5, 0), (5, 50)],
                        holder=[(10, 0), (10, 25), (18, 25), (18, 45)])
    cutter(ax, one, np.zeros(2), 0.0, 22.0)
    for name, line in one.outlines.items():
        rows = np.vstack([line, (line * [-1, 1])[::-1]])
        ax.fill(*rows.T, facecolor="#BFBFC7" if name == "shank" else "#8C94A3", edgecolor="black", linewidth=0.8)
        ax.text(0, float(line[:, 1].mean()), name, ha="center", va="center", fontsize=10)
    ax.text(0, 13, "cutter", ha="center", fontsize=10)
    for x, low, high, text in ((26, 0, 50, "stick-out"), (14, 0, 22, "flute length")):
        ax.annotate("", (x, high), (x, low), arrowprops={"arrowstyle": "<->", "color": GREY})
        ax.text(x + 1, (low + high) / 2, text, rotation=90, va="center", fontsize=9)
    for y, low, high, text in ((-4, 0, 4, "R - r"), (-8, 0, 6, "R")):
        ax.annotate("", (high, y), (low, y), arrowprops={"arrowstyle": "<->", "color": GREY})
        ax.text(high + 1, y, text, va="center", fontsize=9)
    ax.plot([0, 0], [-10, 102], color=GREY, linewidth=0.7, linestyle="-.")
    ax.plot(0, 0, "o", color="black", markersize=4)
    ax.text(-1, -3, "tip, z = 0", ha="right", fontsize=9)
    ax.text(-19, 50, "holder z = 0", ha="right", va="center", fontsize=9)
    ax.set_xlim(-38, 34)
    ax.set_aspect("equal")
    ax.set_axis_off()
    made.savefig(HERE / "tool.png", dpi=DPI)


def strip() -> None:
    """What a swept cutter leaves in the section across the feed, strip width and scallop."""
    made = figure(9.5, 4.4)
    ax = made.subplots()
    one, lead, h = ta.Tool.torus(diameter=12, corner_radius=1), radians(10), 0.1
    face = ta.Face.from_bspline([[[x, y, 0.0] for y in (-20, 0, 20, 40)] for x in (-40, 0, 40, 80)])
    axis = [sin(lead), 0, cos(lead)]
    uv = [[0.5, 0.4]]
    left, right = ta.strip_width(face, one, uv, axis, h, feed="u")[0]
    a, r = one.flat_radius, one.corner_radius
    t = np.linspace(-1.2, 1.2, 400)
    q = np.sqrt((a * sin(lead) * np.sin(t)) ** 2 + (a * np.cos(t)) ** 2)
    y = a * np.sin(t) + r * a * sin(lead) * np.sin(t) / q
    z = r + a * sin(lead) * (1 - np.cos(t)) - r * a * np.cos(t) / q
    step = 0.96 * (left + right)
    for k, colour in ((-1, GREY), (0, BLUE), (1, GREY)):
        ax.plot(y + k * step, z, color=colour, linewidth=1.6)
    ax.axhline(0, color="black")
    ax.axhline(h, color=GREY, linewidth=0.8, linestyle="--")
    for low, high, text in ((-right, 0, "right half width"), (0, left, "left half width")):
        ax.annotate("", (high, -0.025), (low, -0.025), arrowprops={"arrowstyle": "<->", "color": BLUE})
        ax.text((low + high) / 2, -0.033, text, ha="center", va="top", fontsize=9, color=BLUE)
    top = float(np.interp(step / 2, y, z))
    ax.annotate("", (step / 2, top), (step / 2, 0), arrowprops={"arrowstyle": "<->", "color": VERMILION})
    ax.text(step / 2, h + 0.012, "scallop", color=VERMILION, fontsize=9, ha="center")
    ax.text(-6.1, h + 0.006, "scallop limit h", fontsize=9, color="#555555")
    ax.text(6.4, -0.02, "surface", fontsize=9, va="top")
    ax.plot(0, 0, "o", color=ORANGE, markersize=6)
    ax.set_xlim(-7.5, 7.5)
    ax.set_ylim(-0.07, 0.3)
    ax.set_xlabel("across the feed, mm (left is positive); 12 mm torus with 1 mm corner, lead 10 degrees")
    ax.set_ylabel("height, mm (enlarged)")
    made.savefig(HERE / "strip.png", dpi=DPI)


def planned() -> None:
    """Pictures of a real plan."""
    made = ta.plan(PART, "torus-12x1", 0.02)
    with tempfile.TemporaryDirectory() as folder:
        draw_plan(made, Path(folder))
        for kind in ("passes", "axes", "widths", "estimate"):
            (source,) = Path(folder).glob(f"*-{kind}.png")
            shutil.copyfile(source, HERE / f"{kind}.png")


if __name__ == "__main__":
    HERE.mkdir(exist_ok=True)
    contact()
    tool()
    strip()
    planned()
