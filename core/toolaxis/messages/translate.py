"""Turn finished English sentences into another language by a catalogue of patterns.

Sentences are made where something is found out, kept in plan.json and in documents in English, and translated only
where they are shown.  An entry is an English sentence with named places and its counterpart with the same places::

    "the {component} collides with {which} by {amount} mm{at?}" = "..."

A place takes any text, but never half a bracket; `COUNTS` take one word, `LABELS` no punctuation, "given"
anything.  One whose name ends in ``?`` is empty or takes what an entry says that begins with a space or with
punctuation: the end of a clause, such as " at {point}".  What stands in a place is translated by the same catalogue, so
that a sentence may hold another one.
"""

import re
import tomllib
from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

_PLACE = re.compile(r"\{(\w+)(\??)\}")
#: Text of a place: brackets stay whole, so that a comma in the coordinates of a point parts no sentence.
_BRACKET = r"\((?:[^()]|\([^()]*\))*\)|\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_TEXT = rf"(?:{_BRACKET}|[^()\[\]])"
#: Places that hold a number or a unit, and those that hold what a face is called or how many there are.
COUNTS = frozenset(("i", "j", "k", "m", "n", "count", "unit"))
LABELS = frozenset(("face", "some"))
#: Places that hold what has to be written as it is: words of inputs, values of Python, names of files and of objects.
AS_WRITTEN = frozenset(("address", "choices", "file", "folder", "forms", "given", "known", "names", "path", "words"))
_WORD, _LABEL = r"[^\s,;:()\[\]]+", r"[^,;:()\[\]]+?"
#: How the end of a clause begins, and how deep ends hang on ends.
_ENDS, _DEEP = (" ", ",", ";", "."), 2
#: Names of options as the command writes them; a window has fields in their place.
_OPTION = re.compile(r"--(?=[a-z])")
#: A number with a decimal point; versions, names of files and what stands in quotation marks are none.
_NUMBER = re.compile(r"(?<![\w.'\"/])([-+]?\d+)\.(\d+(?:e[-+]?\d+)?)(?![\w.'\"])")
#: Numbers in brackets, as of a point or an axis.
_POINT = re.compile(r"[(\[](?:[-+\d.e]+, )+[-+\d.e]+[)\]]")
#: What parts lists, the loosest first.
_SEPARATORS = (". ", "; ", ": ", ", ", " and ", " or ")
#: Sentences that are kept translated: progress repeats the same few, and reasons are shown again and again.
_KEPT = 4096


class MessagePattern(NamedTuple):
    """An English sentence with places.

    Attributes
    ----------
    english : str
    pieces : tuple of str
        What stands between its places: a sentence without one of them is another one.
    form : str
        The counterpart in the other language.
    """

    english: str
    pieces: tuple[str, ...]
    form: str


def places_of(sentence: str) -> list[str]:
    """Names of the places of an entry, with their question marks, in order.

    Parameters
    ----------
    sentence : str
    """
    return ["".join(found) for found in _PLACE.findall(sentence)]


def pieces_of(sentence: str) -> list[str]:
    """What stands between the places of an entry.

    Parameters
    ----------
    sentence : str
    """
    return [piece for k, piece in enumerate(_PLACE.split(sentence)) if k % 3 == 0]


@cache
def languages() -> tuple[str, ...]:
    """Languages that there is a catalogue for, besides English, as "german"."""
    return tuple(sorted({path.stem.partition("-")[0] for path in Path(__file__).parent.glob("*.toml")}))


@cache
def catalogue(language: str) -> dict[str, str]:
    """The entries of a language: English sentence and counterpart.

    Parameters
    ----------
    language : str
        One of `languages`.
    """
    found: dict[str, str] = {}
    for path in sorted(Path(__file__).parent.glob(f"{language}*.toml")):
        for chapter in tomllib.loads(path.read_text(encoding="utf-8")).values():
            found |= chapter
    return found


@cache
def _patterns(language: str) -> tuple[MessagePattern, ...]:
    """Entries with places, those first that say most by themselves; ties in the order of the alphabet."""
    found = [english for english in catalogue(language) if _PLACE.search(english)]
    found.sort(key=lambda english: (-sum(map(len, pieces_of(english))), english))
    forms = catalogue(language)
    return tuple(MessagePattern(english, tuple(filter(None, pieces_of(_OPTION.sub("", english)))), forms[english])
                 for english in found)


@cache
def _entries_without_places(language: str) -> dict[str, str]:
    """Entries without places."""
    return {_OPTION.sub("", english): form for english, form in catalogue(language).items()
            if not _PLACE.search(english)}


@cache
def _pattern(english: str, language: str) -> re.Pattern[str]:
    """What matches the sentences of an entry; a place that occurs twice has the same text both times."""
    made, known = "", set()
    parts = _PLACE.split(_OPTION.sub("", english))
    for k in range(0, len(parts) - 1, 3):
        name, may_miss = parts[k + 1], parts[k + 2]
        text = f"(?:{_clause_ends(language, _DEEP)})?" if may_miss else _text(name)
        made += re.escape(parts[k]) + (f"(?P={name})" if name in known else f"(?P<{name}>{text})")
        known.add(name)
    return re.compile(made + re.escape(parts[-1]))


def _match(one: MessagePattern, text: str, language: str) -> re.Match[str] | None:
    """How a sentence is one of an entry; patterns are made when a sentence has all pieces of theirs, which few have."""
    if not all(piece in text for piece in one.pieces):
        return None
    return _pattern(one.english, language).fullmatch(text)


def _text(name: str) -> str:
    """What a place takes, by its name."""
    if name == "given":
        return ".+?"
    return _WORD if name in COUNTS else _LABEL if name in LABELS else f"{_TEXT}+?"


@cache
def _clause_ends(language: str, deep: int) -> str:
    """What matches any entry that is the end of a clause."""
    ends = [english for english in catalogue(language) if english.startswith(_ENDS) and english not in _SEPARATORS]
    return "|".join(_clause_end(english, language, deep) for english in sorted(ends, key=lambda end: (-len(end), end)))


def _clause_end(english: str, language: str, deep: int) -> str:
    parts = _PLACE.split(_OPTION.sub("", english))
    made = ""
    for k in range(0, len(parts) - 1, 3):
        inner = f"(?:{_clause_ends(language, deep - 1)})?" if deep > 1 else ""
        made += re.escape(parts[k]) + (inner if parts[k + 2] else f"(?:{_text(parts[k + 1])})")
    return made + re.escape(parts[-1])


def matching(sentence: str, language: str) -> str:
    """The English entry that a sentence is of; empty where there is none.

    Parameters
    ----------
    sentence : str
    language : str
        One of `languages`.
    """
    text = _OPTION.sub("", sentence)
    if text in _entries_without_places(language):
        return text
    return next((one.english for one in _patterns(language) if _match(one, text, language)), "")


@lru_cache(_KEPT)
def translate(sentence: str, language: str, point: str = ".") -> str:
    """A sentence in another language; as it is where there is no entry for it.

    Parameters
    ----------
    sentence : str
        English, or a list of sentences joined by semicolons, or led by a name and a colon.
    language : str
        Such as "german"; without a catalogue of its own the sentence stays as it is.
    point : str
        Decimal point of the numbers of what is translated.
    """
    if language not in languages():
        return sentence
    text = _OPTION.sub("", sentence)
    if text in _entries_without_places(language):
        return _entries_without_places(language)[text]
    for one in _patterns(language):
        found = _match(one, text, language)
        if found is not None:
            values = {name: _join_words(value, language) if name in AS_WRITTEN else _value(value, language, point)
                      for name, value in found.groupdict().items()}
            return _PLACE.sub(lambda place, values=values: values[place[1]], one.form)  # type: ignore[misc]
    listed = _list(text, language, point)
    return sentence if listed == text else listed


def _join_words(text: str, language: str) -> str:
    """Words as they are written, with the other language's words between them."""
    for separator in _SEPARATORS:
        text = text.replace(separator, _entries_without_places(language).get(separator, separator))
    return text


def _list(text: str, language: str, point: str) -> str:
    """A list whose items, or some of them, there are entries for."""
    for separator in _SEPARATORS:
        items = _split(text, separator)
        if len(items) < 2:
            continue
        made = [translate(item, language, point) for item in items]
        if made != items:
            return _entries_without_places(language).get(separator, separator).join(made)
    return text


def _split(text: str, separator: str) -> list[str]:
    """Parts of a text between separators outside brackets; a name and what a colon says of it are two."""
    items, start = [], 0
    for found in re.finditer(rf"{_BRACKET}|{re.escape(separator)}", text):
        if found[0] == separator:
            items.append(text[start:found.start()])
            start = found.end()
            if separator == ": ":
                break
    return [*items, text[start:]]


def _value(text: str, language: str, point: str) -> str:
    """What stands in a place, in the other language, with its numbers as they are written there."""
    made = translate(text, language, point)
    if made != text or point == ".":
        return made
    apart = _POINT.sub(lambda found: found[0].replace(", ", "; "), text)
    return _NUMBER.sub(lambda found: f"{found[1]}{point}{found[2]}", apart)
