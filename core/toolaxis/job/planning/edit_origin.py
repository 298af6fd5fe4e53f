"""Another origin of a plan's work coordinate systems, and another stock: axes and passes stay as they are."""

from collections.abc import Sequence
from dataclasses import replace

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.shape.part import Part
from toolaxis.shape.work_origin import Array, format_margins, locate_origin, parse_margins


def datum_of(inputs: PlanInputs, datum: Sequence[float], part: Part) -> Array:
    """Where work coordinate systems have their origin, (3,) mm.

    Parameters
    ----------
    inputs : PlanInputs
        With the origin, or none.
    datum : (3,) sequence of float
        What was given in its place, mm.
    part : Part

    Raises
    ------
    InvalidInput
        When both are given.
    """
    given = as_rows(datum, 3, "datum")[0]
    if not inputs.origin:
        return given
    if given.any():
        raise InvalidInput(f"datum and origin {inputs.origin!r} are both given: give one of them")
    return locate_origin(inputs.origin, (part.original or part).box, inputs.stock_margins)


def with_origin(plan: Plan, origin: str, stock_box: Sequence[float] | float | str | None = None,
                datum: Sequence[float] = (0.0, 0.0, 0.0)) -> Plan:
    """The plan with another origin and another stock.

    Parameters
    ----------
    plan : Plan
    origin : str
        Its short form, see `toolaxis.plan`; empty for `datum`.
    stock_box : float, sequence of float or text, optional
        Margins of the stock.
    datum : (3,) sequence of float
        mm

    Raises
    ------
    InvalidInput
        When origin or stock are not understood, or do not go together.

    **Properties**: 1. axes, passes and times are the same objects as before.
    """
    inputs = replace(plan.inputs, origin=origin, stock_box=format_margins(parse_margins(stock_box)))
    where = datum_of(inputs, datum, plan.part)
    operations = tuple(op if op.frame is None else replace(op, frame=replace(op.frame, origin=where))
                       for op in plan.operations)
    return replace(plan, inputs=inputs, operations=operations, datum=where)
