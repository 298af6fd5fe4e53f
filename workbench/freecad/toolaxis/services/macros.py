"""What panels do, as lines of a macro that do the same again without a panel."""

import FreeCAD
from freecad.toolaxis.document.inputs import JobInputs

import __main__

_IMPORT = "import freecad.toolaxis"
_DOCUMENT = "FreeCAD.ActiveDocument"
#: Fields of the inputs that an operation planned again may have changed, and the properties that hold them.
_HELD = {"tool": "Tool", "stickout": "StickOut", "flute_length": "FluteLength", "scallop": "Scallop",
         "tolerance": "Tolerance", "allowance": "Allowance", "limits": "Limits", "objective": "Objective",
         "direction": "Direction", "spindle": "SpindleSpeed", "method": "Method", "strategy": "Strategy",
         "roughness": "Roughness", "passes": "CutPattern", "stock": "Stock", "least_lean": "LeastLean",
         "greatest_step_over": "GreatestStepOver", "allowance_on": "AllowanceOn", "lead": "Lead",
         "avoid_faces": "AvoidFaces", "held": "Held", "origin": "Origin", "stock_box": "StockBox"}


def record(*lines):
    """Add lines to the macro that FreeCAD records, if it does; nothing is run.

    Parameters
    ----------
    *lines : str
    """
    if FreeCAD.GuiUp:
        import FreeCADGui

        skip = getattr(FreeCADGui, "doCommandSkip", _only_told)
        for line in (_IMPORT, *lines):
            skip(line)


class _Nothing:
    """Takes whatever is asked of it, called or set, and does nothing."""

    def __getattr__(self, name):
        return self

    def __call__(self, *_, **__):
        return self

    def __setattr__(self, name, value):
        pass


def _only_told(line):
    """Add a line to the macro where FreeCAD, as 1.0, adds only what it also runs: a call runs on nothing."""
    import FreeCADGui

    if line.startswith("import "):
        FreeCADGui.doCommand(line)
        return
    names = {name: __main__.__dict__.get(name) for name in ("FreeCAD", "freecad")}
    try:
        __main__.__dict__.update(dict.fromkeys(names, _Nothing()))
        FreeCADGui.doCommand(line)
    finally:
        __main__.__dict__.update(names)


def plan_line(inputs):
    """The call that plans what a panel planned.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    """
    usual = JobInputs()
    faces = [f"{thing.Name}.{name}" for thing, name in inputs.faces]
    given = {name: getattr(inputs, name) for name in ("scallop", "stickout", "feedrate", "spindle")}
    if inputs.rack:
        given = {"scallop": inputs.scallop, "rack": list(inputs.rack), "feedrate": inputs.feedrate,
                 "spindle": inputs.spindle}
    else:
        given |= {name: list(map(list, getattr(inputs, name))) for name in ("shank", "holder")}
    given |= {name: getattr(inputs, name) for name in ("flute_length", "allowance", "limits", "objective", "direction",
                                                       "regions", "orientations", "method", "blades", "compare",
                                                       "strategy", "roughness", "tolerance", "passes", "most_tools",
                                                       "stock", "least_lean", "greatest_step_over", "allowance_on",
                                                       "lead", "avoid_faces", "held", "origin", "stock_box")
              if getattr(inputs, name) != getattr(usual, name)}
    if inputs.obstacles:
        given["obstacles"] = [thing.Name for thing in inputs.obstacles]
    if inputs.after is not None:
        given["after"] = inputs.after.Name
    words = ", ".join(f"{name}={value!r}" for name, value in given.items())
    tool = "" if inputs.rack else f"{inputs.tool!r}, "
    return f"freecad.toolaxis.plan({_DOCUMENT}, {faces!r}, {tool}{words})"


def again_lines(operation, before, inputs):
    """The lines that plan an operation again as a panel did.

    Parameters
    ----------
    operation : App.DocumentObject
    before, inputs : freecad.toolaxis.document.inputs.JobInputs
        What it had been planned with, and what it was planned with now.
    """
    thing = thing_of(operation)
    lines = [f"{thing}.{held} = {getattr(inputs, name)!r}" for name, held in _HELD.items()
             if getattr(inputs, name) != getattr(before, name)]
    if inputs.after != before.after:
        lines.append(f"{thing}.After = {None if inputs.after is None else thing_of(inputs.after)}")
    if inputs.rack != before.rack:
        lines.append(f"{thing}.Rack = {list(inputs.rack)!r}")
    if inputs.most_tools != before.most_tools:
        lines.append(f"{thing}.MostTools = {inputs.most_tools or 0!r}")
    if inputs.feedrate != before.feedrate:
        lines.append(f"{thing}.FeedRate = {inputs.feedrate / 60!r}")
    return [*lines, f"freecad.toolaxis.recompute({thing})"]


def thing_of(thing):
    """An object as a macro names it.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return f"{_DOCUMENT}.getObject({thing.Name!r})"


def list_of(things):
    """Objects as a macro names them.

    Parameters
    ----------
    things : sequence of App.DocumentObject
    """
    return "[" + ", ".join(map(thing_of, things)) + "]"
