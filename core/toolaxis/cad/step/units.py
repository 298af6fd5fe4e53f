"""The length units that a STEP text declares, and whether they are lengths at all."""

import re

from toolaxis.cad.step.entities import Entities, Entity
from toolaxis.cad.step.faces import REPRESENTATIONS

_CONTEXT = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)")
_REFERENCE = re.compile(rb"#(\d+)")
_BASED = re.compile(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'\s*,\s*#(\d+)")
_METRIC = re.compile(rb"(?<![A-Z_])SI_UNIT\s*\(\s*(?:\$|\.(\w+)\.)\s*,\s*\.(\w+)\.")
_MEASURE = re.compile(rb"LENGTH_MEASURE\s*\(\s*([^\s)]+)\s*\)\s*,\s*#(\d+)")

REMEDY = "export the part in mm or inches"
PREFIXES = frozenset(("exa", "peta", "tera", "giga", "mega", "kilo", "hecto", "deca", "deci", "centi", "milli", "micro",
                      "nano", "pico", "femto", "atto"))


def length_units(entities: Entities) -> dict[int, str]:
    """The length units of all contexts, by entity number: "millimetre", "inch"; empty where none is declared.

    Parameters
    ----------
    entities : Entities
    """
    names = {number: _name(entities, entities.table[number]) for number in _of_contexts(entities)}
    return {number: name for number, name in names.items() if name}


def _of_contexts(entities: Entities) -> list[int]:
    """Entity numbers of the length units of all contexts."""
    lengths = {entity.number for entity in entities.complex_of("LENGTH_UNIT")}
    members = [int(number) for listed in _CONTEXT.findall(entities.bare) for number in _REFERENCE.findall(listed)]
    return [number for number in dict.fromkeys(members) if number in lengths]


def _name(entities: Entities, unit: Entity) -> str:
    body = entities.content[unit.start:unit.end]
    based, metric = _BASED.search(body), _METRIC.search(body)
    if based:
        return based.group(1).decode(errors="replace").lower()
    return b"".join(word or b"" for word in metric.groups()).decode().lower() if metric else ""


def unit_fault(entities: Entities) -> str:
    """What is wrong with the length units of a text, which a kernel takes for metres; empty where nothing is.

    Parameters
    ----------
    entities : Entities
    """
    units = _of_contexts(entities)
    fault = next(filter(None, (_fault(entities, number, ()) for number in units)), "")
    return fault or ("" if units else _find_lost_unit(entities))


def _find_lost_unit(entities: Entities) -> str:
    """Which entity may have been the length unit, where the text lacks some."""
    contexts = [number for holder in entities.of(*REPRESENTATIONS) for number in entities.references(holder)[-1:]]
    units = [int(number) for members in _CONTEXT.findall(entities.bare) for number in _REFERENCE.findall(members)]
    gone = [number for number in (*contexts, *units) if number in entities.dangling]
    return f"lacks #{gone[0]}, by which it declares its length unit; {REMEDY}" if gone else ""


def _fault(entities: Entities, number: int, above: tuple[int, ...]) -> str:
    unit = entities.table.get(number)
    if number in above:
        return f"declares the length unit #{number}, which is defined by itself; {REMEDY}"
    if unit is None:
        return f"declares a length unit by #{number}, which is not there; {REMEDY}"
    body = entities.content[unit.start:unit.end]
    based, metric = _BASED.search(body), _METRIC.search(body)
    if metric and not based:
        prefix, name = ((word or b"").decode() for word in metric.groups())
        if name.lower() != "metre" or prefix.lower() not in PREFIXES | {""}:
            return f"declares the length unit {f'{prefix} {name}'.strip()} in #{number}, which is unknown; {REMEDY}"
        return ""
    measure = entities.table.get(int(based.group(2))) if based else None
    amount = _MEASURE.search(entities.bare, measure.start - 1, measure.end) if measure else None
    if based is None or amount is None:
        return f"declares a length unit in #{number} that cannot be read; {REMEDY}"
    try:
        value = float(amount.group(1))
    except ValueError:
        value = 0.0
    if value <= 0.0:
        name = based.group(1).decode(errors="replace")
        return f"declares the length unit {name} in #{number} as {value:g} of another: it must be above 0; {REMEDY}"
    return _fault(entities, int(amount.group(2)), (*above, number))
