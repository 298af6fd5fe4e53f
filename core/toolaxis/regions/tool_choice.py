"""Which tools of a rack machine which faces, one after the other: least time over all faces of a part together."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Tools that follow each other on a face at most.
MOST = 3
#: What a chain leaves is charged at so many times what the quickest tool takes for it, and with so many index moves.
_DEARER, _FURTHER = 2.0, 3.0
#: Axes that reach less than the best one by no more than this share are told apart by time.
_AS_GOOD = 0.02


class FacePrices(NamedTuple):
    """What it takes to machine the cells of a face.

    seconds : (tools, axes, cells) s, infinite where a tool does not reach a cell under an axis
    area : (cells,) mm^2
    """

    seconds: Array
    area: Array


class AxisTime(NamedTuple):
    """An axis of a tool on a face: axis : its number;  seconds : the cutting time under it, s."""

    axis: int
    seconds: float


class ToolChain(NamedTuple):
    """Tools that machine a face one after the other, each what those before it left.

    tools : numbers of the tools from 0, in their order
    seconds : cutting time and index moves, s
    charge : for what none of them reaches and others would, s
    first : share that the first of them reaches under its axis of what it reaches under any
    share : share of the face that it reaches under that axis
    axes : that axis, then others under which it reaches as much and takes less than an index move longer
    """

    tools: tuple[int, ...]
    seconds: float
    charge: float
    first: float = 0.0
    share: float = 0.0
    axes: tuple[AxisTime, ...] = ()

    @property
    def cost(self) -> float:
        """Time, with what is left charged, s."""
        return self.seconds + self.charge


class ToolChoice(NamedTuple):
    """The tools for all faces.

    chains : the chain of each face; empty where no tool reaches anything of it
    tools : numbers of all tools that are used
    seconds : cutting time, index moves and tool changes, s
    gap : by what share another choice could be better in this model, at most
    """

    chains: tuple[ToolChain, ...]
    tools: tuple[int, ...]
    seconds: float
    gap: float


class _Step(NamedTuple):
    """What a tool machines under one axis: (cells,) bool, and that axis with others that are nearly as quick."""

    cells: Bools
    axes: tuple[AxisTime, ...]

    @property
    def seconds(self) -> float:
        """Cutting time, s."""
        return self.axes[0].seconds


def chains_of(prices: FacePrices, index: float, most: int = MOST) -> tuple[ToolChain, ...]:
    """The chains for a face of which none is beaten by another one with no further tools.

    Parameters
    ----------
    prices : FacePrices
        Tools in the order in which they are used, the large ones first.
    index : float
        Time of an index move, s, counted for each tool and axis.
    most : int
        Tools in a chain at most; a tool may follow itself under another axis.

    Returns
    -------
    tuple of ToolChain
        The cheapest first; the empty one where no tool reaches anything.  Each tool machines under the axis under which
        it reaches most, among those that reach as much under the one that takes least time.
    """
    reached = np.isfinite(prices.seconds)
    least = prices.seconds.min(axis=(0, 1), initial=np.inf)
    charges = _Charges(np.where(np.isfinite(least), least, 0.0), np.isfinite(least), index)
    found = [*_chains(prices, reached, charges, most)] or [ToolChain((), 0.0, 0.0)]
    best: dict[frozenset[int], ToolChain] = {}
    for one in sorted(found, key=lambda chain: (chain.cost, len(chain.tools), chain.tools)):
        best.setdefault(frozenset(one.tools), one)
    kept: list[ToolChain] = []
    for tools, one in best.items():
        if not any(frozenset(other.tools) <= tools for other in kept):
            kept.append(one)
    return tuple(kept)


class _Charges(NamedTuple):
    """What cells cost that a chain leaves.

    least : (cells,) time of the quickest tool and axis for each cell, s; 0 for what nothing reaches
    possible : (cells,) bool, what something reaches
    move : time of an index move, s
    """

    least: Array
    possible: Bools
    move: float

    def of(self, left: Bools) -> float:
        """The charge for some cells, s."""
        return float(_DEARER * self.least[left].sum() + _FURTHER * self.move) if left.any() else 0.0


def _chains(prices: FacePrices, reached: Bools, charges: _Charges, most: int) -> Iterator[ToolChain]:
    under_any, whole = reached.any(axis=1) @ prices.area, float(prices.area.sum())

    def _longer(tools: tuple[int, ...], seconds: float, left: Bools,
                begun: tuple[float, float, tuple[AxisTime, ...]]) -> Iterator[ToolChain]:
        for tool in range(tools[-1] if tools else 0, len(prices.seconds)):
            step = _best_step(prices, reached[tool], tool, left, charges.move)
            if step is None:
                continue
            chain, rest = (*tools, tool), left & ~step.cells
            spent = seconds + step.seconds + charges.move
            area = float(prices.area[step.cells].sum())
            own = begun if tools else (area / float(under_any[tool]), area / whole, step.axes)
            yield ToolChain(chain, spent, charges.of(rest), *own)
            if len(chain) < most and rest.any():
                yield from _longer(chain, spent, rest, own)

    if charges.possible.any():
        yield from _longer((), 0.0, charges.possible, (0.0, 0.0, ()))


def _best_step(prices: FacePrices, reached: Bools, tool: int, left: Bools, move: float) -> _Step | None:
    """What a tool machines of what is left under its best axis; None where it reaches nothing of it."""
    held = reached & left
    area, seconds = held @ prices.area, np.where(held, prices.seconds[tool], 0.0).sum(axis=1)
    if not area.size or not area.max() > 0:
        return None
    good = np.flatnonzero(area >= (1 - _AS_GOOD) * area.max())
    good = good[np.argsort(seconds[good], kind="stable")]
    near = good[seconds[good] <= seconds[good[0]] + move]
    return _Step(held[good[0]], tuple(AxisTime(int(one), float(seconds[one])) for one in near))


def choose_tools(chains: Sequence[Sequence[ToolChain]], change: float, most: int | None = None) -> ToolChoice:
    """The chain of each face with which all faces take least time together, tool changes included.

    Parameters
    ----------
    chains : sequence of sequence of ToolChain
        Of each face, from `chains_of`.
    change : float
        Time of a tool change, s.
    most : int, optional
        Greatest number of tools; faces that none of these reaches have an empty chain then.

    Notes
    -----
    An integer programme: one chain for each face, and a price on every tool that some chain uses.  It is solved to the
    end, so that the gap is that of rounding.
    """
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import coo_array

    rows = [(face, one) for face, some in enumerate(chains)
            for one in (some if most is None else (*some, _nothing_of(some)))]
    tools = sorted({tool for _, one in rows for tool in one.tools})
    if not tools:
        return ToolChoice(tuple(some[0] for some in chains), (), 0.0, 0.0)
    count = len(rows)
    price = np.array([*(one.cost for _, one in rows), *(change for _ in tools)])
    one_each = coo_array((np.ones(count), ([face for face, _ in rows], range(count))), (len(chains), len(price)))
    uses = [(k, count + tools.index(tool)) for k, (_, one) in enumerate(rows) for tool in set(one.tools)]
    entries = [(row, column, sign) for row, pair in enumerate(uses) for column, sign in zip(pair, (1, -1), strict=True)]
    line, column, value = (np.array(part) for part in zip(*entries, strict=True))
    opened = coo_array((value.astype(float), (line, column)), (len(uses), len(price)))
    constraints = [LinearConstraint(one_each, 1, 1), LinearConstraint(opened, -np.inf, 0)]
    if most is not None:
        counted = np.append(np.zeros(count), np.ones(len(tools)))
        constraints.append(LinearConstraint(counted[None], 0, most))
    found = milp(price, integrality=np.ones(len(price)), bounds=Bounds(0, 1), constraints=constraints)
    picked = np.flatnonzero(found.x[:count] > 0.5)
    chosen = tuple(rows[k][1] for k in picked)
    used = tuple(sorted({tool for one in chosen for tool in one.tools}))
    seconds = sum(one.seconds for one in chosen) + change * len(used)
    return ToolChoice(chosen, used, float(seconds), float(max(found.mip_gap, 0.0)))


def _nothing_of(some: Sequence[ToolChain]) -> ToolChain:
    """The chain of a face that is left alone: dearer than any other one."""
    return ToolChain((), 0.0, _DEARER * max(one.cost for one in some))
