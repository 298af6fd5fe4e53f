"""What a reader of a plan must know first: what has no axis, what failed, what was not checked, what stays."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.plan.timing import MOTION_WARNINGS
from toolaxis.report.areas_aside import describe_hidden, describe_not_begun


@dataclass(frozen=True)
class Warning:
    """One sentence to be minded.

    Attributes
    ----------
    level : str
        "stop" (do not machine this), "mind" (not checked or left over) or "note".
    text : str
    """

    level: str
    text: str


def warnings_of(plan: Plan, verdict: Mapping[str, Any] | None) -> tuple[Warning, ...]:
    """The warnings of a plan, the gravest first.

    Parameters
    ----------
    plan : Plan
    verdict : mapping or None
        The document of verdict.json; None where the plan was not judged.
    """
    left, lost = _of_operations(plan)
    found = [*lost, *_of_verdict(plan, verdict),
             *(Warning("stop", f"between operations: {text}") for text in plan.in_the_way),
             *(Warning("stop", f"the plan: {one.sentence}") for one in plan.faults)]
    # Sorting keeps this order among those of one level: what was not checked stands before what is left.
    unchecked = plan.not_checked if verdict is None else verdict["not_checked"]
    if unchecked:
        found.append(Warning("mind", f"not checked: {', '.join(unchecked)}"))
    found += [Warning("mind", text) for text in plan.part.warnings]
    if plan.machine is not None and plan.machine.machine.assumed:
        found.append(Warning("mind", f"assumed in the machine's file: {', '.join(plan.machine.machine.assumed)}"))
    if hidden := describe_hidden(plan):
        found.append(Warning("mind", hidden))
    found += [*left, *_of_clean_up(plan)]
    order = {"stop": 0, "mind": 1, "note": 2}
    return tuple(sorted(found, key=lambda one: order[one.level]))


def _of_operations(plan: Plan) -> tuple[list[Warning], list[Warning]]:
    """What is left to clean-up, and what has no axis; turned copies with the same fate count with their original."""
    left, lost = [], []
    if plan.outcome == "cancelled":
        missing = describe_not_begun(plan)
        more = f"; {missing}" if missing else ""
        lost.append(Warning("stop", f"the plan was cancelled before all sub-surfaces were done: it is not whole{more}"))
    copies = {} if plan.blades is None else plan.blades.copies
    numbers = {op.number for op in plan.operations if not op.done}
    for op in plan.operations:
        if op.done:
            left += [Warning("mind", f"{op.name}: {why}") for why in op.orientation.reasons
                     if why.startswith(MOTION_WARNINGS)]
        if op.done or copies.get(op.number) in numbers:
            continue
        turned = sum(copies.get(number) == op.number for number in numbers)
        name = op.name if not turned else f"{op.name} and {turned} turned {'copies' if turned > 1 else 'copy'}"
        verb = ("have", "are") if turned else ("has", "is")
        why = "; ".join(op.orientation.reasons) or op.orientation.outcome
        if outcome_of([op], plan.blades) == "incomplete":
            lost.append(Warning("stop", f"{name} {verb[0]} no axis: {why}"))
        else:
            left.append(Warning("mind", f"{name} {verb[1]} left as rest material: {why}"))
    return left, lost


def _of_verdict(plan: Plan, verdict: Mapping[str, Any] | None) -> list[Warning]:
    if verdict is None:
        return [Warning("stop", "not verified: run toolaxis verify on this folder before anything is machined")]
    found = []
    failed = {op["name"] for op in verdict["operations"] if not op["passed"]}
    if failed:
        found.append(Warning("stop", f"the verdict is FAIL: {', '.join(sorted(failed))}"))
    judged = {op["name"] for op in verdict["operations"]}
    unjudged = [op.name for op in plan.operations if op.done and op.name not in judged]
    if unjudged:
        found.append(Warning("stop", f"the verdict says nothing of {', '.join(unjudged)}: run toolaxis verify again"))
    for text in verdict["reasons"]:
        name, _, rest = text.partition(": ")
        if "not checked" not in rest and not rest.startswith(("no axis, nothing to verify", "not verified")):
            found.append(Warning("stop" if name in failed else "note", text))
    return found


def _of_clean_up(plan: Plan) -> list[Warning]:
    copies = {} if plan.blades is None else plan.blades.copies
    zones = [zone for op in plan.operations
             if op.done and op.number not in copies and op.number not in plan.taken_over for zone in op.zones]
    if not zones:
        return []
    area, elsewhere = sum(zone.area for zone in zones), sum(zone.elsewhere for zone in zones)
    more = f", {elsewhere:.1f} mm² of it machined by other operations" if elsewhere > 0 else ""
    turned = " (turned copies not counted)" if copies else ""
    if len(zones) == 1:
        return [Warning("mind", f"1 zone, {area:.1f} mm², is left as rest material{more}{turned}")]
    return [Warning("mind", f"{len(zones)} zones, {area:.1f} mm², are left as rest material{more}{turned}")]
