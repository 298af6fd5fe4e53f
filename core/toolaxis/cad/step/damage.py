"""What is wrong with the geometry of a STEP text before any kernel makes something else of it without a word."""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, pairwise
from math import isinf

from toolaxis.cad.step.entities import Entities, Entity, Nested
from toolaxis.cad.step.faces import FACES, SHELLS

#: In the file's unit.  The kernel takes points within 1e-7 for one; beyond this they are further apart from each other.
FARTHEST = 1e9

_NUMBER = rb"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_NOT_FINITE = re.compile(
    rb"(?<=[(,\s])[+-]?(?:nan|inf|infinity|\d+\.#(?:ind|inf|qnan|snan)\w*)(?=[\s,)])", re.IGNORECASE)
_NO_NUMBER = re.compile(rb"(?<=[(,])\s*+(?!" + _NUMBER + rb"\s*[,)])((?:[+-]|\.?\d)[^,();]*?)\s*(?=[,)])")
_NO_POINT = re.compile(rb"#(\d+)\s*=\s*(CARTESIAN_POINT|DIRECTION)\s*\(\s*'[^']*'\s*,\s*+"
                       rb"(?!\(\s*" + _NUMBER + rb"(?:\s*,\s*" + _NUMBER + rb"){0,2}\s*\)\s*\))\(?([^;)]*)")
#: Where numbers of 1e9 and more are written, and powers of ten that may be in any.
_LARGE = re.compile(rb"[eE]\+?0*(?:9|[1-9]\d+)(?!\d)|[(,\s][+-]?\d{10}")
_WORD = re.compile(rb"[^(),\s]+")
_ZERO = rb"\s*[+-]?0*\.?0*(?:[eE][+-]?\d+)?\s*"
_NO_DIRECTION = re.compile(rb"#(\d+)\s*=\s*DIRECTION\s*\(\s*'[^']*'\s*,\s*\(" + _ZERO + rb"(?:," + _ZERO + rb")*\)")
_SWALLOWED = re.compile(rb"#\d+\s*=[^;]*?#(\d+)\s*=")

#: The last parameter of these is a length above nothing.
ROUND = ("CYLINDRICAL_SURFACE", "SPHERICAL_SURFACE", "TOROIDAL_SURFACE", "DEGENERATE_TOROIDAL_SURFACE")
#: What needs no loop to have an end.
CLOSED = ("SPHERICAL_SURFACE", "TOROIDAL_SURFACE")
LOOPS = ("EDGE_LOOP", "VERTEX_LOOP", "POLY_LOOP")
BOUNDS = ("FACE_BOUND", "FACE_OUTER_BOUND")
PLACEMENTS = ("AXIS2_PLACEMENT_3D", "AXIS1_PLACEMENT")
#: What moves one representation into another.
PLACING = ("NEXT_ASSEMBLY_USAGE_OCCURRENCE", "MAPPED_ITEM", "REPRESENTATION_MAP", "ITEM_DEFINED_TRANSFORMATION",
           "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", "AXIS2_PLACEMENT_3D")
#: Curves that come with others on the surfaces beside them, which a kernel finds by itself.
DOUBLED = ("SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE")

Found = Iterator[tuple[int, str]]


def text_damage(entities: Entities) -> str:
    """What makes a text useless as a whole, with its entity; empty where nothing does.

    Parameters
    ----------
    entities : Entities
    """
    bare, start = entities.bare, entities.data
    endless = _endless(entities)
    if endless:
        return (f"holds {_short(endless.group())} in entity #{_owner(entities, endless.end())}: every number must be "
                "finite; repair the geometry and export it again")
    odd = _NO_NUMBER.search(bare, start)
    if odd:
        return (f"holds {_short(odd.group(1))} in entity #{_owner(entities, odd.end())}, where a number is needed; "
                "export the part again")
    point = _NO_POINT.search(bare, start)
    if point:
        return (f"holds {_short(point.group(3))} in {point.group(2).decode()} #{int(point.group(1))}, where one to "
                "three numbers are needed; export the part again")
    swallowed = _SWALLOWED.search(bare, start)
    if swallowed:
        return f"lacks a semicolon before entity #{int(swallowed.group(1))}; export the part again"
    return _twice(entities) or _bracket_fault(entities)


def _endless(entities: Entities) -> "re.Match[bytes] | None":
    """The first number that is none, or too large for a computer."""
    bare = entities.bare
    low = bare.lower()
    if any(word in low for word in (b"nan", b"inf", b".#")):
        found = _NOT_FINITE.search(bare, entities.data)
        if found:
            return found
    for large in _LARGE.finditer(bare, entities.data):
        start = max(bare.rfind(mark, 0, large.start() + 1) for mark in (b"(", b",")) + 1
        word = _WORD.search(bare, start)
        if word and isinf(_number(word.group())):
            return word
    return None


def _short(text: bytes) -> str:
    word = text.decode(errors="replace").strip()
    return word if len(word) <= 30 else f"{word[:27]}..."


def _owner(entities: Entities, place: int) -> str:
    """Number of the entity in which a place of the text lies."""
    before = [entity for entity in entities.table.values() if entity.start <= place]
    return str(max(before, key=lambda entity: entity.start).number) if before else "?"


def _twice(entities: Entities) -> str:
    twice = [number for number, times in Counter(entities.definitions).items() if times > 1]
    if not twice:
        return ""
    others = f", and {len(twice) - 1} other numbers," * (len(twice) > 1)
    return (f"defines entity #{twice[0]}{others} more than once: every number must stand for one entity; export the "
            "part again")


def _bracket_fault(entities: Entities) -> str:
    bare = entities.bare
    for entity in entities.table.values():
        if bare.count(b"(", entity.start, entity.end) + 1 != bare.count(b")", entity.start, entity.end):
            return f"has brackets that do not match in entity #{entity.number}; export the part again"
    return ""


def place_damage(entities: Entities) -> str:
    """What of an assembly stands at a place that the text lacks; empty where nothing does.

    Parameters
    ----------
    entities : Entities
    """
    if not entities.dangling:
        return ""
    moving = entities.complex_of("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION")
    for entity in chain(entities.of(*PLACING), moving):
        for number in entities.references(entity):
            if number in entities.dangling:
                what = entity.keyword or "REPRESENTATION_RELATIONSHIP"
                return (f"places its pieces by {what} #{entity.number}, which refers to #{number}, and that is not "
                        "defined; export the part again")
    return ""


def damaged_entities(entities: Entities) -> dict[int, str]:
    """Entities that are not what their standard asks, and the rule that each breaks.

    Parameters
    ----------
    entities : Entities
    """
    found = {number: f"#{number} is not defined in the file" for number in entities.dangling}
    for number, why in chain(_faces(entities), _topology(entities), _splines(entities), _radii(entities),
                             _directions(entities)):
        found.setdefault(number, why)
    return found


def far_entities(entities: Entities) -> dict[int, str]:
    """Points and round surfaces with a number that is absurd as a length, and the number.

    Parameters
    ----------
    entities : Entities
    """
    if not _LARGE.search(entities.bare, entities.data):
        return {}
    found = {}
    for entity in entities.of("CARTESIAN_POINT", *ROUND, "CONICAL_SURFACE", "CIRCLE", "ELLIPSE", "OFFSET_SURFACE"):
        words = _WORD.findall(entities.bare, entity.start, entity.end)
        worst = max((_number(word) for word in words if not word.startswith((b"#", b"'"))), key=abs, default=0.0)
        if abs(worst) > FARTHEST:
            found[entity.number] = f"its {_what(entity)} is {worst:g}, and none may exceed {FARTHEST:g}"
    return found


def _what(entity: Entity) -> str:
    point = entity.keyword == "CARTESIAN_POINT"
    return f"coordinate in point #{entity.number}" if point else f"length in {entity.keyword} #{entity.number}"


def faces_with(entities: Entities, faces: Iterable[int], guilty: dict[int, str]) -> dict[int, str]:
    """Which faces stand on some entities: face to what is said of the first one met.

    Parameters
    ----------
    entities : Entities
    faces : iterable of int
    guilty : dict of int to str
    """
    if not guilty:
        return {}
    found = {}
    for face in faces:
        met = next((number for number in _entities_below(entities, face) if number in guilty), 0)
        if met:
            found[face] = guilty[met]
    return found


def _entities_below(entities: Entities, face: int) -> Iterator[int]:
    """Everything that a face stands on; of an edge's curves in parameters only those on its own surface."""
    last = entities.references(entities.table[face])[-1:] if face in entities.table else []
    seen: set[int] = set()
    front = [face]
    while front:
        number = front.pop()
        if number in seen:
            continue
        seen.add(number)
        yield number
        entity = entities.table.get(number)
        if entity is not None:
            front += reversed(_entities_followed(entities, entity, last))


def _entities_followed(entities: Entities, entity: Entity, surface: list[int]) -> list[int]:
    """What an entity stands on, for a face on a surface."""
    referred = entities.references(entity)
    if entity.keyword == "PCURVE" and referred[:1] != surface:
        return []
    if entity.keyword in DOUBLED:
        return referred[:1] + [number for number in referred[1:] if number not in entities.dangling]
    return referred


def _refers(entities: Entities, entity: Entity, members: Sequence[int], right: Callable[[str], bool],
            needed: str) -> Found:
    for number in members:
        kind = entities.kind(number)
        if kind and not right(kind):
            yield entity.number, f"{entity.keyword} #{entity.number} refers to #{number}, {_a(kind)} and not {needed}"
            return


def _a(word: str) -> str:
    return f"an {word}" if word[0] in "AEIOU" else f"a {word}"


def _faces(entities: Entities) -> Found:
    for face in entities.of(*FACES):
        bounds = entities.members(face)
        referred = entities.references(face)
        surface = entities.kind(referred[-1]) if len(referred) > len(bounds) else ""
        if not bounds and surface not in CLOSED:
            yield face.number, "it has no loops"
        yield from _refers(entities, face, bounds, lambda kind: kind in BOUNDS or "+" in kind, "a FACE_BOUND")
        yield from _refers(entities, face, referred[len(bounds):],
                           lambda kind: kind == "PLANE" or ("SURFACE" in kind and kind not in FACES), "a surface")


def _topology(entities: Entities) -> Found:
    faces = (*FACES, "ORIENTED_FACE", "FACE", "SUBFACE")
    for shell in entities.of(*SHELLS):
        for number in entities.members(shell):
            kind = entities.kind(number)
            if kind and kind not in faces and "+" not in kind:
                yield number, f"{shell.keyword} #{shell.number} lists #{number}, {_a(kind)} and no face"
    for bound in entities.of(*BOUNDS):
        yield from _refers(entities, bound, entities.references(bound), lambda kind: kind in LOOPS or "+" in kind,
                           "a loop")
    for loop in entities.of("EDGE_LOOP"):
        edges = entities.members(loop)
        if not edges:
            yield loop.number, f"EDGE_LOOP #{loop.number} has no edges"
        yield from _refers(entities, loop, edges, lambda kind: kind == "ORIENTED_EDGE" or "+" in kind,
                           "an ORIENTED_EDGE")
    for edge in entities.of("ORIENTED_EDGE"):
        yield from _refers(entities, edge, entities.references(edge)[-1:],
                           lambda kind: "EDGE" in kind and kind not in ("ORIENTED_EDGE", "EDGE_LOOP"),
                           "an EDGE_CURVE")


def _radii(entities: Entities) -> Found:
    for surface in entities.of(*(kind for kind in ROUND if kind != "DEGENERATE_TOROIDAL_SURFACE")):
        radius = entities.parameters(surface)[-1:]
        if radius and isinstance(radius[0], bytes) and _number(radius[0]) <= 0.0:
            yield surface.number, (f"the radius of {surface.keyword} #{surface.number} is {_number(radius[0]):g} and "
                                   "must be above 0")


def _directions(entities: Entities) -> Found:
    zero = {int(number) for number in _NO_DIRECTION.findall(entities.bare, entities.data)}
    if not zero:
        return
    for placement in entities.of(*PLACEMENTS):
        for number in entities.references(placement):
            if number in zero:
                yield placement.number, f"DIRECTION #{number} of {placement.keyword} #{placement.number} has no length"


def _splines(entities: Entities) -> Found:
    for name, check in (("B_SPLINE_SURFACE", _surface_fault), ("B_SPLINE_CURVE", _curve_fault)):
        knotted, rational = f"{name}_WITH_KNOTS", f"RATIONAL_{name}"
        for entity in entities.of(knotted):
            whole = entities.parameters(entity)[1:]
            cut = 7 if name == "B_SPLINE_SURFACE" else 5
            fault = check(whole[:cut], whole[cut:], [])
            if fault:
                yield entity.number, f"{knotted} #{entity.number} {fault}"
        for entity in entities.complex_of(knotted):
            parts = entities.parts(entity)
            fault = check(parts.get(name, []), parts[knotted], parts.get(rational, []))
            if fault:
                yield entity.number, f"{knotted} #{entity.number} {fault}"


def _curve_fault(base: Nested, knots: Nested, rational: Nested) -> str:
    """Of a curve: degree and points, multiplicities and knots, weights."""
    if len(base) < 2 or len(knots) < 2 or not isinstance(base[1], list):
        return ""
    points = len(base[1])
    fault = _direction_fault("", base[0], points, knots[0], knots[1])
    return fault or (_weights_fault([rational[0]], (1, points)) if rational else "")


def _surface_fault(base: Nested, knots: Nested, rational: Nested) -> str:
    """Of a surface: degrees and rows of points, multiplicities and knots in u and v, rows of weights."""
    if len(base) < 3 or len(knots) < 4 or not isinstance(base[2], list):
        return ""
    rows = base[2]
    lengths = {len(row) for row in rows}
    if len(lengths) != 1:
        return "has rows of control points that are not equally long" if lengths else "has no control points"
    count = lengths.pop()
    fault = (_direction_fault(" in u", base[0], len(rows), knots[0], knots[2])
             or _direction_fault(" in v", base[1], count, knots[1], knots[3]))
    if fault or not rational or not isinstance(rational[0], list):
        return fault
    return _weights_fault(rational[0], (len(rows), count))


def _direction_fault(where: str, degree: "bytes | Nested", points: int, counts: "bytes | Nested",
                     knots: "bytes | Nested") -> str:
    if isinstance(degree, list) or isinstance(counts, bytes) or isinstance(knots, bytes):
        return ""
    order, times, values = int(_number(degree)), [int(_number(n)) for n in counts], [_number(n) for n in knots]
    if order < 1:
        return f"has degree {order}{where}, and must have 1 or more"
    if points <= order:
        return f"has {points} control points{where} and degree {order}: {order + 1} are needed"
    if len(times) != len(values):
        return f"has {len(values)} knots{where} and {len(times)} multiplicities"
    if min(times, default=1) < 1:
        return f"has a knot{where} of multiplicity {min(times)}, and must have 1 or more"
    if max(map(abs, values), default=0.0) > FARTHEST:
        return f"has the knot {max(values, key=abs):g}{where}, and none may exceed {FARTHEST:g}"
    falling = next(((a, b) for a, b in pairwise(values) if b < a), None)
    if falling:
        return f"has knots{where} that do not ascend: {falling[0]:g} before {falling[1]:g}"
    if sum(times) != points + order + 1:
        return (f"has {sum(times)} knots{where} where {points} control points of degree {order} need "
                f"{points + order + 1}")
    return ""


def _weights_fault(rows: Nested, size: tuple[int, int]) -> str:
    lists = [row for row in rows if isinstance(row, list)]
    if len(lists) != size[0] or any(len(row) != size[1] for row in lists):
        return f"has not one weight for each of its {size[0] * size[1]} control points"
    weights = [_number(word) for row in lists for word in row]
    least, most = min(weights), max(weights)
    if least <= 0.0:
        return f"has the weight {least:g}, and all must be above 0"
    return f"has weights from {least:g} to {most:g}, too far apart to compute with" if most > FARTHEST * least else ""


def _number(word: "bytes | Nested") -> float:
    """A number as it is written; NaN for what is none, which breaks no rule here."""
    try:
        return float(word) if isinstance(word, bytes) else float("nan")
    except ValueError:
        return float("nan")
