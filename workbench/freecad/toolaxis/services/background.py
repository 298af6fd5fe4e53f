"""Work off the GUI thread: one computation in a QThread, with progress by stage, cancel, and errors as sentences.

The worker writes plain attributes and the GUI thread reads them by a timer, so that the event loop is not flooded,
however often a computation reports.  Everything that the panel hears, it hears on the GUI thread.

A full collection over all objects of FreeCAD and of the libraries holds the interpreter, and the window with it, for
more than 0.1 s.  So Python's collector leaves alone what was there before while something is computed, and for good
what was there when the libraries were loaded and no panel was open.  The interpreter also changes hands more often
while something is computed, since the window asks for it several times in drawing one picture.

The libraries are loaded on the GUI thread, one after the other with the event loop between them.  Where two threads
import one package at a time, Python may take it for a deadlock, and one of the imports fails.
"""

import gc
import re
import sys
import traceback
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib import import_module
from threading import Event
from time import monotonic
from typing import Any
from weakref import ref

import FreeCAD
from freecad.toolaxis.services.messages import shown
from PySide import QtCore

#: Interval at which progress is read, ms.
_TICK = 150
#: Least time between intermediate results, s.
_PACE = 0.4
#: How long the end of the application waits for a computation that was told to stop, ms.
_PATIENCE = 3000
#: How long a computation keeps the interpreter from the window that waits for it, and what it is without one, s.
_TURN, _USUAL_TURN = 0.001, sys.getswitchinterval()

#: What computations need, in steps of less than half a second each, and the pause between two steps, ms.
_LIBRARIES = ("numpy", "scipy.special", "scipy.spatial", "scipy.stats", "numba", "toolaxis.search.fixed_axis",
              "toolaxis.job.planning.pipeline", "toolaxis.job.planning.edit_axis")
_PAUSE = 30
#: What only pictures need: without it everything else goes on.
_PICTURES = "matplotlib.figure"

#: Who hears of errors inside the add-on: callables that take the sentence and where it came from.
_hearers: list[Callable[[str, str], Any]] = []
#: Panels and windows of pictures as long as anything holds them.
_windows: list[ref] = []
#: Set when what was there before the first panel after the libraries were loaded is left alone for good.
_settled = Event()
#: Threads that have not ended, whoever started them: a QThread must not be destroyed before its end.
_running: set["_Thread"] = set()


class _Thread(QtCore.QThread):
    """Runs a callable(progress); its outcome stays in attributes."""

    def __init__(self, compute: Callable[[Any], Any], digest: Callable[[Any], Any] | None,
                 digest_piece: Callable[[Any], Any] | None) -> None:
        super().__init__()
        self.compute, self.digest, self.digest_piece = compute, digest, digest_piece
        self.interim: Any = None
        self.pieces: deque[Any] = deque()
        self.taken = -_PACE
        self.stop = Event()
        self.latest: tuple[str, float, float] | None = None
        self.result: Any = None
        self.message = self.trace = ""
        self.stopped = False

    def run(self) -> None:
        """Compute; called in the thread."""
        try:
            _load()
            from toolaxis.advice import LARGER_SCALLOP
            from toolaxis.errors import Cancelled, ToolAxisError
            from toolaxis.progress import Progress
        except ImportError as reason:
            self.message = f"{reason}: install what is missing by the Addon Manager"
            return
        try:
            offered = None if self.digest is None else self._offered
            handed = None if self.digest_piece is None else self._queue_piece
            self.result = self.compute(Progress(self._report, self.stop.is_set, offered, handed))
        except Cancelled:
            self.stopped = True
        except ToolAxisError as reason:
            self.message = one_line(reason)
        except ImportError as reason:
            self.message = f"{reason}: install what is missing by the Addon Manager"
        except MemoryError:
            self.message = f"the computer's memory does not suffice: choose {LARGER_SCALLOP} or fewer faces"
        except Exception as reason:  # our own bug: the panel says so, the traceback is for the report
            self.message = f"an error inside Tool Axis ({type(reason).__name__}: {one_line(reason)}); please report it"
            self.trace = traceback.format_exc()

    def _report(self, stage: str, done: float, total: float) -> None:
        self.latest = (stage, done, total)

    def _offered(self, make: Callable[[], Any]) -> None:
        if monotonic() - self.taken > _PACE and self.digest is not None:
            digested = self.digest(make())
            if digested is not None:
                self.interim, self.taken = digested, monotonic()

    def _queue_piece(self, piece: Any) -> None:
        if self.digest_piece is None:
            return
        try:
            self.pieces.append(self.digest_piece(piece))
        except Exception:  # what cannot be shown costs no plan
            FreeCAD.Console.PrintLog(traceback.format_exc())


@cache
def _load() -> None:
    """Load the libraries that computations need; the collector does not look at them while one runs."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        for library in _LIBRARIES:
            import_module(library)
        with suppress(ImportError):
            import_module(_PICTURES)
    finally:
        if collecting:
            gc.enable()
    _set_aside()


def _set_aside() -> None:
    """Let the collector leave alone what is there, while something is computed."""
    if not _settled.is_set():
        gc.freeze()


def _take_back() -> None:
    """Let the collector look again at what was set aside."""
    if not _settled.is_set():
        gc.unfreeze()


def clear_away() -> None:
    """Collect what nobody holds any more, also what was set aside while something is computed.

    Panels that were closed leave Python objects of widgets behind, which the bindings hand out again for a new widget
    that lies at a dead one's address; collected later, they would take the new one for dead.
    """
    _take_back()
    gc.collect()
    if _running:
        _set_aside()


def clear_for_window() -> None:
    """Collect what nobody holds any more before a panel is made.

    Most of a collection's time goes to modules, which stay.  Once these are loaded, at a time when no panel is there
    whose widgets would never be collected, the collector leaves them alone for good.
    """
    clear_away()
    if _load.cache_info().currsize and not _running and not any(window() is not None for window in _windows):
        gc.freeze()
        _settled.set()


def note_window(window: Any) -> None:
    """Know a panel, or a window of pictures, as long as anything holds it.

    Parameters
    ----------
    window : Panel or QWidget
    """
    _windows[:] = [known for known in _windows if known() is not None]
    _windows.append(ref(window))


def hear_errors(hearer: Callable[[str, str], Any]) -> None:
    """Have a callable hear of every error inside the add-on, on the GUI thread.

    Parameters
    ----------
    hearer : callable
        Takes the sentence that the panel shows, and where the error came from.
    """
    if hearer not in _hearers:
        _hearers.append(hearer)


def tell_error(message: str, trace: str) -> None:
    """Let those who hear of errors know of one; the log has it too.

    Parameters
    ----------
    message, trace : str
    """
    FreeCAD.Console.PrintLog(trace)
    for hearer in _hearers:
        hearer(message, trace)


def sentence(reason: BaseException) -> str:
    """An error as the user reads it, one line without a stop at its end.

    Parameters
    ----------
    reason : BaseException
    """
    return shown(one_line(reason))


def one_line(reason: BaseException) -> str:
    """An error in its own words, one line without a stop at its end.

    Parameters
    ----------
    reason : BaseException
    """
    text = re.sub(r"(?<!\S)--(?=[a-z])", "", " ".join(str(reason).split()))  # options of the command have fields here
    return (text or type(reason).__name__).rstrip(".")


class BackgroundWork(QtCore.QObject):
    """One computation off the GUI thread.

    Exactly one of `done`, `failed` and `cancelled` is emitted, on the GUI thread, unless the work is left alone.

    Parameters
    ----------
    compute : callable
        Called with a `toolaxis.progress.Progress` in another thread; it must touch no document and no widget.
    parent : QObject, optional
    digest : callable, optional
        Makes of an intermediate result, in the other thread, what `interim` is emitted with; None for nothing yet.
    digest_piece : callable, optional
        Makes of a part of the result, in the other thread, what `pieces` is emitted with.
    """

    progressed = QtCore.Signal(str, float)
    """Stage, and the share that is done, 0 to 1; negative where it is not known."""
    interim = QtCore.Signal(object)
    """An intermediate result, digested."""
    pieces = QtCore.Signal(object)
    """Parts of the result that came in since the last time, digested: a list."""
    done = QtCore.Signal(object)
    """What the callable returned."""
    failed = QtCore.Signal(str)
    """Why it could not be done, one sentence."""
    cancelled = QtCore.Signal()

    def __init__(self, compute: Callable[[Any], Any], parent: QtCore.QObject | None = None,
                 digest: Callable[[Any], Any] | None = None,
                 digest_piece: Callable[[Any], Any] | None = None) -> None:
        super().__init__(parent)
        self._thread = _Thread(compute, digest, digest_piece)
        self._thread.finished.connect(self._ended)
        self._timer = QtCore.QTimer(self)
        self._timer.setInterval(_TICK)
        self._timer.timeout.connect(self._tick)
        self._told: tuple[str, float, float] | None = None
        self.running = False

    @property
    def message(self) -> str:
        """Why it could not be done, in the program's own words; empty where it was not refused."""
        return self._thread.message

    def start(self) -> "BackgroundWork":
        """Begin; returns at once where the libraries are loaded."""
        with suppress(ImportError):  # the thread tells it
            _load()
        _running.add(self._thread)
        self._thread.finished.connect(_keeper().sweep)
        self.running = True
        self._timer.start()
        _set_aside()
        sys.setswitchinterval(_TURN)
        self._thread.start(QtCore.QThread.LowPriority)
        return self

    def cancel(self) -> None:
        """Ask to stop; `cancelled` follows when the computation has noticed."""
        self._thread.stop.set()

    def leave(self) -> None:
        """Ask to stop and never emit anything again: whoever listened is gone."""
        self.cancel()
        self.running = False
        self._timer.stop()
        with suppress(RuntimeError):
            self._thread.finished.disconnect(self._ended)

    def _tick(self) -> None:
        interim, self._thread.interim = self._thread.interim, None
        if interim is not None:
            self.interim.emit(interim)
        waiting = self._thread.pieces
        if waiting:
            self.pieces.emit([waiting.popleft() for _ in range(len(waiting))])
        latest = self._thread.latest
        if latest is None or latest == self._told:
            return
        self._told = latest
        stage, done, total = latest
        self.progressed.emit(stage, min(max(done / total, 0.0), 1.0) if total > 0 else -1.0)

    def _ended(self) -> None:
        self._timer.stop()
        self.running = False
        thread = self._thread
        if thread.message:
            self.failed.emit(shown(thread.message))
            if thread.trace:
                tell_error(thread.message, thread.trace)
        elif thread.stopped or (thread.result is None and thread.stop.is_set()):
            self.cancelled.emit()
        else:
            self.done.emit(thread.result)


def load_ahead() -> bool:
    """Load the libraries that computations need, once, between the events of the window; whether that begins now."""
    if _load.cache_info().currsize or _loader.cache_info().currsize:
        return False
    _loader().start()
    return True


class _Loader(QtCore.QObject):
    """Loads one library at a time from a timer."""

    def __init__(self) -> None:
        super().__init__()
        self._left = [*_LIBRARIES, _PICTURES]
        self._timer = QtCore.QTimer(self)
        self._timer.setInterval(_PAUSE)
        self._timer.timeout.connect(self._load_next)

    def start(self) -> None:
        """Begin with the next turn of the event loop."""
        self._timer.start()

    def _load_next(self) -> None:
        with suppress(ImportError):  # told when something is computed
            if self._left and not _load.cache_info().currsize:
                import_module(self._left.pop(0))
            else:
                self._timer.stop()
                _load()


@cache
def _loader() -> _Loader:
    return _Loader()


class _Keeper(QtCore.QObject):
    """Lets go of threads that have ended, on the GUI thread, and stops the others when the application ends."""

    def sweep(self) -> None:
        """Let go of threads that have ended, and after the last one of what they needed of the interpreter."""
        for thread in [thread for thread in _running if thread.isFinished()]:
            thread.wait()
            _running.discard(thread)
        if not _running:
            _take_back()
            sys.setswitchinterval(_USUAL_TURN)


@cache
def _keeper() -> _Keeper:
    keeper = _Keeper()
    QtCore.QCoreApplication.instance().aboutToQuit.connect(stop_all)
    return keeper


def stop_all() -> None:
    """Ask every computation to stop and wait for it a little, together a few seconds."""
    for thread in tuple(_running):
        thread.stop.set()
    clock = QtCore.QElapsedTimer()
    clock.start()
    for thread in tuple(_running):
        thread.wait(max(1, _PATIENCE - clock.elapsed()))
