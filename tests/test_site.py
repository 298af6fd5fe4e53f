"""The site of the manual: all pages are in its contents, formulas are converted, and dead links are found."""

import re
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MANUAL = ROOT / "resources" / "manual"
THEORY = (MANUAL / "theory.md").read_text(encoding="utf-8")
_spec = spec_from_file_location("site_pages", ROOT / "resources" / "site" / "site_pages.py")
assert _spec is not None and _spec.loader is not None
site_pages = module_from_spec(_spec)
_spec.loader.exec_module(site_pages)


def convert(formula: str, display: str) -> str:
    return f"<{display}:{formula.strip()}>"


def test_the_contents_name_every_page_once() -> None:
    named = [name for pages in site_pages.CONTENTS.values() for name in pages]
    assert sorted([*named, "index"]) == sorted(path.stem for path in MANUAL.glob("*.md"))
    told = site_pages.contents_markdown()
    assert told.count("toctree") == len(site_pages.CONTENTS) and all(f"\n{name}\n" in told for name in named)


def test_the_first_page_leads_to_every_other_one() -> None:
    led_to = re.findall(r"\]\(([\w-]+)\.md\)", (MANUAL / "index.md").read_text(encoding="utf-8"))
    assert sorted(led_to) == sorted(name for pages in site_pages.CONTENTS.values() for name in pages)


def test_formulas_are_converted_and_code_is_not() -> None:
    text = "with $a_b$ and\n\n$$ x\n= y $$\n\n`cost $5 or $6` at $ 7\n\n```\necho $HOME:$PATH\n```\n"
    assert site_pages.replace_formulas(text, convert) == (
        'with <inline:a_b> and\n\n<div class="formula"><block:x\n= y></div>\n\n`cost $5 or $6` at $ 7\n\n```\necho '
        "$HOME:$PATH\n```\n")


def test_no_dollar_of_the_manual_is_taken_for_a_formula_elsewhere() -> None:
    for path in MANUAL.glob("*.md"):
        text = path.read_text(encoding="utf-8")
        assert path.name == "theory.md" or site_pages.replace_formulas(text, convert) == text, path.name
    assert "$" not in re.sub(r"`[^`]*`", "", site_pages.replace_formulas(THEORY, convert))


def test_links_get_titles_in_place_of_file_names() -> None:
    assert site_pages.name_links("see [tools.md](tools.md) and [yours](machines.md)") == (
        "see [](tools.md) and [yours](machines.md)")


@pytest.mark.parametrize(("link", "dead"), [
    ("two.html", False), ("two.html#place", False), ("#here", False), ("two.html#gone", True), ("three.html", True),
    ("#gone", True), ("https://elsewhere.test/", True), ("https://elsewhere.test", True), ("data:text/plain,x", False)])
def test_dead_links_are_found(link: str, dead: bool, tmp_path: Path) -> None:
    (tmp_path / "one.html").write_text(f'<p id="here"><a href="{link}">there</a></p>')
    (tmp_path / "two.html").write_text('<h1 id="place"></h1>')
    assert site_pages.find_dead_links(tmp_path) == ([f"one.html: {link}"] if dead else [])


def test_each_formula_of_the_theory_stands_beside_its_source() -> None:
    """Below each displayed formula, before the next one but one ends, a source is named, and a module that is there."""
    for section in THEORY.split("\n## "):
        formulas, sources = section.count("$$") // 2, len(re.findall(r"Source:|ideal_lengths\.py", section))
        assert sources >= (formulas + 1) // 2, section[:40]
    modules = re.findall(r"`((?:\w+/)+\w+\.py)`", THEORY)
    assert len(modules) > 15
    assert [name for name in modules if not (ROOT / "core" / "toolaxis" / name).is_file()] == []


def test_sources_of_the_theory_are_those_of_references_bib() -> None:
    known = set(re.findall(r"@\w+\{(\w+),", (ROOT / "resources" / "references.bib").read_text(encoding="utf-8")))
    text, _, listed = THEORY.partition("## Sources")
    cited = set(re.findall(r"\[([a-z]+[0-9]{4})\]", text))
    assert cited == set(re.findall(r"^\| \[([a-z]+[0-9]{4})\]", listed, re.MULTILINE)) and cited <= known
