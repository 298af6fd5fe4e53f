"""How long a computation goes on and may still take, told from what it reports; needs no window."""

import FreeCAD

from toolaxis import progress

translate = FreeCAD.Qt.translate

#: Nothing is said before so many seconds.
_SOON = 5.0
#: What is left is told in steps of so many seconds.
_STEP = 5


class TimeLeft:
    """Hears the reports of one computation.

    Parameters
    ----------
    now : float
        When it begins, s.
    """

    def __init__(self, now):
        self.begun, self.known = now, progress.Remaining()
        self.reported = None

    def words(self, stage, share, now):
        """How long it goes on, and how long pieces of work, or else the step, may still take; empty at first.

        As long as no piece is done, only the step is known.

        Parameters
        ----------
        stage : str
        share : float
            Of the step, 0 to 1; negative where it is not known.
        now : float
            s
        """
        if (stage, share) != self.reported:
            self.reported = stage, share
            self.known.hear(stage, max(share, 0.0), float(share >= 0), now)
        if now - self.begun < _SOON:
            return ""
        text = translate("ToolAxis", "{} so far").format(clock(now - self.begun))
        left = self.known.left(now)
        if left is None:
            return text
        form = translate("ToolAxis", "{}, about {} left") if left.of_all else translate(
            "ToolAxis", "{}, about {} left of this step")
        return form.format(text, clock(_STEP * max(1, round(left.seconds / _STEP))))


def clock(seconds):
    """A time as hours, minutes and seconds.

    Parameters
    ----------
    seconds : float
    """
    whole = round(seconds)
    if whole < 60:
        return translate("ToolAxis", "{} s").format(whole)
    if whole >= 3600:
        return translate("ToolAxis", "{} h").format(f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}")
    return translate("ToolAxis", "{} min").format(f"{whole // 60}:{whole % 60:02d}")
