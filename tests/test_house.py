"""What a reader meets everywhere: one noun names one class, and few functions are named by what became of something."""

import importlib.util
from pathlib import Path

import pytest

_spec = importlib.util.spec_from_file_location("house", Path(__file__).with_name("house.py"))
assert _spec is not None and _spec.loader is not None
house = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(house)

#: Shares of functions that are still named by a participle, at most: lower them when fewer are.
MOST = {"core": 0.041, "workbench": 0.098}
#: Tokens in a line of code, at most: lower them when lines hold fewer.
DENSEST = {"core": 12.5, "workbench": 10.8}


def test_one_noun_names_one_class() -> None:
    homes = house.class_homes()
    assert len(homes) > 400
    assert {name: found for name, found in homes.items() if len(found) > 1} == {}


@pytest.mark.parametrize("tree", house.TREES)
def test_no_more_functions_are_named_by_a_participle(tree: str) -> None:
    names = house.functions(tree)
    assert sum(map(house.is_participle, names)) <= MOST[tree] * len(names)


@pytest.mark.parametrize("tree", house.TREES)
def test_lines_hold_no_more_than_they_did(tree: str) -> None:
    assert house.density(tree) <= DENSEST[tree]


def test_density_counts_code_only() -> None:
    lines = house.code_lines('"""Text."""\n\n# why\na = f(b,\n      c)  # what\n')
    assert dict(lines) == {4: 6, 5: 2}


@pytest.mark.parametrize(("name", "said"), [("settled", True), ("_told", True), ("made_folders", True),
                                            ("speed", False), ("check_inputs", False), ("feed_rate", False)])
def test_a_participle_is_known_by_its_first_word(name: str, said: bool) -> None:
    assert house.is_participle(name) == said
