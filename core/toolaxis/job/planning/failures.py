"""A face that cannot be done, or on which the program itself failed: its operation, and what tells others of it."""

import platform
from collections.abc import Sequence
from dataclasses import asdict

from toolaxis import __version__
from toolaxis.errors import REPORT_AT, Fault, ToolAxisError
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool


def fail_face(number: int, face: Face, tool: Tool, fault: Fault, notes: tuple[str, ...] = ()) -> Operation:
    """The operation of a face on which the program failed.

    Parameters
    ----------
    number : int
    face : Face
    tool : Tool
    fault : Fault
    notes : tuple of str
        Reasons that stand beside it.
    """
    none = Orientation(None, outcome="failed", reasons=(fault.sentence, *notes))
    return Operation(number, face, tool, none, traceback=fault.traceback)


def refuse_face(number: int, face: Face, tool: Tool, reason: ToolAxisError) -> Operation:
    """The operation of a face that cannot be done, in the words of an exception.

    Parameters
    ----------
    number : int
    face : Face
    tool : Tool
    reason : ToolAxisError
    """
    return Operation(number, face, tool, Orientation(None, reasons=(f"no axis found: {reason}",)))


def fail_operation(op: Operation, fault: Fault) -> Operation:
    """An operation that was planned, and on which the program failed afterwards: nothing of it may be machined.

    Parameters
    ----------
    op : Operation
    fault : Fault
    """
    return fail_face(op.number, op.face, op.tool, fault, op.orientation.reasons)


def failure_text(plan: Plan, op: Operation) -> str:
    """What to send beside the part where the program failed on a face.

    Parameters
    ----------
    plan : Plan
    op : Operation
        That failed.
    """
    numbers = ", ".join(map(str, op.face.numbers))
    face = f"sub-surface {op.face.label}, face {numbers}, {op.face.kind}"
    return _text(plan, (op.tool,), f"{op.name}: {op.orientation.reasons[0]}", face, op.traceback)


def fault_text(plan: Plan, fault: Fault) -> str:
    """What to send beside the part where the program failed on no single face.

    Parameters
    ----------
    plan : Plan
    fault : Fault
    """
    return _text(plan, plan.tools, fault.sentence, f"all {len(plan.operations)} operations", fault.traceback)


def _text(plan: Plan, tools: Sequence[Tool], sentence: str, what: str, traceback: str) -> str:
    machine = "no machine" if plan.machine is None else plan.machine.machine.name
    lines = (sentence,
             "",
             f"Report this at {REPORT_AT}, with the part, plan.json and this text.",
             "",
             f"toolaxis {__version__}, Python {platform.python_version()}, {platform.platform()}",
             f"{plan.part.source or 'part without a file'}, {what}",
             f"{'; '.join(map(_describe, tools))}, {machine}",
             ", ".join(f"{name} {value}" for name, value in asdict(plan.inputs).items()),
             "",
             traceback.rstrip() or "no traceback is known")
    return "\n".join(lines) + "\n"


def _describe(tool: Tool) -> str:
    holder = "with holder" if "holder" in tool.outlines else "without holder"
    return f"{tool.name} {holder}, stickout {tool.stickout} mm"
