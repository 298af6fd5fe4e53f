"""Time of whole parts with tools chosen together, against the two rules of thumb of a shop.

``python -m benchmarks tool_choice [PART ...] [--tools RACK]``.  The rules, with the same axes, passes, proofs and
rests:

- the largest tool that fits: each face begins with the largest tool of the rack that machines all of it that any tool
  machines, and what is left goes on by the same rule;
- one ball for all: the largest ball of the rack that by itself machines as much as the rack does (`_AS_MUCH`); where
  there is none, the one that machines most.

Before the parts comes a face of 50 x 40 mm whose points another open add-on publishes with its result, 8,102 mm of
passes with a ball D4 at a cusp of 0.02 mm: what the rack and that ball take here.

Times are those of the plan: cuts, links, index moves and tool changes.  A plan that leaves more open is charged for it:
its time is divided by the share of the area that it machines.
"""

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import numpy as np
from scipy.interpolate import make_interp_spline

import toolaxis as ta
from toolaxis.job.planning import rack
from toolaxis.regions.tool_choice import ToolChain, ToolChoice
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

FOLDER = Path(os.environ.get("TOOLAXIS_SHARED", Path(__file__).resolve().parents[2] / "shared")) / "parts"
PARTS = ("tm_featuretype", "linkrods", "ctc05_in", "wing_inv", "nacelle", "iea15blade", "ftc07_in", "kj66_impeller")
#: Share of the area less than which is no difference.
_AS_MUCH = 0.01
#: The tools for the face of 50 x 40 mm, its cusp, mm, and what the other add-on made of it, mm.
_RACK, _CUSP, _PUBLISHED = ("torus:12x2", "ball:8", "ball:6", "ball:4"), 0.02, 8102


class PartTime(NamedTuple):
    """What a plan takes: seconds : s;  share : of the area that it machines;  tools, axes : how many."""

    seconds: float
    share: float
    tools: int
    axes: int

    @property
    def whole(self) -> float:
        """Time for the whole area, s."""
        return self.seconds / max(self.share, 1e-9)

    @property
    def told(self) -> str:
        """In a column of the table."""
        return f"{self.seconds:7.0f} s {100 * self.share:5.1f} % {self.tools:2} tools {self.axes:3} axes"


def time_of(part: Path, tools: Sequence[Tool]) -> PartTime:
    """What the plan of a whole part takes.

    Parameters
    ----------
    part : Path
    tools : sequence of Tool
    """
    made = ta.plan(part, tools, faces="skins")
    account = made.account
    done = [op for op in made.operations if op.done]
    axes = {tuple(round(x, 6) for x in op.orientation.axis) for op in done if op.orientation.axis is not None}
    return PartTime(made.seconds, account.machined / account.area, len({op.tool for op in done}), len(axes))


def published_face() -> Part:
    """The face of 50 x 40 mm: 9 x 9 points, interpolated by a bicubic B-spline.

    Notes
    -----
    z = 20 + 4 sin((x - 10) / 14) cos(y / 16) + 5 exp(-((x - 38)^2 + (y - 12)^2) / 80)
    - 5 exp(-((x - 15)^2 + (y - 27)^2) / 70), freecad-cam-addon 0.210.
    """
    along, across = np.linspace(0, 50, 9), np.linspace(0, 40, 9)
    x, y = np.meshgrid(along, across, indexing="ij")
    height = 20 + 4 * np.sin((x - 10) / 14) * np.cos(y / 16)
    height += 5 * np.exp(-((x - 38) ** 2 + (y - 12) ** 2) / 80) - 5 * np.exp(-((x - 15) ** 2 + (y - 27) ** 2) / 70)
    rows = make_interp_spline(along, np.stack([x, y, height], axis=-1), 3)
    columns = make_interp_spline(across, np.swapaxes(rows.c, 0, 1), 3)
    net = np.swapaxes(columns.c, 0, 1)
    return Part((Face(NurbsSurface.from_points(net, (3, 3), (rows.t, columns.t))),))


def print_published_face() -> None:
    """What that face takes with a rack of a torus and balls, and with the ball D4 alone."""
    part = published_face()
    for tools in (_RACK, _RACK[-1:]):
        made = ta.plan(part, list(tools), _CUSP)
        used = ", ".join(sorted({op.tool.name for op in made.operations if op.done}))
        share = made.account.machined / made.account.area
        print(f"50 x 40 mm face    of {', '.join(tools):32} {used:12} {made.account.length:6.0f} mm "
              f"{made.seconds:5.0f} s {100 * share:5.1f} %   the other add-on: {_PUBLISHED} mm", flush=True)


def largest_that_fits(chains: Sequence[ToolChain]) -> ToolChain:
    """Of the chains of a face that of the largest tool that leaves nothing for others, else the one that leaves least.

    Parameters
    ----------
    chains : sequence of ToolChain
    """
    return min(chains, key=lambda one: (round(one.charge, 9), one.tools))


def choose_largest(chains: Sequence[Sequence[ToolChain]], change: float, most: int | None = None) -> ToolChoice:
    """In place of the choice of tools: the largest one for each face, whatever all take together."""
    chosen = tuple(largest_that_fits(some) for some in chains)
    used = tuple(sorted({tool for one in chosen for tool in one.tools}))
    return ToolChoice(chosen, used, sum(one.seconds for one in chosen) + change * len(used), 0.0)


def _largest_rest(planner: rack.RackPlanner, chains: Sequence[ToolChain]) -> ToolChain | None:
    some = [one for one in chains if one.tools]
    return largest_that_fits(some) if some else None


def with_largest(part: Path, tools: Sequence[Tool]) -> PartTime:
    """What it takes with the largest tool that fits, face by face.

    Parameters
    ----------
    part : Path
    tools : sequence of Tool
    """
    with (patch.object(rack, "choose_tools", choose_largest), patch.object(rack.RackPlanner, "_best_of", _largest_rest),
          patch.object(rack.RackPlanner, "_try_other_tools", lambda *_: None)):
        return time_of(part, tools)


def with_one_ball(part: Path, tools: Sequence[Tool], asked: float) -> tuple[str, PartTime]:
    """The largest ball that machines a share of the area by itself, or the one that machines most: its name, its time.

    Parameters
    ----------
    part : Path
    tools : sequence of Tool
    asked : float
        The share.
    """
    balls = sorted((one for one in tools if one.kind == "ball"), key=lambda one: -one.radius)
    best = ("", PartTime(0.0, 0.0, 0, 0))
    for ball in balls:
        try:
            made = time_of(part, [ball])
        except ta.ToolAxisError:  # it fits nowhere
            continue
        if made.share > best[1].share:
            best = (f"D{2 * ball.radius:g}", made)
        if made.share >= asked - _AS_MUCH:
            break
    return best


def run_with(words: Sequence[str]) -> int:
    """The table of some parts.

    Parameters
    ----------
    words : sequence of str
        Of the command line.
    """
    parser = argparse.ArgumentParser(prog="python -m benchmarks tool_choice",
                                     description=(__doc__ or "").split("\n")[0])
    parser.add_argument("parts", nargs="*", type=Path, metavar="PART")
    parser.add_argument("--tools", metavar="RACK", help="the general one unless given")
    asked = parser.parse_args(words)
    tools = ta.load_tools(asked.tools)
    if not asked.parts:
        print_published_face()
    parts = asked.parts or [file for name in PARTS for file in sorted(FOLDER.glob(f"{name}.st*p"))]
    if not parts:
        print(f"there are no parts in {FOLDER}; TOOLAXIS_SHARED names another place")
    for part in parts:
        ours = time_of(part, tools)
        print(f"{part.stem:18} chosen together    {ours.told}", flush=True)
        largest = with_largest(part, tools)
        print(f"{'':18} largest that fits  {largest.told}   whole area: ours {_saved(ours, largest)}", flush=True)
        name, ball = with_one_ball(part, tools, ours.share)
        print(f"{'':18} ball {name:4} for all  {ball.told}   whole area: ours {_saved(ours, ball)}", flush=True)
    return 0


def _saved(ours: PartTime, other: PartTime) -> str:
    """How much less time ours takes for the whole area."""
    return f"{100 * (1 - ours.whole / other.whole):5.1f} % less"


def main() -> None:
    """The table of eight parts made by others: an hour or two."""
    run_with([])


def short() -> None:
    """The face of 50 x 40 mm alone."""
    print_published_face()
