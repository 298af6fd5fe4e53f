"""Every source that code or manual cites stands in references.bib, and nothing else does."""

import re
from pathlib import Path

ROOT = Path(__file__).parent.parent
KEY = re.compile(r"\[([a-z]+[0-9]{4}[a-z]?)\]")


def test_every_cited_key_is_known() -> None:
    known = set(re.findall(r"@\w+\{(\w+),", (ROOT / "resources" / "references.bib").read_text()))
    files = [path for folder in ("core", "examples", "benchmarks", "tests", "resources")
             for pattern in ("*.py", "*.md") for path in (ROOT / folder).rglob(pattern)]
    cited = {key for path in files for key in KEY.findall(path.read_text(encoding="utf-8"))}
    assert cited - known == set()
    assert "zhu2016" in cited
