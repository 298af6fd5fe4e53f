"""The judge's word on what was made, apart from what stays open beside it."""

from typing import Any

import pytest

from toolaxis.report.verdict_words import count_passed, name_verdict


def judged(*passed: bool, whole: bool = True, **more: Any) -> dict[str, Any]:
    return {"passed": whole, "operations": [{"name": f"op{k}", "passed": one} for k, one in enumerate(passed)], **more}


@pytest.mark.parametrize("verdict, word, count", [
    (None, "not verified yet: run toolaxis verify", ""),
    (judged(True, True, made_passed=True), "passed", "2 of 2 operations"),
    (judged(True, made_passed=True, whole=False), "passed", "1 of 1 operation"),
    (judged(True, False, made_passed=False, whole=False), "FAILED", "1 of 2 operations"),
    (judged(True, made_passed=False, whole=False), "FAILED", "1 of 1 operation"),
    (judged(True, made_passed=False, whole=False, unjudged=["op1"]),
     "not verified to the end: run toolaxis verify again", "1 of 2 operations"),
    (judged(False, made_passed=False, whole=False, unjudged=["op1"]), "FAILED", "0 of 2 operations"),
    (judged(made_passed=False, whole=False), "nothing was made", ""),
    (judged(True, whole=False), "FAILED", "1 of 1 operation"),
], ids=["none", "complete", "open", "failed", "in the way", "stopped", "stopped and failed", "nothing", "earlier"])
def test_it_judges_what_was_made(verdict: dict[str, Any] | None, word: str, count: str) -> None:
    assert (name_verdict(verdict), count_passed(verdict)) == (word, count)
