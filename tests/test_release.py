"""A release is checked before it is published: contents, addresses, recipe and entries; the page that says how."""

import hashlib
import json
import re
import shutil
import subprocess
import tomllib
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FOLDER = ROOT / "resources" / "release"
_spec = spec_from_file_location("release", FOLDER / "release.py")
assert _spec is not None and _spec.loader is not None
release = module_from_spec(_spec)
_spec.loader.exec_module(release)
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("\n## Release\n")[1].split("\n## ")[0]
#: Files in which an address may stand.
HOLD = {"package.xml", "setup.cfg", "core/toolaxis/errors.py", "resources/release/addresses.toml"}


def test_what_is_too_much_missing_or_large_is_named() -> None:
    known = {"toolaxis/a.py": 10, "toolaxis/deep/b.py": 10, "toolaxis/data.toml": 10}
    patterns = ["toolaxis/*.py", "toolaxis/data.toml"]
    assert release.compare_contents(known, patterns, 10) == []
    assert release.compare_contents({**known, "toolaxis/core.dump": 1}, patterns, 10) == [
        "toolaxis/core.dump is in it, and contents.toml does not name it"]
    del known["toolaxis/data.toml"]
    assert release.compare_contents(known, patterns, 10) == ["toolaxis/data.toml of contents.toml is not in it"]
    assert release.compare_contents(known, patterns[:1], 9)[0].startswith("toolaxis/a.py has 10 bytes")


def test_files_hold_the_addresses_of_the_one_place() -> None:
    addresses = release.read_addresses()
    for path, text in release.rewritten_files(addresses).items():
        assert path.read_text(encoding="utf-8") == text, path
    moved = {name: text.replace("toolaxis.example", "code.test/toolaxis") for name, text in addresses.items()}
    assert release.stand_ins(addresses) and not release.stand_ins(moved)
    made = release.rewritten_files(moved)
    assert len(made) == 3 and not any(".example" in text for text in made.values())
    assert 'REPORT_AT = "https://code.test/toolaxis/issues"' in made[ROOT / "core" / "toolaxis" / "errors.py"]


def test_no_other_file_holds_an_address() -> None:
    named = ("*.md", "*.py", "*.toml", "*.cfg", "*.xml", "*.ui", "*.j2", "*.yml")
    folders = [ROOT / name for name in ("core", "workbench", "resources", "examples")]
    files = [path for pattern in named for path in [*ROOT.glob(pattern), *(found for folder in folders
                                                                         for found in folder.rglob(pattern))]]
    assert len(files) > 500
    assert {path.relative_to(ROOT).as_posix() for path in files
            if "toolaxis.example" in path.read_text(encoding="utf-8")} == HOLD


def test_recipe_and_entries_say_what_setup_cfg_and_package_xml_say(tmp_path: Path) -> None:
    yaml = pytest.importorskip("yaml")
    source = tmp_path / "toolaxis.tar.gz"
    source.write_bytes(b"sources")
    recipe, row, index = release.write_entries(tmp_path, source)
    found = yaml.safe_load(recipe.read_text().replace("{{ PYTHON }}", "python"))
    wanted = release.read_metadata()
    version = wanted["metadata"]["version"]
    assert found["package"] == {"name": "toolaxis", "version": version}
    assert found["source"]["sha256"] == hashlib.sha256(b"sources").hexdigest() and version in found["source"]["url"]
    needed = {re.sub(r"\s", "", each) for each in found["requirements"]["run"]}
    assert needed == {*wanted["options"]["install_requires"].split(), "python>=3.11", "cadquery>=2.5"}
    assert "toolaxis = toolaxis.cli.start:command" in wanted["options.entry_points"]["console_scripts"]
    assert found["build"]["entry_points"] == ["toolaxis = toolaxis.cli.start:command"]
    (entry,) = json.loads(index.read_text())["toolaxis"]
    assert entry["repository"] == release.read_addresses()["repository"] and entry["freecad_min"] == "1.0.0"
    assert row.read_text().count("|") == 6 and "{{" not in row.read_text()


@pytest.mark.parametrize(("file", "before", "after", "said"), [
    ("package.xml", "<version>", "<version>9", "package.xml has version 9"),
    ("package.xml", "toolaxis.example/issues", "elsewhere.test", "package.xml have other addresses"),
    ("package.xml", "icons/toolaxis.svg</icon>\n  <content>", "icons/gone.svg</icon>\n  <content>", "not there")])
def test_metadata_that_does_not_fit_is_refused(file: str, before: str, after: str, said: str, tmp_path: Path,
                                               monkeypatch: pytest.MonkeyPatch) -> None:
    release.check_addon()
    for name in ("package.xml", "setup.cfg", "LICENSE", "core/toolaxis/errors.py", "resources/icons/toolaxis.svg",
                 "workbench/freecad/toolaxis/init_gui.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    text = (tmp_path / file).read_text()
    assert before in text
    (tmp_path / file).write_text(text.replace(before, after))
    monkeypatch.setattr(release, "ROOT", tmp_path)
    monkeypatch.setitem(release.rewritten_files.__globals__, "ROOT", tmp_path)
    with pytest.raises(SystemExit, match=said):
        release.check_addon()


def test_the_page_names_what_there_is() -> None:
    """The commands of the page are those of the Makefile and of the scripts, and the files that it names are there."""
    for target in sorted(set(re.findall(r"`make ([\w-]+)", PAGE))):
        subprocess.run(["make", "-n", target], cwd=ROOT, check=True, capture_output=True)
    for script in sorted(set(re.findall(r"`python (resources/[\w/.]+)", PAGE))):
        assert (ROOT / script).is_file()
    assert "--no-environments" in (FOLDER / "release.py").read_text(encoding="utf-8")
    dry = subprocess.run(["make", "-n", "release", "PYTHONS=python3 python3"], cwd=ROOT, check=True,
                         capture_output=True, text=True).stdout
    assert "release.py dist --python /" in dry and dry.count("--python /") == 2
    made = set(re.findall(r"`([\w.-]+\.(?:yaml|json|md))` \|", PAGE))
    assert made == {"meta.yaml", "freecad-index.json", "cadquery-plugin.md"}
    for place in ("setup.cfg", "package.xml", "core/toolaxis/__init__.py"):
        version = release.read_metadata()["metadata"]["version"]
        assert version in (ROOT / place).read_text(encoding="utf-8") and place in PAGE
    assert tomllib.loads((FOLDER / "contents.toml").read_text(encoding="utf-8"))["wheel"]
