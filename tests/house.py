"""Figures of the code itself: ``python tests/house.py`` prints them, tests/test_house.py holds them.

``python tests/house.py --densest 20`` also prints the 20 densest files and functions.
"""

import argparse
import ast
import io
import tokenize
from collections import Counter, defaultdict
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


def code_lines(text: str) -> Counter[int]:
    """How many tokens begin on each line of code; comments, docstrings and empty lines have no entry."""
    tokens: Counter[int] = Counter()
    found = list(tokenize.generate_tokens(io.StringIO(text).readline))
    for before, token in zip([None, *found], found, strict=False):
        alone = before is None or before.type in (tokenize.NEWLINE, tokenize.NL, tokenize.INDENT, tokenize.DEDENT)
        if token.type in _NO_CODE or (token.type == tokenize.STRING and alone):
            continue
        for line in range(token.start[0], token.end[0] + 1):
            tokens[line] += line == token.start[0]
    return tokens


def density(tree: str) -> float:
    """Tokens in a line of code of a tree."""
    counted = [code_lines(text) for _, text in modules(tree)]
    return sum(lines.total() for lines in counted) / sum(map(len, counted))


def densest(tree: str) -> tuple[list[tuple[float, str]], list[tuple[float, str]]]:
    """Files of a tree, and its functions of five lines of code or more, with their tokens a line, the densest first."""
    files, parts = [], []
    for path, text in modules(tree):
        lines = code_lines(text)
        if lines:
            files.append((lines.total() / len(lines), path))
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and node.end_lineno is not None:
                own = [lines[k] for k in range(node.body[0].lineno, node.end_lineno + 1) if k in lines]
                if len(own) >= 5:
                    parts.append((sum(own) / len(own), f"{path}:{node.lineno} {node.name}"))
    return sorted(files, reverse=True), sorted(parts, reverse=True)


def print_densest(count: int) -> None:
    """Print the densest files and functions of both trees."""
    for tree in TREES:
        for title, found in zip(("files", "functions"), densest(tree), strict=True):
            print(f"densest {title} of {tree}, tokens a line")
            for mean, name in found[:count]:
                print(f"  {mean:.1f} {name}")


def main() -> None:
    """Print the figures."""
    options = argparse.ArgumentParser(description="Figures of the code itself.")
    options.add_argument("--densest", type=int, default=0, metavar="N", help="the N densest files and functions too")
    count = options.parse_args().densest
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
    if count:
        print_densest(count)


if __name__ == "__main__":
    main()
