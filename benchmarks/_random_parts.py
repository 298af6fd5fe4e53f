"""Small parts drawn by a seed, as a shop meets them: domes and bosses with fillets, pockets, cavities, blades, hubs.

Everything is OpenCASCADE's through CadQuery; sizes are mm.  A draw that makes no valid solid is drawn again.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

Rng = np.random.Generator

#: Draws of a part's sizes until a valid solid is made, at most.
_TRIES = 50


class RandomPart(NamedTuple):
    """kind : of part;  solid : a `cadquery.Workplane` with one solid."""

    kind: str
    solid: Any


def draw_part(seed: int) -> RandomPart:
    """The part of a seed.

    Parameters
    ----------
    seed : int
    """
    rng = np.random.default_rng(seed)
    kinds = list(_MAKERS)
    kind = kinds[int(rng.integers(len(kinds)))]
    for _ in range(_TRIES):
        try:
            solid = _MAKERS[kind](rng)
            shape = solid.val()
        except Exception:  # the fillet is too large for its edges: OpenCASCADE raises many different errors
            continue
        if shape.isValid() and len(solid.solids().vals()) == 1 and shape.Volume() > 0:
            return RandomPart(kind, solid)
    raise ValueError(f"seed {seed} makes no valid {kind} in {_TRIES} draws")


def _size(rng: Rng, least: float, most: float) -> float:
    return float(np.round(rng.uniform(least, most), 2))


def _within(low: tuple[float, float, float], high: tuple[float, float, float]) -> Any:
    import cadquery

    return cadquery.selectors.BoxSelector(low, high)


def _plate(x: float, y: float, z: float) -> Any:
    import cadquery

    return cadquery.Workplane().box(x, y, z).translate((0, 0, z / 2))


def _dome(rng: Rng) -> Any:
    """A cap of a sphere on a plate, with a fillet at its foot."""
    import cadquery

    radius, height = _size(rng, 14, 26), _size(rng, 5, 12)
    sunk = min(_size(rng, 2, 14), 0.7 * radius)
    foot = (radius**2 - sunk**2) ** 0.5
    above = cadquery.Workplane().workplane(offset=height).rect(300, 300).extrude(80)
    cap = cadquery.Workplane().sphere(radius).translate((0, 0, height - sunk)).intersect(above)
    side = 2 * foot + _size(rng, 12, 24)
    ring = _within((-foot - 0.5, -foot - 0.5, height - 0.1), (foot + 0.5, foot + 0.5, height + 0.1))
    return _plate(side, side, height).union(cap).edges(ring).fillet(_size(rng, 2, 7))


def _pocket(rng: Rng) -> Any:
    """A pocket with round corners and a round floor edge."""
    import cadquery

    wide, long, deep = _size(rng, 26, 50), _size(rng, 24, 36), _size(rng, 6, 16)
    corner = _size(rng, 5, 11)
    hollow = cadquery.Workplane().workplane(offset=26 - deep).rect(wide, long).extrude(40)
    hollow = hollow.edges("|Z").fillet(corner).edges("<Z").fillet(_size(rng, 2, min(corner, deep) - 1))
    return _plate(wide + 16, long + 16, 26).cut(hollow)


def _bosses(rng: Rng) -> Any:
    """One or two tapered bosses on a plate, with fillets at feet and rims."""
    import cadquery

    plate, rise = 10.0, _size(rng, 6, 14)
    made, ends = _plate(90, 54, plate), [0.0, 0.0]
    for x, side in ((-21, 0), (21, 1))[:int(rng.integers(1, 3))]:
        radius = _size(rng, 8, 13)
        made = made.union(cadquery.Workplane().workplane(offset=plate).center(x, 0).circle(radius)
                          .extrude(rise, taper=_size(rng, 0, 15)))
        ends[side] = x
    feet = _within((-36, -15, plate - 0.1), (36, 15, plate + 0.1))
    made = made.edges(feet).fillet(_size(rng, 2, 5))
    return made.faces(">Z").edges().fillet(_size(rng, 1, 3))


def _cavity(rng: Rng) -> Any:
    """A hollow of a sphere in a block, its rim rounded."""
    import cadquery

    radius, lift = _size(rng, 14, 24), _size(rng, 0, 8)
    ball = cadquery.Workplane().sphere(radius).translate((0, 0, 15 + lift))
    return cadquery.Workplane().box(64, 64, 30).cut(ball).faces(">Z").edges("%CIRCLE").fillet(_size(rng, 1, 4))


def _hub(rng: Rng) -> Any:
    """A spline turned about an axis, on a plate."""
    import cadquery

    low, high, wide = _size(rng, 6, 10), _size(rng, 20, 34), _size(rng, 20, 28)
    middle = (0.6 * wide, low + _size(rng, 0.3, 0.7) * (high - low))
    outline = cadquery.Workplane("XZ").moveTo(0, low).lineTo(wide, low)
    outline = outline.spline([middle, (0, high)], includeCurrent=True).close()
    return _plate(2 * wide + 20, 2 * wide + 20, low).union(outline.revolve(360, (0, 0, 0), (0, 1, 0)))


def _loft(rng: Rng) -> Any:
    """From a rectangle to an ellipse."""
    import cadquery

    start = cadquery.Workplane().rect(_size(rng, 36, 54), _size(rng, 24, 36))
    return start.workplane(offset=_size(rng, 16, 32)).ellipse(_size(rng, 10, 18), _size(rng, 7, 11)).loft()


def _blade(rng: Rng) -> Any:
    """A twisted blade on a plate, with a sharp root."""
    import cadquery

    thick, turn = _size(rng, 3, 5), _size(rng, 5, 25)
    low = [(-18, 0), (-5, thick), (10, 0.7 * thick), (18, -1), (8, -0.5 * thick), (-6, -0.4 * thick)]
    high = [(0.85 * x, 0.8 * y) for x, y in low]
    wires = [_closed_spline(low, 8.0, 0.0), _closed_spline(high, 8.0 + _size(rng, 14, 26), turn)]
    return _plate(56, 34, 8).union(cadquery.Workplane(obj=cadquery.Solid.makeLoft(wires)))


def _closed_spline(points: Sequence[tuple[float, float]], height: float, turn: float) -> Any:
    """A wire through points at a height, turned by degrees."""
    import cadquery

    cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    places = [cadquery.Vector(cos * x - sin * y, sin * x + cos * y, height) for x, y in points]
    return cadquery.Wire.assembleEdges([cadquery.Edge.makeSpline(places, periodic=True)])


def _groove(rng: Rng) -> Any:
    """A ring groove of round section in a plate, or a bent one across it."""
    import cadquery

    if rng.random() < 0.5:
        middle = cadquery.Vector(0, 0, 5 + _size(rng, 0, 3))
        ring = cadquery.Solid.makeTorus(_size(rng, 18, 26), _size(rng, 4, 7), middle)
        return cadquery.Workplane().box(76, 76, 10).cut(cadquery.Workplane(obj=ring))
    bend = [(-40, _size(rng, -8, 8)), (0, _size(rng, -4, 4)), (40, _size(rng, -8, 8))]
    path = cadquery.Workplane("XY", origin=(0, 0, 20)).spline(bend)
    tube = cadquery.Workplane("YZ", origin=(-40, bend[0][1], 20)).circle(_size(rng, 5, 10)).sweep(path)
    return _plate(70, 50, 20).cut(tube)


def _freeform(rng: Rng) -> Any:
    """A block under a surface through random heights, with a boss on it now and then."""
    import cadquery

    heights = rng.normal(0.0, 2.2, size=(5, 5))
    points = [[cadquery.Vector(15 * i - 30, 12 * j - 24, 24 + heights[i, j]) for j in range(5)] for i in range(5)]
    top = cadquery.Face.makeSplineApprox(points, smoothing=(1, 1, 1), minDeg=3, maxDeg=5)
    solid = cadquery.Workplane().rect(52, 40).extrude(50)
    below = cadquery.Workplane(obj=cadquery.Solid.extrudeLinear(top, cadquery.Vector(0, 0, -60)))
    made = solid.intersect(below)
    if rng.random() < 0.5:
        boss = cadquery.Workplane().workplane(offset=10).center(_size(rng, -8, 8), 0).circle(_size(rng, 5, 8))
        made = made.union(boss.extrude(_size(rng, 22, 30)))
    return made


_MAKERS: dict[str, Callable[[Rng], Any]] = {
    "dome": _dome, "pocket": _pocket, "bosses": _bosses, "cavity": _cavity, "hub": _hub, "loft": _loft,
    "blade": _blade, "groove": _groove, "freeform": _freeform}
