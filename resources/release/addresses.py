"""Write the addresses of addresses.toml into the files that hold them: ``python resources/release/addresses.py``."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def read_addresses() -> dict[str, str]:
    """What addresses.toml says."""
    with (Path(__file__).parent / "addresses.toml").open("rb") as file:
        return tomllib.load(file)


def stand_ins(addresses: dict[str, str]) -> list[str]:
    """Names of the addresses that do not exist yet."""
    return [name for name, text in addresses.items() if ".example" in text]


def rewritten_files(addresses: dict[str, str]) -> dict[Path, str]:
    """Each file that holds addresses, as it has to be."""
    a = addresses
    rules = {"package.xml": {r'<maintainer email="[^"]*">[^<]*<':
                                 f'<maintainer email="{a["email"]}">{a["maintainer"]}<',
                             r'<url type="repository" branch="[^"]*">[^<]*<':
                                 f'<url type="repository" branch="{a["branch"]}">{a["repository"]}<',
                             r'<url type="bugtracker">[^<]*<': f'<url type="bugtracker">{a["issues"]}<',
                             r'<url type="documentation">[^<]*<': f'<url type="documentation">{a["manual"]}<',
                             r'<url type="readme">[^<]*<': f'<url type="readme">{a["readme"]}<'},
             "core/toolaxis/errors.py": {r'(?m)^REPORT_AT = ".*"$': f'REPORT_AT = "{a["issues"]}"'},
             "setup.cfg": {r"(?m)^url = .*$": f"url = {a['repository']}",
                           r"(?m)^    Issues = .*$": f"    Issues = {a['issues']}",
                           r"(?m)^    Manual = .*$": f"    Manual = {a['manual']}"}}
    made = {}
    for name, replacements in rules.items():
        text = (ROOT / name).read_text(encoding="utf-8")
        for pattern, new in replacements.items():
            text, count = re.subn(pattern, lambda _, new=new: new, text)
            if count != 1:
                raise SystemExit(f"{name} has {count} places for {new}: one is needed")
        made[ROOT / name] = text
    return made


def main() -> None:
    """Write the files, and name those that changed."""
    for path, text in rewritten_files(read_addresses()).items():
        if text != path.read_text(encoding="utf-8"):
            path.write_text(text, encoding="utf-8")
            print(f"{path.relative_to(ROOT)} written")


if __name__ == "__main__":
    main()
