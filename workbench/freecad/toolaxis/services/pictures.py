"""The pictures of a plan, drawn by the library as the command draws them."""

import tempfile
from pathlib import Path

import FreeCAD
from freecad.toolaxis.document.strategies import picture_titles

translate = FreeCAD.Qt.translate


def drawn(plan, progress):
    """Draw a plan; for any thread.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    progress : toolaxis.progress.Progress

    Returns
    -------
    list of (str, bytes)
        Names as the command gives them, without their ending, and PNG images.

    Raises
    ------
    Cancelled
        When the progress object asks to stop.
    ImportError
        Where matplotlib is missing.
    """
    from toolaxis.job.output.pictures import draw_plan

    with tempfile.TemporaryDirectory(prefix="toolaxis-") as folder:
        draw_plan(plan, Path(folder), progress)
        return [(path.stem, path.read_bytes()) for path in sorted(Path(folder).glob("*.png"))]


def title_of(name):
    """What a picture is called in the window.

    Parameters
    ----------
    name : str
        As the command names its file, without the ending.
    """
    operation, _, kind = name.rpartition("-")
    titles = {**picture_titles(), "passes": translate("ToolAxis", "Passes and tool"),
              "plan": translate("ToolAxis", "Whole part"), "machine": translate("ToolAxis", "On the machine"),
              "tightest": translate("ToolAxis", "Where it is tightest"),
              "orientations": translate("ToolAxis", "Length and number of orientations"),
              "baselines": translate("ToolAxis", "Other methods")}
    title = titles.get(kind, kind)
    return f"{title}, {operation}" if operation else title
