"""The catalogues of sentences: what they look for stands in the program, and no place is lost on the way."""

import ast
from functools import cache
from itertools import product
from pathlib import Path

import pytest

from toolaxis.messages.translate import catalogue, languages, pieces_of, places_of

ROOT = Path(__file__).resolve().parents[2]
#: Pieces of a sentence that are shorter say nothing of where they come from.
LEAST = 6
#: How many texts one name may stand for to be put in.
MOST = 6


def trees():
    """The program as syntax trees; not the command, whose words a window does not show."""
    for folder in (ROOT / "core" / "toolaxis", ROOT / "workbench" / "freecad" / "toolaxis"):
        for path in sorted(folder.rglob("*.py")):
            yield ast.parse(path.read_text(encoding="utf-8"))


def constants():
    """Names in capitals that stand for a text in some module, with each text that one stands for."""
    found = {}
    for tree in trees():
        for node in tree.body:
            if not isinstance(node, ast.Assign) or not isinstance(node.targets[0], (ast.Name, ast.Tuple)):
                continue
            target = node.targets[0]
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            values = node.value.elts if isinstance(node.value, ast.Tuple) and len(names) > 1 else [node.value]
            for name, value in zip(names, values, strict=False):
                if isinstance(value, ast.Constant) and isinstance(value.value, str):
                    found.setdefault(name.id, []).append(value.value)
    return found


@cache
def strings():
    """All texts of the program, one after the other, a form feed for each value that is put in."""
    known = {name: texts for name, texts in constants().items() if len(texts) <= MOST}
    found = set()
    for tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.add(node.value)
            elif isinstance(node, ast.JoinedStr):
                choices = [[part.value] if isinstance(part, ast.Constant) else
                           known.get(getattr(part.value, "id", ""), ["\f"]) for part in node.values]
                found.update("".join(chosen) for chosen in product(*choices))
    return "\n".join(sorted(found)).replace("--", "")


def trimmed(piece):
    """A piece of an entry without what joins it to its neighbours."""
    return piece.replace("--", "").strip(" ,;:.")


@pytest.mark.parametrize("language", languages())
def test_what_an_entry_looks_for_still_stands_in_the_program(language):
    texts = strings()
    lost = {english: piece for english in catalogue(language) for piece in map(trimmed, pieces_of(english))
            if len(piece) >= LEAST and piece not in texts}
    assert not lost, "\n".join(f"{english}\n    {piece!r}" for english, piece in lost.items())


@pytest.mark.parametrize("language", languages())
def test_an_entry_has_the_same_places_in_both_languages(language):
    lost = [english for english, form in catalogue(language).items()
            if sorted(set(places_of(english))) != sorted(set(places_of(form)))]
    assert not lost, lost


def test_a_sentence_that_changes_is_missed():
    assert "the part was deleted" in strings()
    assert "the part was removed from the document" not in strings()
