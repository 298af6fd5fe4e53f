"""Sentences on a part with blades: how many, what was turned, how near the tool comes, what stays as rest material."""

from toolaxis.plan.blades import SIDES, Blades
from toolaxis.plan.part_account import PartAccount
from toolaxis.plan.plan import Plan

_WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve",
          "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty")


def blades_lines(plan: Plan) -> list[str]:
    """What a user wants to know of the blades of a plan, a sentence each.

    Parameters
    ----------
    plan : Plan
        With blades.
    """
    blades = plan.blades
    assert blades is not None
    turned = {blades.blade_of(op.face.number) for op in plan.operations if op.number in blades.copies}
    lines = [f"{len(blades.blades)} blades found around the axis {_numbers(blades.axis + 0.0, 4)} through "
             f"{_numbers(blades.point + 0.0, 2)}: one planned, {in_words(len(turned))} turned and proven on their own "
             "faces"]
    if blades.searched:
        lines.append(f"the turned axis was refused for {len(blades.searched)} operations, which were searched anew: "
                     f"{', '.join(map(str, blades.searched))}")
    here, there = (_numbers(place, 2) for place in blades.gap.places)
    lines.append(f"neighbouring blades come within {blades.gap.distance:.3f} mm of each other, fillets apart, "
                 f"at {here} and {there}")
    return [*lines, *_rooms(blades), *_left_on_blades(plan, blades)]


def in_words(count: int) -> str:
    """A number up to twenty in words, else in digits.

    Parameters
    ----------
    count : int
        Zero or more.
    """
    return _WORDS[count] if count < len(_WORDS) else str(count)


def _numbers(values: object, digits: int) -> str:
    return "(" + ", ".join(f"{value:.{digits}f}" for value in values) + ")"  # type: ignore[attr-defined]


def _rooms(blades: Blades) -> list[str]:
    """The least clearance to the neighbouring blade and to the hub."""
    lines = []
    for to in dict.fromkeys(room.to for room in blades.room):
        found = [f"{room.component} {room.distance:.3f} mm (operation {room.operation}, face {room.face})"
                 if room.operation else f"{room.component} more than {room.distance:.0f} mm"
                 for room in blades.room if room.to == to]
        lines.append(f"least clearance to the {to}: {', '.join(found)}")
    return lines


def _left_on_blades(plan: Plan, blades: Blades) -> list[str]:
    """What stays as rest material on every blade."""
    lines = []
    shares = [(round(one.left, 1), round(one.area, 1)) for one in blades.blades]
    for left, area in sorted(set(shares)):
        alike = [k for k, share in enumerate(shares, 1) if share == (left, area)]
        if left > 0:
            whose = "each blade" if len(alike) == len(blades.blades) else "blade " + ", ".join(map(str, alike))
            lines.append(f"on {whose} {left:.1f} of {area:.1f} mm2 ({100 * left / area:.1f} %) stay as rest material: "
                         f"{_by_side(plan, blades, alike[0])}")
    return lines


def _by_side(plan: Plan, blades: Blades, number: int) -> str:
    """Area that stays on one blade, by what its faces are."""
    found = []
    for name in SIDES:
        account = PartAccount.of([op for op in plan.operations if blades.blade_of(op.face.number) == number
                                  and blades.side_of(op.face.number) == name])
        left = account.area - account.machined
        if left > 0.05:
            found.append(f"{name} {left:.1f} mm2")
    return ", ".join(found)
