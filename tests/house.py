"""Figures of the code itself: ``python tests/house.py`` prints them, tests/test_house.py holds them."""

import ast
import io
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TREES = {"core": ROOT / "core" / "toolaxis", "workbench": ROOT / "workbench" / "freecad" / "toolaxis"}
#: Participles that do not end in "ed".
_IRREGULAR = set("""begun bent bound broken brought built chosen dealt drawn driven fallen fed found given gone heard
                 held hidden kept known laid left lost made met risen seen sent shown sought spent spoken stood sunk
                 taken thrown told torn worn wound written""".split())
_NO_PARTICIPLES = {"exceed", "feed", "need", "proceed", "seed", "shed", "speed"}
_NO_CODE = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING,
            tokenize.ENDMARKER}


def modules(tree: str) -> Iterator[tuple[str, str]]:
    """Path and text of every module of a tree."""
    for path in sorted(TREES[tree].rglob("*.py")):
        yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


def class_homes() -> dict[str, list[str]]:
    """Where each class of both trees is defined, by its name."""
    homes = defaultdict(list)
    for path, text in (found for tree in TREES for found in modules(tree)):
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ClassDef):
                homes[node.name].append(path)
    return dict(homes)


def functions(tree: str) -> list[str]:
    """Names of all functions and methods that are no properties and have no underscores at both ends."""
    names = []
    for _, text in modules(tree):
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                marks = {getattr(mark, "id", getattr(mark, "attr", "")) for mark in node.decorator_list}
                if not (marks & {"property", "cached_property"} or node.name.startswith("__")):
                    names.append(node.name)
    return names


def is_participle(name: str) -> bool:
    """Whether the first word of a name is a participle: it says what became of something and not what is done."""
    word = name.strip("_").split("_")[0]
    return word in _IRREGULAR or (word.endswith("ed") and word not in _NO_PARTICIPLES)


def density(tree: str) -> float:
    """Tokens in a line of code, lines that hold only comments, docstrings or nothing aside."""
    tokens, lines = 0, 0
    for _, text in modules(tree):
        held: set[int] = set()
        found = list(tokenize.generate_tokens(io.StringIO(text).readline))
        for before, token in zip([None, *found], found, strict=False):
            alone = before is None or before.type in (tokenize.NEWLINE, tokenize.NL, tokenize.INDENT, tokenize.DEDENT)
            if token.type in _NO_CODE or (token.type == tokenize.STRING and alone):
                continue
            tokens += 1
            held.update(range(token.start[0], token.end[0] + 1))
        lines += len(held)
    return tokens / lines


def main() -> None:
    """Print the figures."""
    for tree in TREES:
        names = functions(tree)
        share = 100 * sum(map(is_participle, names)) / len(names)
        print(f"{tree}: {density(tree):.1f} tokens a line, "
              f"{share:.1f} % of {len(names)} functions named by a participle")
    homes = class_homes()
    twice = {name: found for name, found in homes.items() if len(found) > 1}
    print(f"{len(homes)} names of classes, {len(twice)} defined twice")
    for name, found in sorted(twice.items()):
        print(f"  {name}: {', '.join(found)}")


if __name__ == "__main__":
    main()
