"""What became of each face of a part that was planned and judged, read from plan.json, verdict.json and the messages.

Only written forms are read, so that one benchmark measures any version of the command.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from benchmarks._bounded import MessageLine, Ran

Document = Mapping[str, Any]

#: Kinds of open faces, by what stands in a reason; the first that fits counts.
_KINDS = (("memory", r"MemoryError|out of memory|Unable to allocate"),
          ("exception", r"^failed\b"),
          ("not found in limit", r"within the limit|limit of work|work limit"),
          ("rest material", r"left (as|entirely as) rest material|left to clean-up"),
          ("normals spread", r"the normals of face|its normals spread|limits and normals leave no axis|"
                             r"more than a hemisphere"))
#: The same by the constraint that an axis breaks, where nothing else is known.
_CONSTRAINTS = (("gouge", r"gouges"), ("holder", r"the holder"), ("shank", r"the shank"),
                ("cutter at walls", r"the cutter (meets|comes|collides|is not)"),
                ("wanders", r"wanders|flat bottom|least lean"),
                ("normals spread", r"leans|no axis sees|deg from a normal"), ("limits", r"outside the limits"))
#: What the axes of a search were refused for, as the reasons count them.
_COUNTED = {"gouge": "with a gouge", "holder": "with a collision of the holder",
            "shank": "with a collision of the shank", "cutter at walls": "with a collision of the cutter",
            "wanders": "(?:with a contact that wanders|too near to a normal)", "limits": "outside the limits",
            "normals spread": "(?:on the back of the surface|too far from a normal)"}
#: Share of its area that a face's operations have, at least, where all of them were made.
_WHOLE = 0.99
_STAGE, _JUDGED = re.compile(r"^(?:.*: )?face (\d+)\S* \(\d+ of \d+\)"), re.compile(r"^(\S+) \(\d+ of \d+\)")


def kind_of(reasons: Sequence[str]) -> str:
    """The kind of an open face: what most of the axes that see the face were refused for, where that is counted.

    Parameters
    ----------
    reasons : sequence of str
    """
    for name, pattern in _KINDS:
        if any(re.search(pattern, reason) for reason in reasons):
            return name
    for reason in reasons:
        counts = {name: int(found[1]) for name, words in _COUNTED.items()
                  if (found := re.search(rf"(\d+) {words}", reason))}
        if counts:
            return max(counts, key=lambda name: (name != "normals spread", counts[name]))
    for name, pattern in _CONSTRAINTS:
        if any(re.search(pattern, reason) for reason in reasons):
            return name
    return "other"


def seconds_by(lines: Sequence[MessageLine], pattern: re.Pattern[str], end: float) -> dict[str, float]:
    """Processor seconds between the first message of each face, or operation, and what is told next.

    Parameters
    ----------
    lines : sequence of MessageLine
    pattern : re.Pattern
        Its first group says of whom a message tells.
    end : float
        When the process ended.
    """
    took: dict[str, float] = {}
    now, since = "", 0.0
    for line in (*lines, MessageLine(end, "")):
        found = pattern.match(line.text)
        name = found[1] if found else ""
        if name != now:
            if now:
                took[now] = took.get(now, 0.0) + line.cpu - since
            now, since = name, line.cpu
    return took


def planning_seconds(ran: Ran) -> dict[str, float]:
    """Processor seconds of each face's search, by its number."""
    return seconds_by(ran.lines, _STAGE, ran.cpu)


def judging_seconds(ran: Ran) -> dict[str, float]:
    """Processor seconds of each operation's judgement, by its name."""
    return seconds_by(ran.lines, _JUDGED, ran.cpu)


def why_stopped(ran: Ran) -> str:
    """"time", "clock", "memory", "exception" or "refused": what ended a process that did not do its work."""
    if ran.short_of_memory:
        return "memory"
    if ran.ended:
        return ran.ended
    return "refused" if ran.code == 2 else "exception"


def outcomes(areas: Mapping[int, float], plan: Document | None, planned: Ran, verdict: Document | None,
             judged: Ran | None) -> list[dict[str, Any]]:
    """A record for each face that was asked for.

    Parameters
    ----------
    areas : mapping
        Area of each face, by its number.
    plan, verdict : mapping or None
        What was written.
    planned, judged : Ran
        The processes; none of judging where there was nothing to judge.
    """
    took = planning_seconds(planned)
    judging = {} if judged is None else judging_seconds(judged)
    verdicts = {one["name"]: one for one in ([] if verdict is None else verdict["operations"])}
    begun = list(took)
    rows = []
    for number, area in areas.items():
        some = [] if plan is None else [op for op in plan["operations"] if number in (op.get("faces") or [op["face"]])]
        if some:
            found = _of_operations(some, verdicts, judged)
            found["verified_area"] = min(area, sum(_verified(op, verdicts, areas) for op in some))
            in_work = plan is not None and plan.get("outcome") == "cancelled" and begun[-1:] == [str(number)]
            if found["verified"] and in_work and sum(op["area"] for op in some) < _WHOLE * area:
                found |= {"outcome": "open", "kind": f"not finished: {why_stopped(planned)}", "verified": False}
        else:
            found = _without_plan(str(number), planned, begun)
            found["verified_area"] = 0.0
        rows.append({"face": number, "area": area, **found, "plan_seconds": took.get(str(number)),
                     "judge_seconds": sum(judging.get(op["name"], 0.0) for op in some) if some and judging else None,
                     "operations": [op["name"] for op in some]})
    return rows


def _verified(op: Document, verdicts: Mapping[str, Document], areas: Mapping[int, float]) -> float:
    """Area that an operation machines as it was judged, mm2: of several faces one's share, without what is left."""
    if op["name"] not in verdicts or not verdicts[op["name"]]["passed"]:
        return 0.0
    faces = op.get("faces") or [op["face"]]
    return float(op["area"] * (1 - (op["orientation"].get("unreached") or 0.0)) / len(faces))


def _of_operations(some: Sequence[Document], verdicts: Mapping[str, Document], judged: Ran | None) -> dict[str, Any]:
    """The outcome of a face that has operations: the worst of theirs; a piece left as rest material spoils no other."""
    done = [op for op in some if op["cl_file"]]
    reasons = [why for op in some for why in op["orientation"]["reasons"]]
    failed = [op for op in done if op["name"] in verdicts and not verdicts[op["name"]]["passed"]]
    unjudged = [op for op in done if op["name"] not in verdicts]
    missing = [op for op in some if not op["cl_file"] and not op["zones"]]
    told = [why for op in failed for why in verdicts[op["name"]]["reasons"]]
    if failed:
        outcome, kind = "failed", "judged fail"
    elif unjudged:
        why = "exception" if judged is None else why_stopped(judged)
        outcome, kind = "not judged", f"judge: {why}"
        told = [judged.last_words] if judged is not None else []
    elif missing:
        outcome, kind = "open", kind_of([why for op in missing for why in op["orientation"]["reasons"]])
    elif not done:
        outcome, kind = "left", "rest material"
    else:
        outcome, kind = "verified", ""
    return {"outcome": outcome, "kind": kind, "reasons": reasons, "judge_reasons": told,
            "verified": outcome == "verified"}


def _without_plan(face: str, planned: Ran, begun: Sequence[str]) -> dict[str, Any]:
    """The outcome of a face of which nothing was written."""
    why = why_stopped(planned)
    if why != "refused" and begun and face != begun[-1]:
        kind = f"not begun: {why}" if face not in begun else f"lost: {why}"
    else:
        kind = why
    return {"outcome": "open", "kind": kind, "reasons": list(last_reasons(planned)), "judge_reasons": [],
            "verified": False}


def last_reasons(ran: Ran) -> Iterator[str]:
    """How a process ended, and where in the code where it says so."""
    yield ran.last_words
    places = [line.text.strip() for line in ran.lines if line.text.lstrip().startswith("File ")]
    yield from places[-1:]
