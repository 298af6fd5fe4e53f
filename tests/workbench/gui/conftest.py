"""FreeCAD's main window for the tests that drive it, and pictures of it."""

import importlib.util
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SHOTS = ROOT / "out" / "shots"

if importlib.util.find_spec("FreeCAD") is not None:
    import FreeCAD
    import FreeCADGui


class Leaver:
    """Ends the process at once with the tests' status: the interpreter crashes while a window closes."""

    def __init__(self):
        self.status = 1

    def pytest_sessionfinish(self, exitstatus):
        self.status = int(exitstatus)

    @pytest.hookimpl(trylast=True)
    def pytest_unconfigure(self):
        for stream in (sys.stdout, sys.stderr, sys.__stdout__, sys.__stderr__):
            stream.flush()
        os._exit(self.status)


@pytest.fixture(scope="session", autouse=True)
def window(request):
    """FreeCAD's main window, made unless FreeCAD runs with one already."""
    if not FreeCAD.GuiUp:
        request.config.pluginmanager.register(Leaver(), "toolaxis-leaver")
        FreeCADGui.showMainWindow()
    main = FreeCADGui.getMainWindow()
    main.resize(1400, 900)
    pump()
    return main


@pytest.fixture(autouse=True)
def closed_documents():
    """No document outlives its test."""
    yield
    FreeCADGui.Control.closeDialog()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    pump()


def pump(seconds=0.05):
    """Let Qt work for a while."""
    from PySide import QtWidgets

    end = time.monotonic() + seconds
    while True:
        QtWidgets.QApplication.processEvents()
        if time.monotonic() >= end:
            return
        time.sleep(0.005)


@pytest.fixture(name="pump")
def pump_fixture():
    return pump


@pytest.fixture
def until():
    """Pump until something holds; fails after a limit of seconds."""
    def wait(holds, limit=60.0):
        end = time.monotonic() + limit
        while not holds():
            assert time.monotonic() < end, f"did not happen within {limit:.0f} s"
            pump(0.02)

    return wait


@pytest.fixture
def shot(window):
    """Save a picture of the main window as out/shots/NAME.png, and say where."""
    def save(name):
        SHOTS.mkdir(parents=True, exist_ok=True)
        pump(0.3)
        path = SHOTS / f"{name}.png"
        if not (os.environ.get("DISPLAY") and _rooted(path)):
            window.grab().save(str(path))
        return path

    return save


def _rooted(path):
    """A picture of the whole screen, which has the 3-D view in it; False where there is no tool for it."""
    try:
        return subprocess.run(["import", "-window", "root", str(path)], check=False, timeout=30).returncode == 0
    except (FileNotFoundError, subprocess.TimeoutExpired):
        return False
