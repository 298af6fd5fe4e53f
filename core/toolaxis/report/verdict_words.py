"""What the judge says of the operations that were made, in a word or two."""

from collections.abc import Mapping
from typing import Any

PASSED, FAILED = "passed", "FAILED"


def name_verdict(verdict: Mapping[str, Any] | None) -> str:
    """The verdict on what was made; what stays open beside it is no matter of the judge.

    Parameters
    ----------
    verdict : mapping or None
        The document of verdict.json; None where the plan was not judged.
    """
    if verdict is None:
        return "not verified yet: run toolaxis verify"
    failed = any(not op["passed"] for op in verdict["operations"])
    if verdict.get("unjudged") and not failed:
        return "not verified to the end: run toolaxis verify again"
    if not verdict["operations"]:
        return "nothing was made"
    # A document of an earlier version knows only of the plan as a whole.
    return PASSED if not failed and verdict.get("made_passed", verdict["passed"]) is True else FAILED


def count_passed(verdict: Mapping[str, Any] | None) -> str:
    """How many of the operations that were made passed; empty where none was judged.

    Parameters
    ----------
    verdict : mapping or None
        As for `name_verdict`.
    """
    judged = () if verdict is None else verdict["operations"]
    if not judged:
        return ""
    assert verdict is not None
    made = len(judged) + len(verdict.get("unjudged", ()))
    return f"{sum(op['passed'] for op in judged)} of {made} {'operation' if made == 1 else 'operations'}"
