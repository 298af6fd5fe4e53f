"""What other methods come to on the same faces with the same proofs, beside a plan: [zhu2016] Table 4."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from toolaxis.errors import Cancelled, fault
from toolaxis.plan.baseline import THIS_PLAN, Baseline
from toolaxis.plan.choices import ISO
from toolaxis.plan.plan import Plan
from toolaxis.shape.face import Face
from toolaxis.strategies.registry import strategies, title_of

#: Rules that choose an axis for each sub-surface of the plan.
BY_SUB_SURFACE = ("sectors", "roman", "normal")
#: The same, where a machine is given.
ON_MACHINE = ("jerk",)
#: What takes the faces whole, as moving axes do: one axis for all of them, and a ball end along their mean normals.
WHOLE = ("one", "ball")


def compare_methods(made: Plan, faces: Sequence[Face], again: Callable[[str, Sequence[Face]], Plan]) -> Plan:
    """A plan with what other methods come to.

    Sectors, Roman's rule and mean normals on the same sub-surfaces, and where there is a machine the axes along which
    its jerk is greatest; the plan's own method with iso-parametric passes where its own are others; one fixed axis for
    all faces; a ball end of the same radius along each face's mean normal; and strategies that are to be compared, such
    as five axes with a constant lead, where the machine drives their rotary axes.

    Parameters
    ----------
    made : Plan
        Not cancelled.
    faces : sequence of Face
        What was asked for, before it was divided.
    again : callable
        Plans faces as they are by a method, or with iso-parametric passes, under the same limits and proofs.

    Returns
    -------
    Plan
        With `baselines`, itself the first; those that were finished where the user stopped it.

    Notes
    -----
    **Source**: [zhu2016] Table 4 and Sec. 6.2.
    """
    rows = [baseline(THIS_PLAN, made)]
    pieces = [op.face for op in made.operations]
    rotary = () if made.machine is None else made.machine.machine.rotary
    driven = sum(not axis.by_hand for axis in rotary)
    moving = [one.name for one in strategies().values() if one.compared and driven >= one.rotary_axes]
    by_sub_surface = BY_SUB_SURFACE if made.machine is None else (*BY_SUB_SURFACE, *ON_MACHINE)
    if made.inputs.passes != ISO:
        by_sub_surface = (ISO, *by_sub_surface)
    for method in (*by_sub_surface, *WHOLE, *moving):
        whole = method not in by_sub_surface
        if method == made.inputs.method and (not whole or len(pieces) == len(faces)):
            continue
        try:
            other = again(method, faces if whole else pieces)
        except Cancelled:
            break
        except Exception as reason:
            why = fault(reason).sentence
            rows.append(Baseline(method, made.named_tools, len(pieces), 0, 0, 0, 0.0, 0.0, 0.0, why, title_of(method)))
            continue
        if other.outcome == "cancelled":
            break
        rows.append(baseline(method, other))
    return replace(made, baselines=tuple(rows))


def baseline(method: str, made: Plan) -> Baseline:
    """One row of the comparison.

    Parameters
    ----------
    method : str
    made : Plan
    """
    done = [op for op in made.operations if op.done]
    refused = [op for op in made.operations if not op.done]
    reason = f"face {refused[0].face.label}: {next(iter(refused[0].orientation.reasons), '')}" if refused else ""
    return Baseline(method, made.named_tools, len(made.operations), len(done), made.orientations,
                    sum(op.orientation.passes for op in done), made.length, made.travel, made.seconds, reason,
                    title_of(method))
