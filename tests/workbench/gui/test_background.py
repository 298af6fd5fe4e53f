"""Work off the GUI thread: one outcome, on the GUI thread, whatever the computation does."""

import gc
import sys
import threading
import time
import weakref

import pytest


class Ears:
    """Hears what a work tells, and on which thread."""

    def __init__(self, work):
        self.heard, self.stages, self.threads = [], [], set()
        work.done.connect(lambda result: self.hear("done", result))
        work.failed.connect(lambda text: self.hear("failed", text))
        work.cancelled.connect(lambda: self.hear("cancelled", None))
        work.progressed.connect(lambda stage, share: self.stages.append((stage, share)))

    def hear(self, *what):
        self.heard.append(what)
        self.threads.add(threading.current_thread())


def patient(progress):
    """Works for a long while, and looks often whether to stop."""
    for k in range(2000):
        progress.report("stage", k, 2000)
        time.sleep(0.005)
    return "done"


def started(compute):
    from freecad.toolaxis.services.background import BackgroundWork

    work = BackgroundWork(compute)
    return work, Ears(work.start())


@pytest.fixture
def unsettled(desk):
    """The collector as it is before modules are left alone for good."""
    from freecad.toolaxis.services import background

    background._settled.clear()
    gc.unfreeze()


def test_a_result_arrives_once_on_the_gui_thread(desk):
    from freecad.toolaxis.services.background import BackgroundWork

    worked_in = []
    work = BackgroundWork(lambda progress: worked_in.append(threading.current_thread()) or 42)
    ears = Ears(work)
    work.start()
    assert work.running
    desk.wait(lambda: ears.heard, "the result arrives")
    desk.pump(0.3)
    assert ears.heard == [("done", 42)] and not work.running
    assert ears.threads == {threading.main_thread()} and worked_in[0] is not threading.main_thread()


def test_stages_are_told_but_not_each_report(desk):
    work, ears = started(patient)
    desk.wait(lambda: ears.stages, "a stage is told")
    desk.pump(0.8)
    work.cancel()
    desk.wait(lambda: ears.heard, "it stops")
    assert ears.heard == [("cancelled", None)]
    assert 1 <= len(ears.stages) < 150 and all(0 <= share <= 1 for _, share in ears.stages)


def test_intermediate_results_are_digested_off_the_gui_thread(desk):
    from freecad.toolaxis.services.background import BackgroundWork

    def compute(progress):
        for k in range(400):
            progress.offer(lambda k=k: k)
            time.sleep(0.005)
        return "done"

    digested, seen = [], []
    work = BackgroundWork(compute, None, lambda offered: digested.append(threading.current_thread())
                          or f"got {offered}")
    ears = Ears(work)
    work.interim.connect(seen.append)
    begin = time.monotonic()
    work.start()
    desk.wait(lambda: ears.heard, "the result arrives")
    assert 1 <= len(seen) <= 2 + (time.monotonic() - begin) / 0.3 and seen[0].startswith("got ")
    assert threading.main_thread() not in digested


@pytest.mark.parametrize(("reason", "words"), [
    (ValueError("odd"), "please report it"), (MemoryError(), "memory"), (ImportError("No module named x"), "Addon")])
def test_errors_are_sentences(desk, reason, words):
    def compute(progress):
        raise reason

    _, ears = started(compute)
    desk.wait(lambda: ears.heard, "it fails")
    assert ears.heard[0][0] == "failed" and words in ears.heard[0][1]


def test_an_error_inside_the_add_on_is_offered_to_copy(desk):
    def compute(progress):
        raise ValueError("odd")

    _, ears = started(compute)
    desk.wait(lambda: ears.heard, "it fails")
    box = next(one for one in desk.children(desk.widgets.QMessageBox) if one.isVisible())
    desk.press(next(button for button in box.buttons() if button.text().replace("&", "") == "Copy details"))
    copied = desk.app.clipboard().text()
    assert "toolaxis 0.1" in copied and "FreeCAD" in copied and "ValueError: odd" in copied
    assert ears.heard[0][1] in copied and box.isVisible()
    desk.shot("30-error-offered")
    box.close()


def test_an_error_of_the_library_is_its_own_sentence(desk):
    def compute(progress):
        from toolaxis.errors import InvalidInput

        raise InvalidInput("scallop is 0 mm:\n it must be above zero.")

    _, ears = started(compute)
    desk.wait(lambda: ears.heard, "it fails")
    assert ears.heard == [("failed", "scallop is 0 mm: it must be above zero")]


def test_nothing_is_heard_after_leaving_and_nothing_crashes_when_all_is_forgotten(desk):
    work, ears = started(patient)
    desk.pump(0.1)
    work.leave()
    del work
    gc.collect()
    desk.pump(0.5)
    assert ears.heard == []
    from freecad.toolaxis.services import background

    desk.wait(lambda: not background._running, "the thread is let go")


class Cycle:
    """What only the collector ends."""

    def __init__(self):
        self.itself = self


def test_what_was_closed_is_let_go_while_something_is_computed(desk, unsettled):
    from freecad.toolaxis.services import background

    gone = weakref.ref(Cycle())
    work, _ = started(patient)
    gc.collect()
    assert gone() is not None, "set aside"
    background.clear_away()
    assert gone() is None and gc.get_freeze_count() > 0
    work.cancel()
    desk.wait(lambda: not background._running, "it ends")


@pytest.mark.parametrize("end", ["cancel", "leave"])
def test_nothing_holds_the_window_up_while_computing_and_all_is_as_before_afterwards(desk, unsettled, end):
    """A full collection over all objects of FreeCAD and the libraries takes more than 0.1 s."""
    from freecad.toolaxis.services import background

    assert gc.get_freeze_count() == 0
    usual, first = sys.getswitchinterval(), started(patient)
    second = started(patient)[0]
    desk.wait(lambda: first[1].stages, "it computes")
    looked_at = len(gc.get_objects())
    assert gc.get_freeze_count() > 10 * looked_at and gc.isenabled() and sys.getswitchinterval() < usual
    getattr(first[0], end)()
    desk.wait(lambda: len(background._running) == 1, "one has ended")
    assert gc.get_freeze_count() > 0 and sys.getswitchinterval() < usual, "the other one still computes"
    getattr(second, end)()
    desk.wait(lambda: not background._running, "the other one has ended")
    assert gc.get_freeze_count() == 0 and sys.getswitchinterval() == usual


def test_modules_are_left_alone_for_good_and_panels_never(desk, wavy, unsettled):
    """Else the opening of each panel takes as long as a full collection.  That closed panels are gone says `desk`."""
    from freecad.toolaxis.services import background

    def opened():
        gone = weakref.ref(Cycle())
        desk.start(*wavy)
        assert gone() is None, "collected before the panel is made"
        return background._settled.is_set()

    background._load()
    work, _ = started(patient)
    assert not opened(), "something is computed"
    desk.gui.Control.closeDialog()
    work.leave()
    desk.wait(lambda: not background._running, "the thread is let go")
    desk.pump(0.1)
    window = Cycle()
    background.note_window(window)
    assert not opened(), "a window is open"
    desk.gui.Control.closeDialog()
    desk.pump(0.1)
    del window
    assert opened() and gc.get_freeze_count() > 10 * len(gc.get_objects())
    desk.gui.Control.closeDialog()
    work, _ = started(patient)
    work.leave()
    desk.wait(lambda: not background._running, "the thread is let go")
    assert gc.get_freeze_count() > 10 * len(gc.get_objects()), "after a computation too"


def test_the_end_of_the_application_waits_for_what_stops(desk):
    from freecad.toolaxis.services import background

    _, ears = started(patient)
    desk.pump(0.1)
    background.stop_all()
    desk.wait(lambda: ears.heard, "it stops")
    assert ears.heard == [("cancelled", None)]
