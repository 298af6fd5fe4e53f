"""What a method comes to on a part's faces, to be set beside what others do."""

from dataclasses import dataclass

#: The method of the row that stands for the plan itself.
THIS_PLAN = "plan"


@dataclass(frozen=True)
class Baseline:
    """One method and what it costs, as one row of [zhu2016] Table 4.

    Attributes
    ----------
    method : str
        As in `toolaxis.plan.plan.PlanInputs`, or "plan" for the plan itself.
    tool : str
        Short form of the tool that it takes: a ball end for the method "ball".
    sub_surfaces, machined : int
        How many there are, and on how many of them it found an axis.
    orientations : int
        Different axes.
    passes : int
    length, travel : float
        Of the cutting motion, and of entries, exits and links, mm; of what is machined.
    seconds : float
        Time of all, s, as `Plan.seconds` reckons it.
    reason : str
        Why something is not machined; empty where all is.
    title : str
        What the method is called; not written, as the method tells it.
    """

    method: str
    tool: str
    sub_surfaces: int
    machined: int
    orientations: int
    passes: int
    length: float
    travel: float
    seconds: float
    reason: str = ""
    title: str = ""

    @property
    def shown(self) -> str:
        """What tables and pictures call the method."""
        return "this plan" if self.method == THIS_PLAN else self.title or self.method

    @property
    def complete(self) -> bool:
        """Whether every sub-surface is machined."""
        return self.machined == self.sub_surfaces


def clock(seconds: float) -> str:
    """A time as minutes and seconds.

    Parameters
    ----------
    seconds : float
    """
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02d}"
