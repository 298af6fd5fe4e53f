"""Pages of the site: their order, formulas as MathML, which needs no script, and links that lead nowhere."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

#: Headings of the contents with the pages below each.
CONTENTS = {"Begin": ("install", "first-part", "freecad"),
            "The command": ("command", "batches"),
            "Scripts": ("python", "cad"),
            "In the shop": ("tools", "machines", "programs", "strategies"),
             "Behind it": ("guarantees", "conventions", "theory", "axisbench"),
             "The papers": ("papers", "papers-zhu-2016", "papers-grandguillaume-2021", "papers-jang-2021",
                            "papers-dong-2023", "papers-stheta-2023")}
#: What the theme says of itself below each page.
CREDITS = ("https://www.sphinx-doc.org/", "https://pradyunsg.me", "https://github.com/pradyunsg/furo")
#: Code, which keeps its dollars, or a formula: displayed, or within a line.
_FORMULA = re.compile(r"(```.*?```|`[^`\n]+`)|\$\$(.+?)\$\$|\$(?!\s)([^$\n]+?)(?<!\s)\$", re.DOTALL)


def contents_markdown() -> str:
    """The contents as Sphinx reads them in the first page."""
    return "".join(f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n" + "\n".join(pages) + "\n```\n"
                   for caption, pages in CONTENTS.items())


def name_links(text: str) -> str:
    """The text with titles of pages, which MyST puts in, where links have the names of their files."""
    return re.sub(r"\[([\w-]+\.md)\]\(\1\)", r"[](\1)", text)


def replace_formulas(text: str, convert: Any) -> str:
    """The text with its formulas converted.

    Parameters
    ----------
    text : str
        Markdown.
    convert : callable
        Makes MathML of LaTeX; `display` says how it is set.
    """
    def replace(found: "re.Match[str]") -> str:
        code, block, line = found.groups()
        if code is not None:
            return code
        made = str(convert(block or line, display="block" if block else "inline"))
        return made if line else f'<div class="formula">{made}</div>'

    return _FORMULA.sub(replace, text)


class _Page(HTMLParser):
    """What a page leads to, and the places in it that links may name."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        known = dict(attrs)
        self.links += [text for name in ("href", "src") if (text := known.get(name))]
        self.places.update(text for name in ("id", "name") if (text := known.get(name)))


def find_dead_links(folder: Path) -> list[str]:
    """Links of a site's pages to files or places that are not there, and to other hosts.

    Parameters
    ----------
    folder : Path
        Of the site; links to other hosts are named too, since nobody looks whether they are alive.
    """
    pages = {}
    for path in sorted(folder.rglob("*.html")):
        pages[path.resolve()] = _Page()
        pages[path.resolve()].feed(path.read_text(encoding="utf-8"))
    dead = []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme in ("data", "javascript") or link in CREDITS:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            missing = parts.netloc or not target.is_file()
            if not missing and parts.fragment and target in pages and not parts.fragment.startswith("__"):
                missing = unquote(parts.fragment) not in pages[target].places
            if missing:
                dead.append(f"{path.relative_to(folder.resolve())}: {link}")
    return dead
