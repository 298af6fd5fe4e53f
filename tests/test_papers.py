"""The manual's pages on the papers: their numbers are what the code gives, and their commands and sources are there."""

import ast
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from benchmarks import papers
from benchmarks._paper_rows import PAPERS

ROOT = Path(__file__).resolve().parents[1]
MANUAL = ROOT / "resources" / "manual"
HEAD = "| quantity | printed | ours | command |"
QUICK = "python -m benchmarks papers"
SECTIONS = [
    "What the paper claims",
    "The numbers",
    "What its print gets wrong",
    "What is better here",
    "Where this falls short",
]
PAGES = {key: f"papers-{key[:-4]}-{key[-4:]}.md" for key in PAPERS}
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?")


class TableRow(NamedTuple):
    quantity: str
    printed: str
    ours: str
    command: str


def text_of(name: str) -> str:
    return (MANUAL / name).read_text(encoding="utf-8")


def table_rows(text: str) -> list[TableRow]:
    """Rows of the tables of a page that have a command."""
    found = []
    for block in text.split(HEAD)[1:]:
        lines = block.split("\n\n")[0].splitlines()[2:]
        found += [TableRow(*(cell.strip() for cell in line.strip("|").split(" | "))) for line in lines]
    return [row._replace(command=row.command.strip("` ")) for row in found]


def numbers(text: str) -> list[str]:
    return NUMBER.findall(text)


def claimed(key: str) -> dict[str, list[TableRow]]:
    """Rows of a page by command."""
    found: dict[str, list[TableRow]] = {}
    for row in table_rows(text_of(PAGES[key])):
        found.setdefault(row.command, []).append(row)
    return found


@pytest.mark.parametrize("key", PAGES)
def test_a_page_has_its_five_sections_and_names_its_source(key: str) -> None:
    text = text_of(PAGES[key])
    assert re.findall(r"^## (.+)$", text, re.MULTILINE) == SECTIONS
    assert f"Source: [{key}]" in text and text.count(HEAD) == 1


@pytest.mark.parametrize("key", PAGES)
def test_quick_numbers_are_what_the_code_gives(key: str) -> None:
    """Word for word, and no row that the benchmark has is left out."""
    on_page = [row[:3] for row in claimed(key)[QUICK]]
    assert on_page == [tuple(row) for row in PAPERS[key]()]


def test_every_command_is_there() -> None:
    commands = {command for key in PAGES for command in claimed(key)}
    commands |= {row.command for row in table_rows(text_of("papers.md"))}
    assert len(commands) > 5
    for command in commands:
        words = command.split()
        assert words[:2] == ["python", "-m"], command
        assert words[2] == "benchmarks" or words[2].startswith("benchmarks."), command
        name, given = (words[3], words[4:]) if words[2] == "benchmarks" else (words[2].partition(".")[2], words[3:])
        module = ast.parse((ROOT / "benchmarks" / f"{name}.py").read_text(encoding="utf-8"))
        functions = {node.name for node in module.body if isinstance(node, ast.FunctionDef)}
        assert "main" in functions, command
        if words[2] == "benchmarks":
            assert given in ([], ["--short"]), command
            assert given == [] or "short" in functions, command


@pytest.mark.parametrize("name", ["papers.md", *PAGES.values()])
def test_sources_are_in_references_bib(name: str) -> None:
    known = set(re.findall(r"@\w+\{(\w+),", (ROOT / "resources" / "references.bib").read_text(encoding="utf-8")))
    cited = set(re.findall(r"\[([a-z]+[0-9]{4}[a-z]?)\]", text_of(name)))
    assert cited and cited <= known, cited - known


@pytest.mark.parametrize("key", PAGES)
def test_numbers_of_the_prose_are_in_the_table(key: str) -> None:
    """Figures with decimals that stand for results, so that no sentence keeps what its table has lost."""
    text = text_of(PAGES[key])
    cells = " ".join(cell for row in table_rows(text) for cell in row[:3])
    measured = {one.lstrip("-") for one in numbers(cells.replace("%", " "))}
    prose = text.partition("## What is better here")[2]
    told = [one for one in numbers(re.sub(r"`[^`]*`|\]\([^)]*\)", " ", prose)) if "." in one]
    assert told and {one for one in told if one.lstrip("-") not in measured} == set()


def test_the_overview_repeats_the_pages() -> None:
    overview = table_rows(text_of("papers.md"))
    every = {tuple(row) for key in PAGES for row in table_rows(text_of(PAGES[key]))}
    assert len(overview) >= 2 * len(PAGES)
    assert [row.quantity for row in overview if tuple(row) not in every] == []


def test_the_benchmark_prints_the_rows(capsys: pytest.CaptureFixture[str]) -> None:
    assert papers.run_with(["stheta2023"]) == 0
    printed = capsys.readouterr().out
    assert all(f"| {row.quantity} | {row.printed} | {row.ours} |" in printed for row in claimed("stheta2023")[QUICK])
    assert papers.run_with(["nobody1999"]) == 2 and "nobody1999" in capsys.readouterr().out


SLOW = sorted({command for key in PAGES for command in claimed(key) if command != QUICK})


@pytest.mark.long
@pytest.mark.parametrize("command", SLOW)
def test_slow_numbers_are_what_the_command_prints(command: str) -> None:
    """Every number of the rows stands in the command's output."""
    run = subprocess.run([sys.executable, *command.split()[1:]], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    printed = {one.lstrip("-") for one in numbers(run.stdout.replace("%", " "))}
    lost = {
        (row.quantity, one)
        for key in PAGES
        for row in claimed(key).get(command, [])
        for one in numbers(row.ours.replace("%", " "))
        if one.lstrip("-") not in printed
    }
    assert lost == set()
