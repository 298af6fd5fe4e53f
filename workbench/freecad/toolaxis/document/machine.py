"""The machine of a document: which one, where the document stands on its table, and the angles of each operation."""

from dataclasses import replace
from math import degrees, isfinite, radians
from re import findall

import FreeCAD
from freecad.toolaxis.document.machine_angles import ranges_along, texts_of, ways_to_hold
from freecad.toolaxis.document.properties import Property, Proxy, assign, ensure
from freecad.toolaxis.document.transaction import one_step
from freecad.toolaxis.document.view_providers import attach_view

translate = FreeCAD.Qt.translate

_GROUP = "Machine"
_ANGLES = (Property("StringList", "RotaryAngles", _GROUP,
                    "Positions of the rotary axes in both solutions, the one used first", True),)


class MachineProxy(Proxy):
    """Keeps a machine; computes nothing.

    Parameters
    ----------
    thing : App::FeaturePython
    """

    Type = "ToolAxisMachine"
    properties = (
        Property("String", "Machine", _GROUP, "Name in the library, or file", True),
        Property("Vector", "Offset", _GROUP, "Position of the document's origin on the table, all axes at zero", True),
        Property("String", "Source", _GROUP, "Source of its data", True),
        Property("StringList", "Assumed", _GROUP, "Data that are assumed", True),
        Property("StringList", "Axes", _GROUP, "Its axes with their ranges", True))

    def execute(self, thing):
        """Nothing to compute."""


def machine_of(document):
    """The machine of a document; None without one.

    Parameters
    ----------
    document : App.Document
    """
    return next((thing for thing in document.Objects
                 if getattr(getattr(thing, "Proxy", None), "Type", "") == MachineProxy.Type), None)


def place_machine(document, name, offset, found):
    """Put a machine into a document, or another in its place, as one undo step; operations gain their angles.

    Parameters
    ----------
    document : App.Document
    name : str
        Of the machine in the library, or its file.
    offset : (3,) sequence of float
        mm
    found : sequence of (App.DocumentObject, list of str)
        Operations with the texts of their angles.

    Returns
    -------
    App.DocumentObject
    """
    from toolaxis.cad.machines import load_machine

    machine = load_machine(name)
    with one_step(document, translate("ToolAxis", "Machine")):
        thing = machine_of(document)
        if thing is None:
            thing = document.addObject("App::FeaturePython", "Machine")
            MachineProxy(thing)
            attach_view(thing)
        thing.Label = translate("ToolAxis", "Machine {}").format(machine.name)
        assign(thing, Machine=name, Offset=FreeCAD.Vector(*offset), Source=machine.source,
               Assumed=list(machine.assumed), Axes=[_range(axis) for axis in (*machine.linear, *machine.rotary)])
        for operation, texts in found:
            ensure(operation, _ANGLES)
            assign(operation, RotaryAngles=texts)
        thing.purgeTouched()
    return thing


def keep_angles(operation, plan, op):
    """Write the rotary angles of an operation that was planned for a machine, both solutions, the chosen one first.

    Parameters
    ----------
    operation : App.DocumentObject
    plan : toolaxis.plan.plan.Plan
    op : toolaxis.plan.operation.Operation
    """
    if plan.machine is None or not op.done:
        if "RotaryAngles" in operation.PropertiesList and not op.done:
            operation.RotaryAngles = []
        return
    mounted = replace(plan.machine, tool_length=op.tool.gauge_length)
    ensure(operation, _ANGLES)
    if op.orientation.lead is not None:
        assign(operation, RotaryAngles=ranges_along(mounted, op.path))
        return
    ways = ways_to_hold(mounted, op.orientation.axis, op.path.cl)
    assign(operation, RotaryAngles=texts_of(mounted.machine, ways, nearest(ways, op.rotary)))


def angles_kept(operation):
    """The rotary angles that an operation tells first, rad; empty without any.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    texts = getattr(operation, "RotaryAngles", None) or [""]
    return tuple(radians(float(number)) for number in findall(r"[ABC] (-?[\d.]+(?:e-?\d+)?)\u00b0", texts[0]))


def nearest(ways, rotary):
    """The solution that stands at given angles, whole turns aside; the first where none are given.

    Parameters
    ----------
    ways : sequence of freecad.toolaxis.document.machine_angles.AxisSolution
    rotary : sequence of float
        rad
    """
    import numpy as np

    if not ways or len(rotary) != len(ways[0].rotary):
        return 0
    away = [np.abs(np.mod(way.rotary - np.array(rotary) + np.pi, 2 * np.pi) - np.pi).max(initial=0.0) for way in ways]
    return int(np.argmin(away))


def _range(axis):
    """An axis with its range, in mm or degrees."""
    turning = hasattr(axis, "point")
    unit, ends = ("\u00b0" if turning else " mm"), (axis.low, axis.high)
    texts = [f"{degrees(end) if turning else end:g}{unit}" if isfinite(end) else "\u221e" for end in ends]
    return f"{axis.name}: {texts[0]} \u2026 {texts[1]}"
