"""The panels in the dark theme, for looking at: nothing may be cropped or unreadable."""


def test_panels_in_the_dark(desk, wavy):
    part, face = wavy
    form = desk.start(part, face)
    desk.type(form.scallop, "0.05 mm")
    for number, name in enumerate(("job", "tool", "advanced"), 1):
        form.tabs.setCurrentWidget(getattr(form, f"{name}Tab"))
        desk.shot(f"{number}-{name}")
    form.tabs.setCurrentWidget(form.toolTab)
    good = desk.shown(form.corner)
    desk.type(form.corner, "30 mm")
    desk.shot("9-refused")
    desk.type(form.corner, good)
    desk.computed(form)
    chart = form.findChild(desk.widgets.QWidget, "axisMap")
    centre, radius = chart.disc()
    desk.click(chart, centre + desk.qt.QPointF(0.35 * radius, 0.2 * radius))
    desk.wait(lambda: "Trying" not in form.cost.text(), "the axis is tried")
    desk.hover(chart, centre)
    desk.shot("6-tried")
    desk.down(form.results)
    desk.shot("6-tried-below")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    desk.shot("5-objects")
    desk.gui.runCommand("ToolAxis_Verify")
    desk.wait(lambda: desk.form("ToolAxisVerify") is not None, "the panel opens")
    form = desk.form("ToolAxisVerify")
    desk.wait(lambda: form.verify.isEnabled(), "the judge is done")
    desk.pump(0.5)
    desk.shot("30-verified")
