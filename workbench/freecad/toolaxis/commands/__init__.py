"""The commands, one file each."""


def register():
    """Make the commands known to FreeCAD; their names in the order of the toolbar."""
    import FreeCADGui

    from .division import MergeSubSurfaces, SplitSubSurface
    from .export import Export
    from .jobs import MakeJobs
    from .machine import ChooseMachine
    from .plan import PlanOrientations
    from .recompute import Recompute
    from .verify import Verify

    commands = {"ToolAxis_PlanOrientations": PlanOrientations(), "ToolAxis_Verify": Verify(),
                "ToolAxis_Recompute": Recompute(), "ToolAxis_Merge": MergeSubSurfaces(),
                "ToolAxis_Split": SplitSubSurface(), "ToolAxis_MakeJobs": MakeJobs(),
                "ToolAxis_Machine": ChooseMachine(), "ToolAxis_Export": Export()}
    known = FreeCADGui.listCommands()
    for name, command in commands.items():
        if name not in known:
            FreeCADGui.addCommand(name, command)
    return list(commands)
