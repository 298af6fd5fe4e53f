"""How long a computation goes on and may still take, told from what it reports; needs no window."""

import re

import FreeCAD

translate = FreeCAD.Qt.translate

#: "face 4a (2 of 9): axes" is the second of nine pieces of work.
_PIECE = re.compile(r"\((\d+) of (\d+)\)")
#: Nothing is said before so many seconds; a step tells what is left of it from this share on.
_SOON, _KNOWN = 5.0, 0.1
#: What is left is told in steps of so many seconds.
_STEP = 5


class Remaining:
    """Hears the reports of one computation.

    Parameters
    ----------
    now : float
        When it begins, s.
    """

    def __init__(self, now):
        self.begun = now
        self.count, self.starts = 0, {}
        self.step, self.stepped = "", now

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
        if stage != self.step:
            self.step, self.stepped = stage, now
        left, of_all = self._left(stage, share, now)
        if now - self.begun < _SOON:
            return ""
        text = translate("ToolAxis", "{} so far").format(clock(now - self.begun))
        if left is None:
            return text
        form = translate("ToolAxis", "{}, about {} left") if of_all else translate(
            "ToolAxis", "{}, about {} left of this step")
        return form.format(text, clock(_STEP * max(1, round(left / _STEP))))

    def _left(self, stage, share, now):
        """Seconds that are left, or None, and whether of all pieces."""
        found = _PIECE.search(stage)
        if found is not None:
            k, count = map(int, found.groups())
            if count != self.count:
                self.count, self.starts = count, {}
            self.starts.setdefault(k, now)
            first, last = min(self.starts), max(self.starts)
            if last > first:  # as long as those that are done took on the mean
                mean = (self.starts[last] - self.starts[first]) / (last - first)
                return max(mean * (count - last + 1) - (now - self.starts[last]), 0.0), True
        if share >= _KNOWN and now - self.stepped >= 1.0:
            return (now - self.stepped) * (1 - share) / share, False
        return None, False


def clock(seconds):
    """A time as minutes and seconds.

    Parameters
    ----------
    seconds : float
    """
    whole = round(seconds)
    if whole < 60:
        return translate("ToolAxis", "{} s").format(whole)
    return translate("ToolAxis", "{} min").format(f"{whole // 60}:{whole % 60:02d}")
