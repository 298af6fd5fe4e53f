"""Inputs that the fields of the planning panel can show, and why they cannot show others."""

from dataclasses import replace

from freecad.toolaxis.document.inputs import JobInputs
from freecad.toolaxis.services.background import sentence

from toolaxis.shape.work_origin import parse_margins, parse_origin


def inputs_to_show(inputs, fastest):
    """Why fields cannot show some inputs, one sentence or none, and inputs that they can show.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    fastest : int
        Greatest spindle speed of the field, rev/min.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.partition.partition import check_count
    from toolaxis.tools.tool import Tool

    checks = {"tool": lambda: Tool.parse(inputs.tool), "regions": lambda: check_count(inputs.regions),
              "orientations": lambda: check_count(inputs.orientations, "orientations"),
              "spindle": lambda: _check_spindle(inputs.spindle, fastest),
              "origin": lambda: parse_origin(inputs.origin), "stock_box": lambda: parse_margins(inputs.stock_box)}
    reasons = {}
    for name, look in checks.items():
        try:
            look()
        except InvalidInput as reason:
            reasons[name] = sentence(reason)
    usual = JobInputs()
    return "; ".join(reasons.values()), replace(inputs, **{name: getattr(usual, name) for name in reasons})


def _check_spindle(speed, fastest):
    from toolaxis.errors import InvalidInput

    if not 0 < speed <= fastest:
        raise InvalidInput(f"spindle is {speed:g} rev/min: it must be above zero, and at most {fastest} rev/min")
