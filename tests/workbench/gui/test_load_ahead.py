"""The libraries are loaded from when the workbench is chosen, beside the window."""

import sys


def test_the_libraries_are_loaded_before_a_panel_is_opened(desk):
    desk.wait(lambda: "toolaxis.job.planning.pipeline" in sys.modules, "the libraries are loaded", 60.0)
    from freecad.toolaxis.services import background

    desk.wait(lambda: not background._running, "the thread has ended", 60.0)
    assert not background.load_ahead(), "once is enough"
