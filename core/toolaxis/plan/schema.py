"""The JSON schema of plan.json, and the check of a document against it."""

import json
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from toolaxis.errors import InvalidInput

NAME = "toolaxis.plan"
VERSION = 2

_TYPES: dict[str, Callable[[Any], bool]] = {
    "object": lambda v: isinstance(v, Mapping),
    "array": lambda v: isinstance(v, list),
    "string": lambda v: isinstance(v, str),
    "number": lambda v: isinstance(v, int | float) and not isinstance(v, bool),
    "integer": lambda v: isinstance(v, int) and not isinstance(v, bool),
    "boolean": lambda v: isinstance(v, bool),
    "null": lambda v: v is None,
}


@cache
def schema() -> dict[str, Any]:
    """The schema (JSON Schema 2020-12, of which `check` knows the words that it uses)."""
    loaded: dict[str, Any] = json.loads(files("toolaxis.plan").joinpath("plan.schema.json").read_text("utf-8"))
    return loaded


def check(document: Any) -> None:
    """Check a document against the schema of plan.json.

    Parameters
    ----------
    document : object
        As `json.load` gives it.

    Raises
    ------
    InvalidInput
        At the first value that breaks the schema; the message names its place.
    """
    if isinstance(document, Mapping) and document.get("schema") == NAME and document.get("version") != VERSION:
        raise InvalidInput(f"plan.json has schema version {document.get('version')!r}: this program reads {VERSION}; "
                           "make the plan again")
    _check(document, schema(), "plan.json")


def _check(value: Any, rule: Mapping[str, Any], place: str) -> None:
    if "$ref" in rule:
        return _check(value, schema()["$defs"][rule["$ref"].removeprefix("#/$defs/")], place)
    kinds = rule.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if kinds and not any(_TYPES[kind](value) for kind in kinds):
        raise InvalidInput(f"{place} is {_short(value)}: {' or '.join(kinds)} is needed")
    if "enum" in rule and value not in rule["enum"]:
        raise InvalidInput(f"{place} is {_short(value)}: one of {', '.join(map(str, rule['enum']))} is needed")
    if "minimum" in rule and _TYPES["number"](value) and value < rule["minimum"]:
        raise InvalidInput(f"{place} is {_short(value)}: it must be at least {rule['minimum']}")
    if isinstance(value, list):
        _check_items(value, rule, place)
    elif isinstance(value, Mapping):
        _check_members(value, rule, place)


def _check_items(value: list[Any], rule: Mapping[str, Any], place: str) -> None:
    low, high = rule.get("minItems", 0), rule.get("maxItems", len(value))
    if not low <= len(value) <= high:
        raise InvalidInput(f"{place} has {len(value)} items: {low} are needed")
    for index, item in enumerate(value):
        if "items" in rule:
            _check(item, rule["items"], f"{place}[{index}]")


def _check_members(value: Mapping[str, Any], rule: Mapping[str, Any], place: str) -> None:
    known = rule.get("properties", {})
    for name in rule.get("required", []):
        if name not in value:
            raise InvalidInput(f"{place} has no {name!r}: the file is incomplete; make the plan again")
    for name, item in value.items():
        if name in known:
            _check(item, known[name], f"{place}.{name}")
        elif rule.get("additionalProperties") is False:
            raise InvalidInput(f"{place} has an unknown {name!r}: the file was not written by this version")
        elif isinstance(rule.get("additionalProperties"), Mapping):
            _check(item, rule["additionalProperties"], f"{place}.{name}")


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
