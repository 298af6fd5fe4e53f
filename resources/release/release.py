"""Build a release and check it: ``python resources/release/release.py OUT`` (``make release``).

Builds the wheel and the archive of sources, compares both with contents.toml, reads their metadata strictly, checks
the add-on's metadata, writes the conda recipe and the entries for FreeCAD's and CadQuery's indices, installs the wheel
in clean environments, one for each CAD kernel and each Python that is named, and runs the demo there.
"""

import argparse
import configparser
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
import tomllib
import zipfile
from fnmatch import fnmatchcase
from pathlib import Path
from xml.etree import ElementTree

sys.path.insert(0, str(Path(__file__).parent))

from addresses import ROOT, read_addresses, rewritten_files, stand_ins

HERE = Path(__file__).parent
KERNELS = ("cadquery", "build123d")
#: Where names of a FreeCAD add-on stand.
SPACE = "{https://wiki.freecad.org/Package_Metadata}"
#: What is ours and must not reach a clean environment.
OURS = ("PYTHON", "TOOLAXIS", "VIRTUAL")


def clean_environment() -> dict[str, str]:
    """The environment variables of a shell that knows nothing of the clone."""
    return {name: value for name, value in os.environ.items() if not name.startswith(OURS)}


class NotReady(SystemExit):
    """Something that keeps the release back, in one sentence."""


def read_metadata() -> configparser.ConfigParser:
    """What setup.cfg says."""
    found = configparser.ConfigParser(interpolation=None)
    found.read(ROOT / "setup.cfg", encoding="utf-8")
    return found


def build_archives(out: Path) -> tuple[Path, Path]:
    """Build wheel and archive of sources from a copy of the files under version control; their paths."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        for name in filter(None, names.split("\0")):
            if (ROOT / name).is_file():
                (Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, Path(folder) / name)
        built = []
        for kind in ("wheel", "sdist"):
            code = f"import sys, setuptools.build_meta as made\nprint(made.build_{kind}(sys.argv[1]))"
            done = subprocess.run([sys.executable, "-c", code, str(out.resolve())], cwd=folder, capture_output=True,
                                  text=True, check=False)
            if done.returncode:
                raise NotReady(f"the {kind} cannot be built:\n{done.stderr}")
            built.append(out / done.stdout.split()[-1])
    return built[0], built[1]


def list_contents(archive: Path) -> dict[str, int]:
    """Sizes of the files of an archive by name, the version left out of names."""
    if archive.suffix == ".whl":
        sizes = {one.filename: one.file_size for one in zipfile.ZipFile(archive).infolist() if not one.is_dir()}
    else:
        with tarfile.open(archive) as opened:
            sizes = {one.name: one.size for one in opened if one.isfile()}
    version = re.compile(r"^toolaxis-[\w.]+?(?=/|\.data|\.dist-info)")
    return {version.sub("toolaxis", name): size for name, size in sizes.items()}


def compare_contents(sizes: dict[str, int], patterns: list[str], largest: int) -> list[str]:
    """What is wrong with the contents of an archive, in sentences.

    Parameters
    ----------
    sizes : dict of str to int
        Bytes of each file by name.
    patterns : list of str
        As in contents.toml; a star stands for folders too.
    largest : int
        Bytes.
    """
    faults = [f"{name} is in it, and contents.toml does not name it" for name in sorted(sizes)
              if not any(fnmatchcase(name, pattern) for pattern in patterns)]
    faults += [f"{pattern} of contents.toml is not in it" for pattern in patterns
               if not any(fnmatchcase(name, pattern) for name in sizes)]
    return faults + [f"{name} has {size} bytes: at most {largest} are allowed" for name, size in sizes.items()
                     if size > largest]


def check_archive(archive: Path) -> None:
    """Hold an archive against contents.toml, and read its metadata strictly."""
    from packaging.metadata import Metadata

    with (HERE / "contents.toml").open("rb") as file:
        known = tomllib.load(file)
    wheel = archive.suffix == ".whl"
    faults = compare_contents(list_contents(archive), known["wheel" if wheel else "source"], known["largest"])
    if faults:
        raise NotReady("\n".join(f"{archive.name}: {fault}" for fault in faults))
    if wheel:
        with zipfile.ZipFile(archive) as opened:
            text = opened.read(next(name for name in opened.namelist() if name.endswith("/METADATA")))
    else:
        with tarfile.open(archive) as opened:
            name = next(one for one in opened.getnames() if one.count("/") == 1 and one.endswith("/PKG-INFO"))
            text = opened.extractfile(name).read()
    found, said = Metadata.from_email(text, validate=True), read_metadata()["metadata"]
    if (found.name, str(found.version), found.license_expression or found.license) != (
            said["name"], said["version"], said["license"]) or not found.description:
        raise NotReady(f"{archive.name}: name, version, licence or description are not those of setup.cfg")


def check_addon() -> dict[str, str]:
    """Hold package.xml against setup.cfg, addresses.toml and the files that it names; what the index asks of it."""
    root = ElementTree.parse(ROOT / "package.xml").getroot()
    told = {name: root.findtext(f"{SPACE}{name}") or "" for name in ("name", "version", "date", "icon", "freecadmin",
                                                                     "description", "license")}
    bench = root.find(f"{SPACE}content/{SPACE}workbench")
    missing = [name for name, text in told.items() if not text]
    if missing or bench is None:
        raise NotReady(f"package.xml lacks {', '.join(missing) or 'its workbench'}")
    if told["version"] != read_metadata()["metadata"]["version"]:
        raise NotReady(f"package.xml has version {told['version']}, setup.cfg "
                       f"{read_metadata()['metadata']['version']}")
    place = ROOT / (bench.findtext(f"{SPACE}subdirectory") or "")
    for path in (ROOT / told["icon"], place / "freecad" / "toolaxis" / "init_gui.py",
                 place / (bench.findtext(f"{SPACE}icon") or "?"), ROOT / "LICENSE"):
        if not path.is_file():
            raise NotReady(f"package.xml names {path}, which is not there")
    if (ROOT / told["icon"]).stat().st_size > 10_000:
        raise NotReady(f"{told['icon']} is larger than the 10 kB that FreeCAD's index takes")
    wrong = [path.name for path, text in rewritten_files(read_addresses()).items()
             if path.read_text(encoding="utf-8") != text]
    if wrong:
        raise NotReady(f"{', '.join(wrong)} have other addresses than addresses.toml: run "
                       "python resources/release/addresses.py")
    return told


def write_entries(out: Path, source: Path) -> list[Path]:
    """Write the conda recipe and the entries for the two indices; their paths."""
    from jinja2 import Environment, StrictUndefined

    said, a, addon = read_metadata(), read_addresses(), check_addon()
    version = said["metadata"]["version"]
    values = {**a, "version": version, "source": a["source"].format(version=version),
              "sha256": hashlib.sha256(source.read_bytes()).hexdigest(), "summary": said["metadata"]["description"],
              "license": said["metadata"]["license"], "python": said["options"]["python_requires"].strip(">="),
              "requirements": [re.sub(r"(?=>=)", " ", each) for each in said["options"]["install_requires"].split()]}
    made = []
    for name in ("meta.yaml", "cadquery-plugin.md"):
        template = Environment(undefined=StrictUndefined, keep_trailing_newline=True, autoescape=False).from_string(
            (HERE / f"{name}.j2").read_text(encoding="utf-8"))
        made.append(out / name)
        made[-1].write_text(template.render(values), encoding="utf-8")
    entry = {"toolaxis": [{"repository": a["repository"], "git_ref": a["branch"], "branch_display_name": a["branch"],
                           "zip_url": a["zip"], "freecad_min": f"{addon['freecadmin']}.0", "curated": True}]}
    made.append(out / "freecad-index.json")
    made[-1].write_text(json.dumps(entry, indent=2) + "\n", encoding="utf-8")
    return made


def try_wheel(wheel: Path, kernel: str, python: str) -> str:
    """Install the wheel with a CAD kernel in a clean environment, and do its main job there; what it took."""
    clean = clean_environment()
    with tempfile.TemporaryDirectory() as folder:
        env, work = Path(folder) / "env", Path(folder) / "empty"
        work.mkdir()

        def run(*words: str) -> str:
            done = subprocess.run(words, cwd=work, env=clean, capture_output=True, text=True, check=False)
            if done.returncode:
                raise NotReady(f"{python} with {kernel}: {' '.join(words)} ended with {done.returncode}\n"
                               f"{done.stdout}{done.stderr}")
            return done.stdout

        inside, command, begun = str(env / "bin" / "python"), str(env / "bin" / "toolaxis"), time.monotonic()
        run(python, "-m", "venv", str(env))
        run(inside, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", f"{wheel.resolve()}[{kernel}]")
        installed = time.monotonic()
        run(inside, "-m", "pip", "check")
        run(inside, "-W", "error", "-c", "import toolaxis")
        times = []
        for name in ("first", "second"):
            start = time.monotonic()
            told = json.loads(run(command, "demo", name, "--json"))
            times.append(time.monotonic() - start)
            if told["passed"] is not True or not all((work / each).is_file() for each in [
                    told["plan"], told["verdict"], told["page"], *told["programs"]]):
                raise NotReady(f"{python} with {kernel}: the demo did not pass, or its files are missing")
        run(command, "verify", "second/plan", "--no-pictures")
        size = sum(path.stat().st_size for path in env.rglob("*") if path.is_file() and not path.is_symlink())
    return (f"{python} with {kernel}: installed in {installed - begun:.0f} s, {size / 1e6:.0f} MB; "
            f"demo {times[0]:.0f} s, once compiled {times[1]:.0f} s")


def main() -> None:
    """Do all of it, and say what is ready."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("out", type=Path, help="folder for what is made")
    reader.add_argument("--python", action="append", default=[], metavar="PYTHON",
                        help="Python for the clean environments; may be repeated (default: this one)")
    reader.add_argument("--kernel", action="append", default=[], choices=KERNELS,
                        help="CAD kernel for them; may be repeated (default: both)")
    reader.add_argument("--no-environments", action="store_true", help="install the wheel nowhere")
    given = reader.parse_args()
    check_addon()
    wheel, source = build_archives(given.out)
    for archive in (wheel, source):
        check_archive(archive)
        print(f"{archive}: {archive.stat().st_size / 1000:.0f} kB, {len(list_contents(archive))} files")
    for path in write_entries(given.out, source):
        print(path)
    for python in [] if given.no_environments else given.python or [sys.executable]:
        for kernel in given.kernel or KERNELS:
            print(try_wheel(wheel, kernel, python), flush=True)
    missing = stand_ins(read_addresses())
    if missing:
        print(f"not to be published yet: set {', '.join(missing)} in resources/release/addresses.toml")


if __name__ == "__main__":
    main()
