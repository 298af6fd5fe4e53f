"""What stands for a tool, in scripts and in CAM jobs, as a tool of the library and as fields of the inputs."""

from freecad.toolaxis.document.cam_probe import tool_from
from freecad.toolaxis.document.inputs import flute_of
from freecad.toolaxis.services.arguments import tool_of


def tool_fields(tool):
    """The fields of `JobInputs` that a tool fills.

    Parameters
    ----------
    tool : str, toolaxis.Tool, or a CAM tool controller or tool bit
    """
    tool = cutter_of(tool)
    found = {"tool": tool.name, "flute_length": flute_of(tool), "shank": ()}
    if tool.stickout is not None:
        found["stickout"] = tool.stickout
    for name in ("shank", "holder"):
        if getattr(tool, name) is not None:
            found[name] = tuple(map(tuple, getattr(tool, name).tolist()))
    return found


def cutter_of(tool):
    """What stands for a tool as a tool of the library.

    Parameters
    ----------
    tool : str, toolaxis.Tool, or a CAM tool controller or tool bit
    """
    if isinstance(tool_of(tool), str):
        from toolaxis.job.inputs.tool_file import load_tool

        return load_tool(tool)
    return tool if hasattr(tool, "corner_radius") else tool_from(tool)
