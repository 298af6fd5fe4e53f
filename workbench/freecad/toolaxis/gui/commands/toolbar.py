"""The commands of toolbar and menu, in their order."""

from freecad.toolaxis.gui.commands.division import MergeSubSurfaces, SplitSubSurface
from freecad.toolaxis.gui.commands.export import Export
from freecad.toolaxis.gui.commands.freecad import add_commands
from freecad.toolaxis.gui.commands.jobs import MakeJobs
from freecad.toolaxis.gui.commands.machine import ChooseMachine
from freecad.toolaxis.gui.commands.plan import PlanOrientations
from freecad.toolaxis.gui.commands.play import Play
from freecad.toolaxis.gui.commands.recompute import Recompute
from freecad.toolaxis.gui.commands.verify import Verify


def register():
    """Make the commands known to FreeCAD; their names in the order of the toolbar."""
    return add_commands({
        "ToolAxis_PlanOrientations": PlanOrientations(), "ToolAxis_Verify": Verify(), "ToolAxis_Recompute": Recompute(),
        "ToolAxis_Merge": MergeSubSurfaces(), "ToolAxis_Split": SplitSubSurface(), "ToolAxis_MakeJobs": MakeJobs(),
        "ToolAxis_Machine": ChooseMachine(), "ToolAxis_Play": Play(), "ToolAxis_Export": Export()})
