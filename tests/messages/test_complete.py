"""Every sentence that core raises or reports, and what the add-on raises, has a German entry.

A new sentence without German fails here.  What the add-on says itself is held by tests/workbench/test_translations.py.
"""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from toolaxis import advice
from toolaxis.messages.translate import catalogue

ROOT = Path(__file__).resolve().parents[2]
CORE, BENCH = ROOT / "core" / "toolaxis", ROOT / "workbench" / "freecad" / "toolaxis"
#: Modules of the add-on whose sentences are not translated by the catalogue, and why.
NOT_BY_CATALOGUE = {
    "__init__.py": "AttributeError of Python, for those who write macros",
    "services/arguments.py": "what a macro got wrong, read in the Python console, which is English",
    "gui/widgets/fields.py": "raised translated, by resources/translations",
}
#: A sentence of the add-on that is caught where it is raised, and goes to the log.
TO_THE_LOG = "operations with given passes have no work plane"
#: Where texts are written in English into files or on the terminal, and why; what is raised there has an entry all
#: the same, but for the command's own.
ENGLISH_THROUGHOUT = {
    "cli/": "the command and its help are English",
    "report/": "the page, its tables and its pictures are English; the window shows the plan itself",
    "strategies/*/pictures.py": "words in pictures of the page",
    "strategies/*/strategy.py": "titles, summaries and notes, which the window takes from resources/translations",
    "post/setup_sheet.py": "the setup sheet is English",
    "post/tcp_program.py": "a note of the setup sheet",
    "post/dialects/": "comments in programs are English",
    "tools/cutters/": "names of kinds of cutters, which the window takes from resources/translations",
    "advice.py": "words that sentences are made of, which have entries of their own",
    "job/planning/failures.py": "error.txt, which is sent in with a report",
}
#: Texts that look like sentences and have no entry of their own, and why.
NO_SENTENCES = {
    "bytes | Nested": "a type",
    "<Plan of \f operations, \f with a path: \f>": "repr in Python",
    "<Part of \f faces, \f sculptured>": "repr in Python",
    "module 'toolaxis' has no attribute \f": "AttributeError of Python, for those who write programs",
    "refinement must end": "assertion of an algorithm",
    "defines entity #\f\f more than once: every number must stand for one entity; export the part again":
        "two entries, without and with further numbers",
    "\f % of the area lies at walls or in corners and \f": "the entry has the words of LEFT_OVER",
    "\f mm2 beside the clamped side \f": "the entry has the words of LEFT_OVER",
    "the \f \f at \f on \f, needed \f mm, \f": "two entries, that comes within and that collides",
}
#: Words of two or more letters that make a text a sentence, where two of them stand apart.
WORD = re.compile(r"(?<!\S)[(\"']?[A-Za-z]?[a-z]+[a-z'-]*[a-z][,.;:)\"']*(?!\S)")
SEPARATORS = (". ", "; ", ": ", ", ", " and ", " or ")


def plain(text):
    """A text as patterns see it, without the command's dashes of options."""
    return re.sub(r"--(?=[a-z])", "", text)


def no_texts(tree):
    """Nodes whose text is no sentence: docstrings, annotations, assertions, keys and names that are looked up."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield node.value
        elif isinstance(node, ast.Assert):
            yield from ast.walk(node)
        elif isinstance(node, (ast.AnnAssign, ast.arg)) and node.annotation:
            yield from ast.walk(node.annotation)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and node.returns:
            yield from ast.walk(node.returns)
        elif isinstance(node, ast.Compare):
            yield from (part for part in (node.left, *node.comparators) if isinstance(part, ast.Constant))


def pieces(node):
    """Text of a node and whether it is one, a form feed for each value; sums and joined texts are one."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else advised(part) for part in node.values)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        left, right = pieces(node.left), pieces(node.right)
        if left is None and right is None:
            return None
        return ("\f" if left is None else left) + ("\f" if right is None else right)
    return None


def advised(value):
    """What a value in a text stands for where it is one of the words of `toolaxis.advice`, else a form feed."""
    name = value.value.id if isinstance(value.value, ast.Name) else ""
    return getattr(advice, name) if name.isupper() and hasattr(advice, name) else "\f"


def texts(tree):
    """Each text of a module with its node: of a sum the whole, and what stands in values by itself."""
    known = {id(node) for node in no_texts(tree)}
    for node in ast.walk(tree):
        if id(node) in known:
            continue
        text = pieces(node)
        if text is None:
            continue
        parts = [node]
        while parts:
            part = parts.pop()
            known.add(id(part))
            if isinstance(part, ast.JoinedStr):
                known.update(id(value) for value in part.values if isinstance(value, ast.Constant))
            elif isinstance(part, ast.BinOp):
                parts += [side for side in (part.left, part.right) if pieces(side) is not None]
        yield node, text


def is_sentence(text):
    """Whether a text has two words beside each other, or more apart."""
    return len(WORD.findall(text)) >= 2


@cache
def shapes():
    """Entries as fixed pieces and a pattern in which a place takes anything, also nothing; the longest come first."""
    found = []
    for entry in sorted(map(plain, catalogue("german")), key=len, reverse=True):
        pieces = re.split(r"\{\w+\??\}", entry)
        found.append((pieces, re.compile(r"(.*?)".join(map(re.escape, pieces)), re.DOTALL)))
    return found


@cache
def all_entries():
    """The English of all entries, a form feed for each place."""
    return "\n".join(re.sub(r"\{\w+\??\}", "\f", plain(entry)) for entry in catalogue("german"))


def is_piece(text):
    """Whether a text is an entry or a whole piece of one, between its ends, places and stops."""
    edge = r"[\n\f,;:.(]"
    return re.search(rf"(?:^|{edge}) ?{re.escape(text)}(?: ?{edge}|\)|$)", all_entries()) is not None


@cache
def has_entry(text, deep=4):
    """Whether a text comes out in German with all that stands in it: by an entry, as part of one, or as a list."""
    bare = text.strip(" ,;:.\f")
    if not re.search(r"[A-Za-z]{2}", bare.replace("\f", " ")) or not WORD.search(bare.replace("\f", " ")):
        return True
    if is_piece(bare):
        return True
    if not deep:
        return False
    for parts, shape in shapes():
        found = shape.fullmatch(text) if all(part in text for part in parts) else None
        if found and all(has_entry(value, deep - 1) for value in found.groups()):
            return True
    return any(all(has_entry(item, deep - 1) for item in text.split(separator))
               for separator in SEPARATORS if separator in text)


def sentences(source):
    """Sentences of a module: line, words, and whether they are raised."""
    tree = ast.parse(source)
    raised = {id(part) for statement in ast.walk(tree) if isinstance(statement, ast.Raise)
              for part in ast.walk(statement)}
    for node, text in texts(tree):
        if is_sentence(text):
            yield node.lineno, plain(text), id(node) in raised


def is_english(path):
    """Whether a module is of those whose words are English throughout."""
    name = path.relative_to(CORE).as_posix()
    return any(path.match(part) if part.endswith(".py") else name.startswith(part) for part in ENGLISH_THROUGHOUT)


def missing(source, english=False):
    """Sentences of a module that have no entry."""
    return [(line, text) for line, text, raised in sentences(source)
            if (raised or not english) and text not in NO_SENTENCES and not has_entry(text)]


@pytest.mark.parametrize("package", sorted(path.name for path in CORE.iterdir() if path.suffix != ".toml"
                                           and path.name not in ("cli", "__pycache__", "py.typed")))
def test_every_sentence_has_an_entry(package):
    paths = sorted((CORE / package).rglob("*.py")) or [CORE / package]
    lost = [f"{path.relative_to(CORE)}:{line}: {text}" for path in paths
            for line, text in missing(path.read_text(encoding="utf-8"), is_english(path))]
    assert not lost, "\n".join(lost).replace("\f", "{}")


def test_every_sentence_that_the_add_on_raises_has_an_entry():
    lost = [f"{path.relative_to(BENCH)}:{line}: {text}" for path in sorted(BENCH.rglob("*.py"))
            if path.relative_to(BENCH).as_posix() not in NOT_BY_CATALOGUE
            for line, text in missing(path.read_text(encoding="utf-8"), english=True) if text != TO_THE_LOG]
    assert not lost, "\n".join(lost).replace("\f", "{}")
    assert all((BENCH / name).is_file() for name in NOT_BY_CATALOGUE)


@pytest.mark.parametrize("source", [
    'raise InvalidInput("the spindle is upside down")',
    'raise InvalidInput(f"the spindle of {machine.name} is {angle:.1f} deg upside down: turn it")',
    'reasons.append(f"the {name} melts at {point}")',
    'why = f"{name}: " + "nobody has an entry for this"',
    'said = f"gouge: {\'quite certain\' if sure else \'not certain\'}"',
    'notes = ("the cutter", "the cutter sings aloud")'])
def test_a_sentence_without_an_entry_is_found(source):
    assert missing(source)


def test_what_is_no_sentence_is_not_missed():
    assert not missing('"""Says what the module does."""\nassert x, "never said to anybody"\n'
                       'def f(a: "list of things | None"): np.einsum("ij,jk->ik", a)')
    assert not missing('raise InvalidInput(f"allowance is {value} mm: it must be zero or more")')


def test_exceptions_are_still_in_the_program():
    every = {text for path in CORE.rglob("*.py") for _, text, _ in sentences(path.read_text(encoding="utf-8"))}
    assert set(NO_SENTENCES) <= every, set(NO_SENTENCES) - every
    for part in ENGLISH_THROUGHOUT:
        assert list(CORE.glob(part)), part
