"""What a plan with several tools comes to: how much of its faces it machines, and the time of each tool."""

import json
from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class ToolShare:
    """What one tool does in a plan.

    Attributes
    ----------
    place : int
        Among the tools with which something is machined, in their order, from 0; tells its colour.
    number : int
        Place in the magazine.
    name : str
    operations : int
    area : float
        mm^2 that it machines.
    seconds : float
        On its paths.
    """

    place: int
    number: int
    name: str
    operations: int
    area: float
    seconds: float


@dataclass(frozen=True)
class PlanAccount:
    """The account of the faces that a plan was asked for, and its time.

    Attributes
    ----------
    area, machined, unreachable, open, not_begun : float
        mm^2: see `toolaxis.plan.part_account.PartAccount`.
    seconds : float
        Of the whole, changes of tool and axis included.
    tools : tuple of ToolShare
        Those that machine something.
    offered : int
        How many could be chosen from.
    passes, axes : int
        Of all operations, and different ones; 0 in documents of before.
    step_over : float
        Mean distance of passes, mm.
    clamped, machined_before : float
        mm^2 of the faces that are not asked for: as they lie in the clamped side, or earlier setups machine them.
    """

    area: float
    machined: float
    unreachable: float
    open: float
    not_begun: float
    seconds: float
    tools: tuple
    offered: int
    passes: int = 0
    axes: int = 0
    step_over: float = 0.0
    clamped: float = 0.0
    machined_before: float = 0.0

    @property
    def between(self):
        """Time of changes of tool and axis, s."""
        return max(self.seconds - sum(one.seconds for one in self.tools), 0.0)


def account_of(plan):
    """The account of a plan.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    """
    found, rows = plan.account, []
    for place, tool in enumerate(plan.used_tools):
        done = [op for op in plan.operations if op.done and op.tool == tool]
        if done:
            rates = plan.inputs.at_rates_of(tool)
            rows.append(ToolShare(place, tool.number, tool.shop_name, len(done),
                                  float(sum(op.face.area * (1 - op.orientation.unreached) for op in done)),
                                  float(sum(op.seconds(rates.feedrate, rates.rapid) for op in done))))
    return PlanAccount(found.area, found.machined, found.unreachable, found.open, found.not_begun, float(plan.seconds),
                       tuple(rows), len(plan.tools), sum(op.orientation.passes for op in plan.operations if op.done),
                       int(plan.orientations), mean_step_over(plan), float(sum(one.area for one in plan.held)),
                       float(sum(one.area for one in plan.machined_before)))


def mean_step_over(plan):
    """The mean distance of passes over all operations of a plan, mm; 0 without passes.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    """
    done = [op.orientation for op in plan.operations if op.done]
    length = sum(found.length for found in done)
    return float(sum(found.average_strip_width * found.length for found in done) / length) if length > 0 else 0.0


def account_text(account):
    """An account as it is kept in a document.

    Parameters
    ----------
    account : PlanAccount
    """
    return json.dumps(asdict(account))


def account_from(text):
    """The account that `account_text` made; None of an empty text.

    Parameters
    ----------
    text : str
    """
    if not text:
        return None
    words = json.loads(text)
    return PlanAccount(**{**words, "tools": tuple(ToolShare(**one) for one in words["tools"])})
