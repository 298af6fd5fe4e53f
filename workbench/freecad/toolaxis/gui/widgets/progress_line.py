"""What a panel tells while something is computed: the step, how long already, and how long it may still take."""

from time import monotonic

from freecad.toolaxis.services.messages import line_of
from freecad.toolaxis.services.time_left import TimeLeft
from PySide import QtCore

#: How often it is told how long it goes on, ms.
_CLOCK = 1000


class ProgressLine:
    """Tells of one computation at a time, until another sentence takes its place.

    Parameters
    ----------
    form : QWidget
        With a progress bar `progress`.
    tell : callable
        Takes a sentence.
    listens : callable
        Whether it is still to be told.
    """

    def __init__(self, form, tell, listens):
        self.bar, self.tell, self.listens = form.progress, tell, listens
        self.remaining, self.stage = TimeLeft(0.0), ("", -1.0)
        self.timer = QtCore.QTimer(form)
        self.timer.setInterval(_CLOCK)
        self.timer.timeout.connect(self._show)

    def begin(self, stage):
        """Time runs from now on.

        Parameters
        ----------
        stage : str
            The first step.
        """
        self.remaining = TimeLeft(monotonic())
        self.timer.start()
        self.report(stage, -1.0)

    def report(self, stage, share):
        """Another step, or more of it.

        Parameters
        ----------
        stage : str
        share : float
            0 to 1; negative where it is not known.
        """
        self.stage = stage, share
        if self.listens():
            self.bar.setMaximum(1000 if share > 0 else 0)  # as long as nothing is done, it shows that work goes on
            self.bar.setValue(int(1000 * max(share, 0.0)))
        self._show()

    def _show(self):
        if not self.listens():
            self.timer.stop()
            return
        stage, share = self.stage
        words = self.remaining.words(stage, share, monotonic())
        self.tell(line_of(stage) + (f"\n{words}" if words else ""))
