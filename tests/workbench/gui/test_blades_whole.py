"""Whole parts with blades through the panel: the plan in the tree and in sight, and where it is incomplete, why."""

import os
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
#: Part, kind and sizes of the cutter, stick-out, shank and holder (diameter, height), sub-surfaces, blades, outcome.
PARTS = {
    "blisk": (ROOT / "examples" / "blisk.step", "torus", ("10 mm", "1 mm"), "70 mm", (),
              ((20, 0), (20, 40), (50, 40), (50, 80)), 1, 16, "complete"),
    "kj66": (SHARED / "kj66_impeller.step", "tapered", ("2 mm", "1 mm", "3 deg"), "45 mm",
             ((4.6, 0), (4.6, 28), (6, 34), (6, 45)), ((16, 0), (16, 35), (40, 35), (40, 65)), 0, 9, "incomplete")}


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


def outline(desk, table, rows):
    """Type the rows of a shank or holder."""
    table.setRowCount(len(rows))
    for i, row in enumerate(rows):
        for k, value in enumerate(row):
            table.setItem(i, k, desk.widgets.QTableWidgetItem(f"{value} mm"))


@pytest.mark.long
@pytest.mark.parametrize("name", PARTS)
def test_a_part_with_blades_is_planned_whole(desk, name):
    from freecad.toolaxis.objects import is_plan, operations_in

    path, kind, sizes, stickout, shank, holder, regions, blades, outcome = PARTS[name]
    if not path.exists():
        pytest.skip(f"{path} is not there (set TOOLAXIS_SHARED)")
    part = desk.open(path)
    document, pauses = part.Document, Pauses(desk.qt)
    form = desk.start(part)
    form.tabs.setCurrentWidget(form.toolTab)
    form.kind.setCurrentIndex(("torus", "ball", "flat", "tapered").index(kind))
    for field, value in zip((form.diameter, form.corner, form.taper), sizes, strict=False):
        desk.type(field, value)
    desk.type(form.stickout, stickout)
    outline(desk, form.shank, shank)
    outline(desk, form.holder, holder)
    desk.shot(f"80-{name}-tool")
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.1 mm")
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
    desk.down(form, form.message)
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
