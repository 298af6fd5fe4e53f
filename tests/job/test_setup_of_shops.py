"""The setup sheet and the tables tell what a shop fixed: allowances, step-over, leans, and arcs of lead-in."""

from math import radians

import numpy as np

import toolaxis as ta
from toolaxis.job.output.post import post_plan
from toolaxis.report.html.page_tables import setting_rows
from toolaxis.report.tables import plan_table


def test_all_of_it_stands_on_the_setup_sheet_and_below_the_table() -> None:
    x, y = np.meshgrid(np.linspace(0, 20, 5), np.linspace(0, 16, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.01 * (x - 10) ** 2], axis=-1))
    plan = ta.plan(ta.Part.from_faces([face]), "ball:6", 0.1, machine="mikron-ucp-710", workers=1,
                   least_lean=radians(10), greatest_step_over=0.8, lead=1.5, allowance_on={1: 0.2})
    assert plan.outcome == "complete" and ta.verify(plan).passed
    sheet = next(text for file, text in post_plan(plan, "fanuc", plan.machine).items()
                 if file.startswith("setup"))
    for row in ("| allowance | 0.2 mm on face 1, 0 mm on all others |", "| greatest step-over | 0.8 mm |",
                "| least lean of ball ends | 10 deg from the normal at every contact |",
                "| lead-in and lead-out | arcs of 1.5 mm, straight where not proven free |"):
        assert row in sheet
    below = str(plan_table(plan).caption)
    for line in ("left on purpose: 0.2 mm on face 1", "passes lie 0.8 mm apart at most", "ball ends lean 10 deg",
                 "lead-in and lead-out: arcs of 1.5 mm"):
        assert line in below
    settings = {row[0]: row[1] for row in setting_rows(plan, "").rows}
    assert settings["greatest_step_over"] == "0.8 mm" and settings["lead"] == "1.5 mm"
    assert settings["tolerance least lean"] == "10°" and settings["allowance_on"].startswith("0.2 mm on face 1")
