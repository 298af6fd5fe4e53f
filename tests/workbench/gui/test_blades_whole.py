"""Whole parts with blades through the panel: the plan in the tree and in sight, and where it is incomplete, why."""

import os
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PREPARED = ROOT / os.environ.get("TOOLAXIS_PREPARED", "out/freecad/blades_whole")
#: Part, what is typed or chosen of the tool, sub-surfaces, blades, outcome.
PARTS = {
    "blisk": (ROOT / "examples" / "blisk.step", "typed", 1, 16, "complete"),
    "kj66": (PREPARED / "kj66_impeller.step", "tapered-2x1x3", 0, 9, "incomplete")}
#: Sizes of the cutter and stick-out, and rows of the holder (diameter, height).
SIZES = {"diameter": "10 mm", "corner": "1 mm", "stickout": "70 mm"}
HOLDER = ((20, 0), (20, 40), (50, 40), (50, 80))


class Pauses:
    """How long the window did not answer, between ticks of a timer."""

    def __init__(self, qt):
        self.longest, self.last = 0.0, time.perf_counter()
        self.timer = qt.QTimer()
        self.timer.setInterval(2)
        self.timer.timeout.connect(self.tick)
        self.timer.start()

    def tick(self):
        """Note the time since the last tick."""
        now = time.perf_counter()
        self.longest, self.last = max(self.longest, now - self.last), now

    def taken(self):
        """The longest pause since the last call, s."""
        longest, self.longest = self.longest, 0.0
        return longest


def say(text):
    """Print where FreeCAD does not swallow it."""
    print(text, file=sys.__stdout__, flush=True)


@pytest.mark.long
@pytest.mark.parametrize("name", PARTS)
def test_a_part_with_blades_is_planned_whole(desk, name):
    from freecad.toolaxis.document.kinds import is_plan, operations_in

    path, tool, regions, blades, outcome = PARTS[name]
    if not path.exists():
        pytest.skip(f"{path.name} is one of the parts by others: set TOOLAXIS_SHARED")
    document = desk.open(path).Document
    part, = (thing for thing in document.RootObjects if thing.TypeId in ("App::Part", "Part::Feature"))
    pauses = Pauses(desk.qt)
    form = desk.start(part)
    form.rack.setCurrentIndex(0)
    form.tabs.setCurrentWidget(form.toolTab)
    if tool == "typed":
        form.kind.setCurrentIndex(0)
        for field, value in SIZES.items():
            desk.type(getattr(form, field), value)
        desk.outline(form.holder, HOLDER)
    else:
        form.tool.setCurrentText(tool)
        form.tool.activated.emit(form.tool.currentIndex())
    desk.shot(f"80-{name}-tool")
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.1 mm")
    form.tabs.setCurrentWidget(form.advancedTab)
    if regions:
        form.regions.setCurrentIndex(2)
        form.regionsNumber.setValue(regions)
    desk.pump(0.5)
    desk.shot(f"80-{name}-fields")
    told = {"opening and fields": pauses.taken()}
    begin = time.perf_counter()
    desk.press(form.compute)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the plan is made", 1800.0)
    told["planning"] = pauses.taken()
    say(f"{name}: planned in {time.perf_counter() - begin:.1f} s")
    desk.pump(2.0)
    told["shown"] = pauses.taken()
    desk.shot(f"81-{name}-planned")
    desk.shot(f"82-{name}-message")
    message = form.message.text()
    begin = time.perf_counter()
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    say(f"{name}: put in {time.perf_counter() - begin:.1f} s")
    desk.pump(1.0)
    told["put into the document"] = pauses.taken()
    say(f"{name}: longest pauses, ms: { {what: round(1000 * value) for what, value in told.items()} }")
    plan = next(filter(is_plan, document.Objects))
    assert plan.Outcome == outcome and not plan.Stale
    assert (outcome == "complete") == ("the reasons are on the tab Axis" not in message), message
    groups = [group for group in plan.Group if "Blade" in group.PropertiesList]
    assert len(groups) == blades
    done = [one for one in operations_in(plan) if one.Outcome in ("optimal", "feasible")]
    assert done
    desk.shot(f"83-{name}-tree")
    document.undo()
    desk.pump(0.2)
    assert not [thing for thing in document.Objects if thing.TypeId == "App::Link"], "one undo step takes all back"
