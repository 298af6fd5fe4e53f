"""The manual does what it says: commands and code run; the tour through FreeCAD names what there is."""

import ast
import inspect
import os
import re
import shlex
import shutil
import struct
import subprocess
import sys
from collections.abc import Iterable
from math import radians
from pathlib import Path
from xml.etree import ElementTree

import pytest
from axisbench.__main__ import main as axisbench

import toolaxis
from toolaxis.cli.main import main, parser
from toolaxis.machine.library import library as machines
from toolaxis.machine.library import load_machine
from toolaxis.post.dialects.registry import dialects
from toolaxis.strategies.registry import strategies

ROOT = Path(__file__).parent.parent
MANUAL = ROOT / "resources" / "manual"
TEXT = (MANUAL / "freecad.md").read_text(encoding="utf-8")
PICTURES = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", TEXT)
ADDON = ROOT / "workbench" / "freecad" / "toolaxis"
#: Menu entries and words on panels that are FreeCAD's own, or of a list that is filled later.
OTHERS = {"OK"}


def menu() -> set[str]:
    """All texts of the menu, from the commands' sources."""
    found = set()
    for path in (ADDON / "gui" / "commands").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "QT_TRANSLATE_NOOP":
                found.add(ast.literal_eval(node.args[1]))
    return found


def words() -> set[str]:
    """What stands on the panels, from their layouts."""
    return {(node.text or "").strip() for path in (ROOT / "resources" / "ui").glob("*.ui")
            for node in ElementTree.parse(path).getroot().iter("string")}


def test_the_tour_has_a_picture_for_each_step_that_shows_something() -> None:
    steps = re.findall(r"^## (\d+)\. ", TEXT, re.MULTILINE)
    assert steps == [str(k) for k in range(1, 11)] and len(PICTURES) == 12


@pytest.mark.parametrize("name", PICTURES)
def test_pictures_are_there_and_small(name: str) -> None:
    data = (MANUAL / name).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", data[16:24])
    assert 1100 <= width <= 1300 and 600 <= height <= 900 and len(data) < 150_000


def test_no_picture_of_the_tour_is_left_over() -> None:
    assert {f"figures/{path.name}" for path in (MANUAL / "figures").glob("freecad-*.png")} == set(PICTURES)


def test_every_command_that_is_named_is_in_the_menu() -> None:
    named = {entry.rpartition(" > ")[2] for entry in re.findall(r"\*Tool Axis > ([^*]+)\*", TEXT)}
    assert len(named) >= 8 and named <= menu(), named - menu()


def test_every_word_of_a_panel_that_is_named_stands_there() -> None:
    named = set(re.findall(r"\*\*([^*]+)\*\*", TEXT))
    assert len(named) >= 10 and named <= words() | OTHERS, named - words()


def blocks(page: str, language: str) -> list[str]:
    text = (MANUAL / page).read_text(encoding="utf-8")
    return [code for name, code in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
            if name == language]


def commands(page: str) -> list[list[str]]:
    """The words after `toolaxis` of each command of a page that stands by itself."""
    lines = "\n".join(blocks(page, "")).replace("\\\n", " ").splitlines()
    return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("toolaxis ")]


def spans(page: str) -> list[str]:
    """What stands as code within the sentences of a page."""
    text = re.sub(r"^```.*?^```$", "", (MANUAL / page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    return re.findall(r"`([^`\n]+)`", text)


def test_the_first_part_is_machined_as_the_page_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its commands one after the other, each of which ends with exit code 0, beside the part that the demo writes."""
    pytest.importorskip("OCP")
    found = commands("first-part.md")
    assert found[0] == ["demo", "first"]  # tests/test_wheel.py runs it, from the wheel
    assert [words[0] for words in found[1:]] == ["inspect", "plan", "verify", "post", "report"]
    assert [words[:2] for words in commands("cad.md")] == [["export", "mine"]] * 2
    monkeypatch.chdir(tmp_path)
    (tmp_path / "first").mkdir()
    shutil.copy(ROOT / "examples" / "dish.step", tmp_path / "first" / "dish.step")
    for words in [*found[1:], *commands("cad.md")]:
        assert main([*words, "--no-pictures"] if words[0] in ("plan", "verify") else words) == 0, words
    named = set(re.findall(r"`(mine/[\w./-]+)`", (MANUAL / "first-part.md").read_text(encoding="utf-8")))
    assert named and all((tmp_path / name).is_file() for name in named)
    assert (tmp_path / "mine" / "report.html").is_file()
    assert (tmp_path / "mine" / "plan.step").is_file() and (tmp_path / "mine.glb").is_file()


def test_the_code_of_the_page_on_python_runs() -> None:
    code = blocks("python.md", "python")
    assert len(code) == 3
    done = subprocess.run([sys.executable, "-W", "error", "-c", "\n".join(code)], cwd=ROOT, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr


def test_the_targets_and_extras_of_the_page_on_installing_are_there() -> None:
    text = (MANUAL / "install.md").read_text(encoding="utf-8")
    for target in sorted(set(re.findall(r"^make (\w+)$|`make (\w+)`", text, re.MULTILINE))):
        subprocess.run(["make", "-n", *filter(None, target)], cwd=ROOT, check=True, capture_output=True)
    extras = (ROOT / "setup.cfg").read_text(encoding="utf-8").split("[options.extras_require]")[1]
    for name in re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", text, re.MULTILINE))):
        assert re.search(rf"^{name} =", extras, re.MULTILINE), name
    version = re.search(r"^version = (.+)$", (ROOT / "setup.cfg").read_text(encoding="utf-8"), re.MULTILINE)
    assert version is not None and f"toolaxis-{version[1]}-py3-none-any.whl" in text


SPANS = [(page.name, span) for page in sorted(MANUAL.glob("*.md")) for span in spans(page.name)]
#: What stands for a value of one's own.
OWN = {"N": "2", "MIN": "5", "WORK": "1000", "NAME": "mikron-ucp-710", "LIBRARY": "general-rack", "DIR": "absent",
       "FILE": "absent.json", "NAME|FILE": "mikron-ucp-710", "PART.step": "absent.step", "JOBS.toml": "absent.toml"}
#: What an option asks for besides.
ASKS_FOR = {"--holder": ["--tool", "ball:8", "--stickout", "60"], "--least-lean": ["--tool", "ball:8"],
            "--offset": ["--machine", "mikron-ucp-710"], "--objective": ["--machine", "mikron-ucp-710"],
            "--method": ["--machine", "mikron-ucp-710"],
            "--roughness": ["--tool", "torus:10x3", "--strategy", "multiscale", "--machine", "bc-table-table"]}
#: Words of pytest, and of the benchmarks.
ELSEWHERE = {"--long", "--short"}


def own_values(words: Iterable[str]) -> list[str]:
    return [OWN.get(word, word) for word in words]


def says_that_the_part_is_absent(words: Iterable[str], capsys: pytest.CaptureFixture[str]) -> None:
    """All else is taken: what is wrong with other values is said before a file is looked for."""
    assert main(own_values(["plan", "absent.step", *words])) == 2
    said = capsys.readouterr().err
    assert re.search(r"absent\.\w+ (does not exist|cannot be read)", said), f"{words}: {said}"


def test_what_options_are_given_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                         capsys: pytest.CaptureFixture[str]) -> None:
    """Options of `toolaxis plan` with their values, and that all others are some command's."""
    monkeypatch.chdir(tmp_path)
    helped = {}
    for name in ("plan", "verify", "post", "reschedule", "report", "export", "batch", "demo", "inspect"):
        with pytest.raises(SystemExit):
            main([name, "--help"])
        helped[name] = set(re.findall(r"--[a-z]+(?:-[a-z]+)*", capsys.readouterr().out))
    planned = []
    for page, span in dict.fromkeys(SPANS):
        if span.startswith("--"):
            options = set(re.findall(r"--[a-z]+(?:-[a-z]+)*", span))
            assert options <= set.union(*helped.values()) | ELSEWHERE, (page, span)
            if options <= helped["plan"] and re.search(r"[ =]\S", span):
                planned.append(shlex.split(span))
    assert len(planned) > 30
    for words in planned:
        says_that_the_part_is_absent([*words, *ASKS_FOR.get(words[0].partition("=")[0], [])], capsys)


def test_commands_within_sentences_are_understood(capsys: pytest.CaptureFixture[str]) -> None:
    found = [span for _, span in SPANS if span.startswith("toolaxis ") and "-" in span and "--help" not in span]
    assert len(set(found)) >= 4
    for span in found:
        words = own_values(shlex.split(span)[1:])
        parser().parse_args([*words, "absent.step"] if words[0] == "plan" else words)


def test_every_call_of_the_package_fits_its_arguments() -> None:
    """`ta.plan(stock=)` too, and methods and names that are not called."""
    calls = 0
    for page, span in dict.fromkeys(SPANS):
        if not re.match(r"(help\()?(ta|toolaxis)\.\w", span) or (page, span) == ("command.md", "toolaxis.plan"):
            continue
        for node in ast.walk(ast.parse(span.replace("=)", "=0)"), mode="eval")):
            if isinstance(node, ast.Attribute) and getattr(node.value, "id", "") in ("ta", "toolaxis"):
                assert hasattr(toolaxis, node.attr), (page, span)
            if isinstance(node, ast.Call) and ast.unparse(node.func).startswith(("ta.", "toolaxis.")):
                taken = inspect.signature(getattr(toolaxis, ast.unparse(node.func).partition(".")[2]))
                taken.bind_partial(*node.args, **{str(word.arg): word.value for word in node.keywords})
                calls += 1
    assert calls > 10


def test_all_that_pages_name_is_there() -> None:
    """Targets of make, benchmarks, and files; tests/test_papers.py looks at those of the papers' tables."""
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    for page, span in SPANS:
        words = span.split()
        if words[0] == "make":
            assert set(words[1:]) <= targets, (page, span)
        if words[:3] == ["python", "-m", "benchmarks"]:
            text = (ROOT / "benchmarks" / f"{words[3]}.py").read_text(encoding="utf-8")
            assert re.search(r"^def (main|run_with)\(", text, re.MULTILINE), (page, span)
            assert words[4:] in ([], ["--short"]) or "def run_with(" in text, (page, span)
        if re.match(r"(tests|examples|benchmarks|resources|axisbench)/", span):
            assert list(ROOT.glob(span.partition("::")[0])), (page, span)


def test_the_script_for_freecad_is_that_of_its_scripts() -> None:
    (span,) = [span for _, span in SPANS if span.startswith("freecad.")]
    module = ast.parse((ADDON / "services" / "api.py").read_text(encoding="utf-8"))
    (function,) = [node for node in module.body if isinstance(node, ast.FunctionDef) and node.name == "plan"]
    call = ast.parse(span, mode="eval").body
    assert isinstance(call, ast.Call)
    assert [ast.unparse(one) for one in call.args] == [one.arg for one in function.args.args]
    given = {word.arg: ast.literal_eval(word.value) for word in call.keywords}
    kind, _, name = given["limits"].partition(":")
    assert given["strategy"] in strategies() and kind == "machine" and name in machines()


def test_the_axes_and_bodies_of_the_page_on_machines_make_a_machine(tmp_path: Path) -> None:
    """With what the page says is still to come: three linear axes, and the axis that carries the cradle."""
    pytest.importorskip("OCP")
    axes, bodies = blocks("machines.md", "toml")
    linear = re.search(r"^\[\[linear\]\].*?(?=^\[\[table)", axes, re.MULTILINE | re.DOTALL)
    table = re.search(r"^\[\[table\]\].*?(?=^\[\[head)", axes, re.MULTILINE | re.DOTALL)
    assert linear is not None and table is not None
    more = [linear[0].replace('"X"', f'"{name}"').replace("[1, 0, 0]", way) for name, way in
            (("Y", "[0, 1, 0]"), ("Z", "[0, 0, 1]"))]
    more.append(table[0].replace('"C"', '"A"').replace("direction = [0, 0, 1]", "direction = [1, 0, 0]"))
    (tmp_path / "mill.toml").write_text("\n".join([axes.partition("[[head]]")[0], *more, bodies]), encoding="utf-8")
    shutil.copy(ROOT / "examples" / "dish.step", tmp_path / "head.step")
    machine = load_machine(str(tmp_path / "mill.toml"))
    assert [axis.name for axis in (*machine.linear, *machine.table)] == ["X", "Y", "Z", "C", "A"]
    assert (machine.linear[0].low, machine.linear[0].high) == (-355, 355)
    assert machine.table[0].drive.velocity == radians(118.8)
    assert {body.name for body in machine.bodies} == {"table", "cradle", "head"}


def test_the_library_and_the_dialects_are_those_of_their_tables() -> None:
    text = (MANUAL / "machines.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| ([\w-]+) \| w ", text, re.MULTILINE)) == set(machines())
    text = (MANUAL / "programs.md").read_text(encoding="utf-8")
    told = dict(re.findall(r"^\| `([\w-]+)` \|.*\| ([\d, ]+) \|", text, re.MULTILINE))
    made = {name: f"{one.digits}, {one.angle_digits}" for name, one in dialects().items()}
    assert told == made | {"apt": "6"}


#: In place of a viewer, and every call of the page after each part.
SHOWN = "shown = []\nshow_object = show = shown.append\n"


def test_the_code_of_the_page_on_cad_runs(tmp_path: Path) -> None:
    """On both libraries, with the calls that its sentences name."""
    for name in ("cadquery", "build123d", "trimesh"):
        pytest.importorskip(name)
    first, second = blocks("cad.md", "python")
    calls = [span for span in spans("cad.md") if re.match(r"(txq|part)\.\w+\(|ta\.(export|to_trimesh)\(", span)]
    assert len(calls) > 8
    named = [f"{span}(plan)" for span in spans("cad.md") if re.fullmatch(r"txb\.\w+", span)]
    code = [SHOWN, first, "import toolaxis as ta", *calls, second, *named, "txb.compound(plan, part)",
            "assert len(shown) == 2"]
    (tmp_path / "examples").mkdir()
    shutil.copy(ROOT / "examples" / "dish.step", tmp_path / "examples")
    done = subprocess.run([sys.executable, "-c", "\n".join(code)], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT / "core")})
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "plan.step").is_file()


def plans(*pages: str) -> list[list[str]]:
    return [[*words, "--no-pictures"] for page in pages for words in commands(page) if words[0] == "plan"]


def test_the_long_commands_are_understood(capsys: pytest.CaptureFixture[str]) -> None:
    """Strategies, and the rack.  tests/job/test_rescheduling.py runs the two that are not plans."""
    assert [words[0] for words in commands("strategies.md")] == ["plan", "plan", "reschedule", "post"]
    for words in commands("strategies.md")[2:]:
        parser().parse_args(words)
    for words in plans("strategies.md", "tools.md"):
        assert (ROOT / words[1]).is_file()
        says_that_the_part_is_absent(words[2:], capsys)


@pytest.mark.parametrize("words", [
    pytest.param(words, id=words[1], marks=[] if "blade" in words else pytest.mark.long)
    for words in plans("strategies.md")])
def test_the_plans_of_the_strategies_are_made(words: list[str], tmp_path: Path,
                                              monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("OCP")
    monkeypatch.chdir(ROOT)
    assert main([*words, "--out", str(tmp_path / "made")]) == 0


@pytest.mark.long
def test_the_rack_machines_what_its_tools_reach(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                capsys: pytest.CaptureFixture[str]) -> None:
    """A strip at the boss's foot stays open, most of it proven to be out of reach: the command ends with 1."""
    pytest.importorskip("OCP")
    (words,) = plans("tools.md")
    monkeypatch.chdir(ROOT)
    assert main([*words, "--out", str(tmp_path / "made")]) == 1
    told = re.search(r"machined: ([\d.]+) of ([\d.]+) mm2 .* out of reach: ([\d.]+) mm2", capsys.readouterr().out)
    assert told is not None
    machined, area, unreachable = map(float, told.groups())
    assert machined > 0.98 * area and machined + unreachable > 0.995 * area


def test_the_problems_of_the_open_benchmark_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    """Its other command, with a folder, is run by tests/axisbench/test_axisbench.py."""
    lines = "".join(blocks("axisbench.md", "")).splitlines()
    assert lines == [".venv/bin/python -m axisbench list", ".venv/bin/python -m axisbench score FOLDER"]
    assert axisbench(["list"]) == 0 and "fixed-axis" in capsys.readouterr().out
