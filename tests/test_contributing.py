"""The recipes of CONTRIBUTING.md: what each adds in one place is known to all doors and goes through."""

import importlib
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.cli.main import main
from toolaxis.job.files.plan_folder import read_json, read_plan
from toolaxis.job.inputs.tool_file import load_tool
from toolaxis.plan.plan import Plan
from toolaxis.post.dialects.registry import dialects
from toolaxis.report.tables import plan_table
from toolaxis.strategies.registry import strategies, title_of
from toolaxis.tools.registry import cutters

ROOT = Path(__file__).resolve().parents[1]
SCALLOP, LIMITS = 0.2, "cone:0,0,1,30"


def recipe(title: str) -> tuple[str, str]:
    """The place that a recipe names, and its code."""
    section = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split(f"### {title}\n")[1].split("\n## ")[0]
    section = section.split("\n### ")[0]
    place = re.search(r"`core/(toolaxis/[\w/.]*NAME[\w/.]*)`", section)
    code = re.search(r"```python\n(.*?)```", section, re.DOTALL)
    assert place is not None and code is not None, title
    return place[1], code[1]


def forget() -> None:
    """What was found is looked for again."""
    importlib.invalidate_caches()
    for registry in (strategies, cutters):
        registry.cache_clear()


@pytest.fixture()
def add(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[object]:
    """Follows a recipe in a folder that the package finds its parts in too."""
    before = set(sys.modules)

    def _add(title: str, name: str) -> None:
        place, code = recipe(title)
        within, _, _ = place.partition("NAME")
        package: ModuleType = importlib.import_module(within.strip("/").replace("/", "."))
        folder = tmp_path / within
        folder.mkdir(parents=True)
        if place.endswith(".py"):
            (folder / f"{name}.py").write_text(code)
        else:
            (folder / name).mkdir()
            (folder / name / "__init__.py").write_text(f'"""{title}."""\n')
            (folder / name / "strategy.py").write_text(code)
        monkeypatch.setattr(package, "__path__", [*package.__path__, str(folder)])
        forget()

    yield _add
    monkeypatch.undo()
    forget()
    for name in set(sys.modules) - before:
        if str(tmp_path) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


def _face() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 24, 5), np.linspace(0, 18, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, np.sin(x / 9) * np.cos(y / 11)], axis=-1))


@pytest.fixture(scope="module")
def sheet(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A STEP file with one wavy face."""
    cadquery = pytest.importorskip("cadquery")
    path = tmp_path_factory.mktemp("step") / "sheet.step"
    rows = [[cadquery.Vector(a, b, np.sin(a / 9) * np.cos(b / 11)) for b in np.linspace(0, 18, 5)]
            for a in np.linspace(0, 24, 5)]
    face = cadquery.Face.makeSplineApprox(rows, tol=1e-3, minDeg=3, maxDeg=3)
    cadquery.exporters.export(cadquery.Workplane(obj=face), str(path))
    return str(path)


def _planned(sheet: str, folder: Path, *words: str) -> Plan:
    """The plan that the command makes and finds to be good."""
    asked = ["plan", sheet, f"--scallop={SCALLOP}", f"--out={folder}", "--workers=1", *words]
    assert main(asked) == 0
    assert main(["verify", str(folder), "--no-pictures"]) == 0
    return read_plan(folder)


def test_a_strategy_is_one_folder(add, sheet: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ta.InvalidInput, match="strategy 'steep' is unknown"):
        ta.plan(_face(), "torus:12x1", SCALLOP, strategy="steep", workers=1)
    add("Add a strategy", "steep")
    made = ta.plan(_face(), "torus:12x1", SCALLOP, strategy="steep", workers=1)
    op, = made.operations
    assert made.outcome == "complete" and op.orientation.lead == pytest.approx(np.radians(20)), op.orientation.reasons
    lean = (op.path.axis * op.path.normal).sum(axis=1)[op.path.kind == Motion.CUT]
    assert np.degrees(np.arccos(lean)) == pytest.approx(20)
    assert ta.verify(made).passed
    assert "checked at points" in str(plan_table(made).caption) and title_of("steep") == "five axes, lead of 20 degrees"
    for given, words in (({"tool": "ball:8"}, "has no flat bottom: take a torus"),
                         ({"machine": "three-axes-fixture"}, "'steep' needs two driven rotary axes"),
                         ({"objective": "time"}, "not time: leave out"),
                         ({"roughness": 0.001}, "applies to strategy 'multiscale' only")):
        with pytest.raises(ta.InvalidInput, match=words):
            ta.plan(_face(), **{"tool": "torus:12x1", "scallop": SCALLOP, "strategy": "steep", **given})
    again = _planned(sheet, tmp_path / "out", "--tool=torus:12x1", "--strategy=steep")
    assert again.inputs.method == "steep" and again.at_points
    assert read_json(tmp_path / "out" / "plan.json")["inputs"]["method"] == "steep"
    assert (tmp_path / "out" / "op01-face1-passes.png").stat().st_size > 10_000
    with pytest.raises(SystemExit):
        main(["plan", "--help"])
    assert "steep: simultaneous five-axis milling" in " ".join(capsys.readouterr().out.split())


def test_a_dialect_is_one_module(add, sheet: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = _planned(sheet, tmp_path / "out", "--tool=ball:8", "--method=normal", "--machine=bc-table-table",
                    "--no-pictures")
    assert main(["post", str(tmp_path / "out"), "--dialect=bare"]) == 2
    assert "dialect 'bare' is unknown" in capsys.readouterr().err
    add("Add a dialect", "bare")
    for dialect in ("bare", "fanuc"):
        assert main(["post", str(tmp_path / "out"), f"--dialect={dialect}"]) == 0
    bare, fanuc = ((tmp_path / "out" / f"program-{name}.nc").read_text().splitlines() for name in ("bare", "fanuc"))
    assert fanuc[0] == fanuc[-1] == "%" and bare == fanuc[1:-1] and len(bare) > len(made.operations[0].path.cl) / 2
    assert "G68.2 without %" in (tmp_path / "out" / "setup-bare.md").read_text()
    with pytest.raises(SystemExit):
        main(["post", "--help"])
    assert "bare: G68.2 without %" in " ".join(capsys.readouterr().out.split())


def test_a_cutter_is_one_module(add, sheet: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ta.InvalidInput, match="write torus:12x1, ball:8, flat:20 or tapered:6x3x4"):
        ta.Tool.parse("button:12x2")
    add("Add a cutter", "button")
    tool = ta.Tool.parse("button:12x2", stickout=60)
    assert (tool.kind, tool.name, tool.radius, tool.corner_radius) == ("button", "button:12x2", 6.0, 2.0)
    assert tool.shop_name == "Round inserts D12 R2, 60 out"
    with pytest.raises(ta.InvalidInput, match="up to a quarter of the diameter"):
        ta.Tool.parse("button:12x4")
    (tmp_path / "mine.toml").write_text('kind = "button"\ndiameter = 12\ncorner_radius = 2\n')
    assert load_tool(str(tmp_path / "mine.toml")).name == "button:12x2"
    made = ta.plan(_face(), tool, SCALLOP, limits=LIMITS, workers=1)
    assert made.outcome == "complete" and ta.verify(made).passed
    same = ta.plan(_face(), ta.Tool.torus(12, 2, stickout=60), SCALLOP, limits=LIMITS, workers=1)
    np.testing.assert_array_equal(made.operations[0].path.cl, same.operations[0].path.cl)
    again = _planned(sheet, tmp_path / "out", "--tool=button:12x2", f"--limits={LIMITS}", "--no-pictures")
    assert again.tools[0].name == "button:12x2"
    assert replace(again.tools[0], kind="torus").name == "torus:12x2"
    with pytest.raises(SystemExit):
        main(["plan", "--help"])
    assert "button:52x6" in capsys.readouterr().out


@pytest.mark.parametrize("registry", [strategies, dialects, cutters], ids=lambda one: one.__name__)
def test_the_manual_names_all_of_them(registry: Callable[[], Mapping[str, object]]) -> None:
    text = (ROOT / "resources" / "manual" / "command.md").read_text(encoding="utf-8")
    assert [name for name in registry() if not re.search(rf"`{name}[`:]", text)] == []
