"""The manual as a site, for Sphinx: `make site` writes it to out/site."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from site_pages import contents_markdown, find_dead_links, name_links, replace_formulas

HERE = Path(__file__).resolve().parent
project, root_doc, language = "toolaxis", "index", "en"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_heading_anchors = 3
highlight_language = "none"  # of blocks that name none: commands
html_theme = "furo"
html_title = "toolaxis"
html_favicon = html_logo = str(HERE.parent / "icons" / "toolaxis.svg")
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_use_index = html_copy_source = html_show_sourcelink = html_show_copyright = False


def change_source(app, name, source):
    """Formulas of a page as MathML, and the contents below the first one."""
    from latex2mathml.converter import convert

    source[0] = replace_formulas(name_links(source[0]), convert) + (contents_markdown() if name == root_doc else "")


def refuse_dead_links(app, reason):
    """End with the links that lead nowhere."""
    if reason is None and (dead := find_dead_links(Path(app.outdir))):
        raise SystemExit("links that lead nowhere:\n" + "\n".join(dead))


def setup(app):
    """Let Sphinx call both."""
    app.connect("source-read", change_source)
    app.connect("build-finished", refuse_dead_links)
