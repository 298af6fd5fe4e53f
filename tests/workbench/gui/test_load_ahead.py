"""The libraries are loaded from when the workbench is chosen, between the events of the window."""

import sys
import threading


def test_the_libraries_are_loaded_before_a_panel_is_opened(desk):
    from freecad.toolaxis.services import background

    desk.wait(lambda: background._load.cache_info().currsize, "the libraries are loaded", 60.0)
    assert "toolaxis.job.planning.pipeline" in sys.modules
    assert not background.load_ahead(), "once is enough"


def test_no_other_thread_imports_what_the_window_may_import_too(desk, monkeypatch):
    # two threads that import one package at a time make Python's import locks fail as deadlocked
    from freecad.toolaxis.services import background

    loaded = []

    def note(library):
        loaded.append((library, threading.current_thread()))

    monkeypatch.setattr(background, "import_module", note)
    background._load.cache_clear()
    work = background.BackgroundWork(lambda _: True).start()
    desk.wait(lambda: not work.running, "the work is done", 60.0)
    window = threading.main_thread()
    assert loaded == [(library, window) for library in (*background._LIBRARIES, background._PICTURES)]


def test_a_computation_goes_on_without_what_only_pictures_need(desk, monkeypatch):
    from freecad.toolaxis.services import background

    def load(library):
        if library == background._PICTURES:
            raise ImportError(library)

    monkeypatch.setattr(background, "import_module", load)
    background._load.cache_clear()
    outcome = []
    work = background.BackgroundWork(lambda _: True)
    work.done.connect(outcome.append)
    work.start()
    desk.wait(lambda: outcome, "the work is done", 60.0)
    assert outcome == [True]
