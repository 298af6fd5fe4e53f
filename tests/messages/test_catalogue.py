"""The catalogues of sentences: what they look for stands in the program, and no place is lost on the way."""

import ast
import re
from functools import cache
from itertools import product
from pathlib import Path

import pytest

from toolaxis.messages.translate import COUNTS, LABELS, catalogue, languages, matching, pieces_of, places_of

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


def variants(node, known):
    """What a node may stand for as a text: of a choice each, a form feed for what is not known."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return [node.value]
    if isinstance(node, ast.FormattedValue):
        return variants(node.value, known)
    if isinstance(node, ast.Name):
        return known.get(node.id, ["\f"])
    if isinstance(node, ast.IfExp):
        return variants(node.body, known) + variants(node.orelse, known)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        return [*variants(node.left, known), ""]
    if isinstance(node, ast.JoinedStr):
        parts = node.values
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        parts = [node.left, node.right]
    else:
        return ["\f"]
    return ["".join(chosen) for chosen in product(*(variants(part, known) for part in parts))]


@cache
def strings():
    """All texts of the program, one after the other, a form feed for each value that is put in."""
    known = {name: texts for name, texts in constants().items() if len(texts) <= MOST}
    found = set()
    for tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, (ast.Constant, ast.JoinedStr, ast.BinOp)):
                found.update(variants(node, known))
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


def filled(english):
    """A sentence of an entry: a number or a word of its own in each place, the ends of its clauses left out."""
    names = dict.fromkeys(places_of(english))
    values = {name: "" if name.endswith("?") else str(k) if name in COUNTS | LABELS else f"Q{k}"
              for k, name in enumerate(names, 3)}
    return re.sub(r"\{(\w+\??)\}", lambda place: values[place[1]], english)


@pytest.mark.parametrize("language", languages())
def test_no_entry_takes_the_sentences_of_another(language):
    taken = {english: found for english in catalogue(language)
             if (found := matching(filled(english), language)) not in (english, english.replace("--", ""))}
    assert not taken, taken


def test_a_sentence_that_changes_is_missed():
    assert "the part was deleted" in strings()
    assert "the part was removed from the document" not in strings()
