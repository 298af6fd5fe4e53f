"""What several methods, or numbers of axes, come to: bars of cutting length and links, and a curve."""

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.patches import Patch

from toolaxis.plan.baseline import Baseline, clock
from toolaxis.plan.plan import Option
from toolaxis.report.figures.plots import BLUE, GREY, SKY, VERMILION, figure


def baselines_picture(rows: Sequence[Baseline]) -> Figure:
    """One bar per method: cutting length, and entries, exits and links after it; passes, axes and time beside.

    A method that does not machine every sub-surface has no bar and says so.

    Parameters
    ----------
    rows : sequence of Baseline
        The plan itself first.
    """
    made = figure(9.5, 1.3 + 0.52 * len(rows))
    ax = made.subplots()
    names = [f"{one.shown}\n{one.tool}" for one in rows]
    whole = [one if one.complete else None for one in rows]
    cut = [one.length if one else 0.0 for one in whole]
    links = [one.travel if one else 0.0 for one in whole]
    places = list(range(len(rows)))
    ax.barh(places, cut, color=[VERMILION, *[BLUE] * (len(rows) - 1)], height=0.62)
    ax.barh(places, links, left=cut, color=SKY, height=0.62)
    for place, one in enumerate(rows):
        if one.complete:
            text = (f"{one.length:.0f} mm, {one.passes} passes, {one.orientations} "
                    f"{'axis' if one.orientations == 1 else 'axes'}, {clock(one.seconds)} min")
            ax.annotate(text, (cut[place] + links[place], place), xytext=(5, 0), textcoords="offset points", fontsize=8,
                        verticalalignment="center")
        else:
            ax.annotate(f"no axis for {one.sub_surfaces - one.machined} of {one.sub_surfaces}", (0, place),
                        xytext=(5, 0), textcoords="offset points", fontsize=8, verticalalignment="center", color=GREY)
    ax.set_yticks(places, names, fontsize=8)
    ax.invert_yaxis()
    ax.set_xlim(0, 1.5 * max([a + b for a, b in zip(cut, links, strict=True)], default=1.0) or 1.0)
    ax.set_xlabel("length of the motion, mm")
    ax.set_title("the same faces by other methods", fontsize=10)
    ax.grid(axis="x", alpha=0.25)
    ax.set_axisbelow(True)
    handles = [Patch(color=VERMILION, label="cutting, this plan"), Patch(color=BLUE, label="cutting"),
               Patch(color=SKY, label="entries, exits, links")]
    made.legend(handles=handles, loc="outside lower center", ncol=3, fontsize=8, frameon=False)
    return made


def options_picture(options: Sequence[Option]) -> Figure:
    """Cutting length, or time, against the number of different axes, the chosen one marked.

    Parameters
    ----------
    options : sequence of Option
    """
    made = figure(7.5, 4.6)
    ax = made.subplots()
    timed = all(one.seconds is not None for one in options)
    count, costs = [one.orientations for one in options], [one.seconds or one.length for one in options]
    ax.plot(count, costs, "o-", color=BLUE, markersize=5)
    for one, cost in zip(options, costs, strict=True):
        ax.annotate(f"{one.sub_surfaces}", (one.orientations, cost), textcoords="offset points", xytext=(4, 6),
                    fontsize=8, color=GREY)
        if one.chosen:
            ax.plot(one.orientations, cost, "o", color=VERMILION, markersize=12, fillstyle="none",
                    markeredgewidth=1.8, label="chosen, at the knee")
    ax.plot([], [], linestyle="none", marker="$n$", color=GREY, markersize=6, label="number of sub-surfaces")
    ax.set_xlabel("different tool axes")
    ax.set_ylabel("reckoned time, s" if timed else "reckoned length, mm")
    ax.set_title("cutting, links and rest material against the number of orientations", fontsize=10)
    ax.set_xticks(count)
    ax.set_xlim(count[0] - 0.5, count[-1] + max(0.5, 0.2 * (count[-1] - count[0])))
    ax.margins(y=0.12)
    ax.grid(alpha=0.25)
    ax.legend(frameon=False, fontsize=9)
    return made
