"""`make bench`: a benchmark that cannot run here says why, and the others go on; real parts go through the command."""

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from benchmarks._bounded import Bounds, MessageLine, Ran, python, run
from benchmarks._faces import kind_of, outcomes
from benchmarks._iso_scallop import BORDERS, length_from_border
from benchmarks._rack import chosen, given
from benchmarks.real_parts import account_of_part, areas_of

from toolaxis.path.parametrization import Cut
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

ROOT = Path(__file__).resolve().parents[1]
_PLANE = np.array([[[x, y, 0.0] for y in (0, 10, 20, 30, 40)] for x in (0, 15, 30, 45, 60)])


def test_benchmarks_go_on_where_there_is_no_freecad() -> None:
    if find_spec("FreeCAD") is not None:
        pytest.skip("FreeCAD can be imported here")
    without = {name: value for name, value in os.environ.items() if name != "TOOLAXIS_FREECAD"}
    run = subprocess.run([sys.executable, "-m", "benchmarks", "freecad_panel", "startup"], cwd=ROOT, env=without,
                         capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stderr
    assert run.stdout.count("not measured: no FreeCAD") == 2 and "--- startup" in run.stdout


def test_operations_are_counted_as_they_run() -> None:
    code = ("from benchmarks._count import KINDS, TALLY, counted, root\n"
            "import numpy as np\n"
            "x = counted(np.array([3.0, 4.0]))\n"
            "y = -root(x[0] ** 2 + x[1] * x[1]) / 2.0 - abs(1.0 - x[0])\n"
            "assert y == -4.5 and [TALLY[kind] for kind in KINDS] == [3, 2, 1, 1], (y, TALLY)\n")
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=60)


def test_the_work_of_workers_counts_as_processor_time() -> None:
    code = ("import subprocess, sys, time\n"
            "from benchmarks.growth import processor\n"
            "before, own = processor(), time.process_time()\n"
            "work = 'import time\\nwhile time.process_time() < 0.5: pass'\n"
            "subprocess.run([sys.executable, '-c', work], check=True)\n"
            "own = time.process_time() - own\n"
            "assert processor() - before >= 0.45 + own, (processor() - before, own)\n")
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=60)


def test_offset_passes_on_a_plane_lie_a_strip_apart() -> None:
    """The classical passes that fields are compared with: from any border as many as strips fit in."""
    face, cut = Face.from_bspline(_PLANE), Cut(Tool.ball(diameter=12), np.array([0.2, 0.1, 0.97]), 0.02)
    strip = 2 * np.sqrt(2 * 6 * 0.02 - 0.02**2)
    for border in BORDERS:
        wide, long = (60.0, 40.0) if border.across == 0 else (40.0, 60.0)
        found = length_from_border(face, cut, border) / long
        assert wide / strip - 1 <= found <= wide / strip + 1


def _real_parts(*words: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, "-m", "benchmarks", "real_parts", *words], cwd=ROOT, capture_output=True,
                          text=True, timeout=600)


def test_a_part_goes_through_the_command_and_is_compared(tmp_path: Path) -> None:
    ran = _real_parts("examples/saddle.step", "--sample", "1", "--tool", "ball:20", "--scallop", "0.5", "--out",
                      str(tmp_path / "new.json"))
    assert ran.returncode == 0, ran.stderr
    result = json.loads((tmp_path / "new.json").read_text())
    (part,) = result["parts"]
    (row,) = part["rows"]
    assert (row["face"], row["outcome"], row["verified"]) == (1, "verified", True)
    assert row["verified_area"] == pytest.approx(row["area"], rel=1e-3) and row["plan_seconds"] > 0
    assert part["passed"] and all(part["processes"][name]["code"] == 0 for name in ("inspect", "plan", "verify"))
    assert "1 faces drawn, 1 verified (100.0 %)" in ran.stdout
    row.update(outcome="failed", kind="judged fail", verified=False, verified_area=0.0, judge_reasons=["gouge"])
    (tmp_path / "worse.json").write_text(json.dumps(result))
    worse = _real_parts(str(tmp_path / "worse.json"), "--compare", str(tmp_path / "new.json"))
    assert "LESS" in worse.stdout and "LOST face 1" in worse.stdout and "judged fail: gouge" in worse.stdout
    assert "planned but not verified: 1 (judged fail)" in worse.stdout


def test_areas_of_a_stopped_plan_are_those_of_its_account() -> None:
    """Found: what was not begun was missing, and the benchmark put the sculptured faces of the part in its place."""
    told = {"area": 90.0, "machined": 0.0, "unreachable": 10.0, "not_begun": 60.0, "open": 20.0}
    judged = {"area": 90.0, "verified": 5.0, "unreachable": 10.0, "not_begun": 60.0}
    assert account_of_part({"part": told}, None) == {**judged, "verified": 0.0}
    assert account_of_part({"part": told}, {"part": judged}) == judged
    earlier = {name: area for name, area in told.items() if name != "not_begun"}
    assert account_of_part({"part": earlier}, None) is None is account_of_part(None, None)
    part = {"outcome": "cancelled", "sculptured_area": 120.0, "whole": judged, "rows": []}
    assert areas_of(part) == (90.0, 5.0), "an avoided face is none that was asked for"
    assert areas_of({**part, "whole": {"area": 90.0, "verified": 5.0}}) == (120.0, 5.0)


def test_claims_of_a_part_are_attacked_and_printed() -> None:
    ran = subprocess.run([sys.executable, "-m", "benchmarks", "out_of_reach", "examples/saddle.step", "--points", "2",
                          "--axes", "40", "--pairs", "2000"], cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert ran.returncode == 0, ran.stderr
    heading, line = ran.stdout.splitlines()
    names, values = heading.replace("miss mm", "miss").replace("proof s", "proof").replace("force s", "force"), line
    row = dict(zip(names.split(), values.split(), strict=True))
    assert row["part"] == "saddle.step" and row["against"] == "0" and row["open"] == row["reached"] == "2"
    nowhere = subprocess.run([sys.executable, "-m", "benchmarks", "out_of_reach", "tests/machine"], cwd=ROOT,
                             capture_output=True, text=True, timeout=60)
    assert nowhere.returncode == 2 and "no STEP file" in nowhere.stderr


def test_a_process_past_its_time_may_put_away_what_it_has(tmp_path: Path) -> None:
    polite = ("import signal, sys, time\n"
              "signal.signal(signal.SIGTERM, lambda *_: sys.exit('asked to stop'))\n"
              "print('begun', file=sys.stderr, flush=True)\n"
              "while True: pass")
    ran = run(python("-c", polite), Bounds(0.5, 2**32), tmp_path)
    assert (ran.ended, ran.killed) == ("time", False)
    assert [line.text for line in ran.lines] == ["begun", "asked to stop"]
    assert 0.4 < ran.cpu < 5 and ran.peak > 1e6
    deaf = "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nwhile True: pass"
    assert run(python("-c", deaf), Bounds(0.5, 2**32), tmp_path).killed
    asleep = "import time\ntime.sleep(60)"
    ran = run(python("-c", asleep), Bounds(0.2, 2**32), tmp_path)
    assert (ran.ended, ran.killed) == ("clock", False) and ran.wall < 20
    behind = "import subprocess, sys\nsubprocess.run([sys.executable, '-c', 'while True: pass'])"
    assert run(python("-c", behind), Bounds(0.5, 2**32), tmp_path).ended == "time"


def test_a_process_short_of_memory_is_seen_as_such(tmp_path: Path) -> None:
    ran = run(python("-c", "bytearray(2**31)"), Bounds(20.0, 2**30), tmp_path)
    assert ran.short_of_memory and ran.code == 1 and not ran.ended and ran.last_words == "MemoryError"
    ran = run(python("-c", "print('heard'); print('told')"), Bounds(20.0, 2**30), tmp_path)
    assert (ran.code, ran.output, ran.short_of_memory) == (0, "heard\ntold\n", False)


def _face(number: int, area: float, hollow: float | None) -> dict[str, object]:
    return {"number": number, "area": area, "concave_radius": hollow, "sculptured": True}


def test_the_tool_follows_from_sizes_and_hollow_radii() -> None:
    gentle = [_face(1, 100.0, None), _face(2, 50.0, 90.0)]
    assert chosen({"diagonal": 250.0, "faces": gentle}).name == "torus:12x1.5"
    assert chosen({"diagonal": 20.0, "faces": gentle}).name == "ball:1"
    fillets = [*gentle, _face(3, 1.0, 0.5), _face(4, 60.0, 6.0)]
    assert chosen({"diagonal": 250.0, "faces": fillets}).name == "ball:10"
    assert chosen({"diagonal": 1.0, "faces": fillets}).name == "ball:0.5"
    assert given("tapered:6x3x4").file is None and "holder" in (given("flat:20").file or "")


def test_open_faces_are_grouped_by_what_most_axes_break() -> None:
    tally = "of 1404 axes 300 on the back of the surface, 1063 with a gouge, 41 with a collision of the holder"
    assert kind_of(["no axis found: the holder meets face 3 by 2 mm at (0, 0, 0)", tally]) == "gouge"
    assert kind_of(["the normals of face 3 fill more than a hemisphere, and no axis is within"]) == "normals spread"
    now = "1404 axes tested: 300 too far from a normal, 41 too near to a normal for the flat bottom, 9 with a gouge"
    assert kind_of([now]) == "wanders"
    assert kind_of(["infeasible: no single axis reaches all of face 3: its normals spread up to"]) == "normals spread"
    assert kind_of(["the axis is only 0.10 deg from a normal of face 1: a flat bottom needs a lead"]) == "wanders"
    assert kind_of(["the axis is 93.10 deg from a normal of face 1, and the cutter reaches"]) == "normals spread"
    assert kind_of(["failed: IndexError: index 0 is out of bounds"]) == "exception"
    assert kind_of(["the shank meets face 7 by 1 mm at (0, 0, 0)"]) == "shank" and kind_of(["?"]) == "other"


def test_faces_lost_with_another_ones_exception_are_told_from_it() -> None:
    lines = tuple(MessageLine(cpu, text) for cpu, text in (
        (1.0, "looking for blades"), (2.0, "face 3 (1 of 3): search for the axis"), (5.0, "face 3 (1 of 3): proof"),
        (6.0, "face 7b (2 of 3): axes"), (9.0, "Traceback (most recent call last):"),
        (9.0, '  File "proof.py", line 73'), (9.0, "IndexError: index 0")))
    crashed = Ran(1, 9.5, 9.5, 10**8, "", False, "", lines)
    rows = outcomes({3: 10.0, 7: 20.0, 9: 30.0}, None, crashed, None, None)
    assert [row["kind"] for row in rows] == ["lost: exception", "exception", "not begun: exception"]
    assert [row["plan_seconds"] for row in rows] == [4.0, 3.0, None] and "IndexError" in rows[1]["reasons"][0]
    stopped = crashed._replace(code=130, ended="time")
    plan = {"operations": [{"name": "op01-face3", "face": 3, "faces": [3], "area": 10.0, "cl_file": "op01-face3.apt",
                            "zones": [], "orientation": {"reasons": [], "unreached": 0.25}}]}
    verdict = {"operations": [{"name": "op01-face3", "passed": True, "reasons": []}]}
    rows = outcomes({3: 10.0, 7: 20.0, 9: 30.0}, plan, stopped, verdict, stopped)
    assert [row["kind"] for row in rows] == ["", "time", "not begun: time"]
    assert [row["verified_area"] for row in rows] == [7.5, 0.0, 0.0]
    assert [row["verified"] for row in rows] == [True, False, False]
    piece = {**plan["operations"][0], "name": "op02-face7a", "face": 7, "faces": [7], "area": 5.0}
    plan = {"outcome": "cancelled", "operations": [*plan["operations"], piece]}
    verdict = {"operations": [*verdict["operations"], {**verdict["operations"][0], "name": "op02-face7a"}]}
    rows = outcomes({3: 10.0, 7: 20.0, 9: 30.0}, plan, stopped, verdict, stopped)
    assert [row["kind"] for row in rows] == ["", "not finished: time", "not begun: time"], "a quarter of it is not all"
    assert rows[1]["verified_area"] == 3.75 and not rows[1]["verified"]
