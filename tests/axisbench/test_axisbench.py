"""The open benchmark: data come out the same, good entries pass, bad ones fail for their reason, the README runs."""

import csv
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from axisbench.bad import lean_into_the_wall, leave_out_passes, sink_one_point, write_rows
from axisbench.entry import BadEntry, CutterEntry, read_entry, write_entry
from axisbench.faces import build_faces
from axisbench.judge import judge_entry, score_of, working_length
from axisbench.make_data import write_faces, write_parts
from axisbench.problem import DATA, TASKS, UnknownProblem, load_problems, problem_named
from axisbench.score import EntryScore, load_records, score_file, score_folder

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.placement import place
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.numeric.vectors import unit

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "axisbench" / "README.md").read_text(encoding="utf-8")
PLANE = "fixed-axis-plane"


def plane_rows(lines: int = 19, lift: float = 0.0) -> np.ndarray:
    """Passes of a ball end along the plane's normal: rows of pass, tip and axis."""
    face = problem_named(PLANE).face_data
    (p00, p01), (p10, _) = face.points
    axis = unit(np.cross(p10 - p00, p01 - p00))
    rows = []
    for k in range(lines):
        for u in (-0.2, 0.5, 1.2):
            rows.append([k + 1, *(p00 + u * (p10 - p00) + (k + 0.5) / lines * (p01 - p00) + lift * axis), *axis])
    return np.array(rows)


def plane_score(tmp_path: Path, rows: np.ndarray) -> EntryScore:
    write_rows(tmp_path / f"{PLANE}.csv", rows)
    return score_file(tmp_path / f"{PLANE}.csv")


def test_there_are_faces_and_parts_enough_and_each_task_has_problems() -> None:
    problems = load_problems().values()
    faces = {one.data for one in problems if not one.is_part}
    assert len(faces) >= 24 and faces == set(build_faces())
    assert len({one.data for one in problems if one.is_part}) >= 8
    assert {one.task for one in problems} == set(TASKS)
    assert all(one.path.is_file() for one in problems)


def test_faces_are_made_anew_byte_by_byte(tmp_path: Path) -> None:
    written = write_faces(tmp_path)
    assert [path.name for path in written if path.read_bytes() != (DATA / "faces" / path.name).read_bytes()] == []
    assert {path.name for path in written} == {path.name for path in (DATA / "faces").iterdir()}


def test_parts_are_made_anew_byte_by_byte(tmp_path: Path) -> None:
    pytest.importorskip("cadquery")
    # Open CASCADE counts the files that a process has written: no name may hold that number.
    write_parts(tmp_path)
    written = write_parts(tmp_path)
    assert len(written) >= 8
    assert [path.name for path in written if path.read_bytes() != (DATA / "parts" / path.name).read_bytes()] == []


def test_two_orientations_are_the_bound_where_no_hemisphere_holds_the_normals() -> None:
    for one in load_problems().values():
        if one.measured == "orientations":
            face = one.asked[0]
            assert one.bound == 2.0
            assert np.linalg.norm(smallest_cap(face.normal(face.grid(60, 60))).centre) == 0


def test_a_good_entry_passes_and_its_length_is_that_inside_the_face(tmp_path: Path) -> None:
    problem = problem_named(PLANE)
    found = plane_score(tmp_path, plane_rows())
    assert found.judged is not None and found.judged.passed, found.reason
    assert found.judged.passes == 19 and found.judged.orientations == 1
    assert found.judged.gouge < 1e-6 and found.judged.finished > 0.9999
    long = float(np.linalg.norm(problem.face_data.points[1, 0] - problem.face_data.points[0, 0]))
    # A cutter that is no farther than the scallop height reaches half a strip beyond the border.
    half = np.sqrt(2 * 6 * 1.02 * problem.scallop)
    assert found.judged.length == pytest.approx(19 * (long + 2 * half), rel=0.02)
    assert problem.bound is not None and found.score == pytest.approx(100 * problem.bound / found.judged.length)
    assert 50 < found.score < 100


def test_no_layout_beats_the_bound_on_the_plane(tmp_path: Path) -> None:
    """The fewest passes that the judge accepts are still above it."""
    lengths = [one.judged.length for one in (plane_score(tmp_path, plane_rows(count)) for count in (16, 17, 18))
               if one.judged is not None and one.judged.passed]
    bound = problem_named(PLANE).bound
    assert lengths and bound is not None and bound < min(lengths) < 1.4 * bound


def test_dabs_count_a_diameter_each() -> None:
    problem, rows = problem_named(PLANE), plane_rows(2)[[1, 1, 4, 4]]
    kind = np.array([Motion.LINK, Motion.CUT, Motion.LINK, Motion.CUT], dtype=np.int8)
    dabs = CutterEntry(0, rows[:, 1:4], rows[:, 4:], kind)
    assert working_length(problem.asked[0], problem.tools[0], problem.scallop, dabs) == pytest.approx(24.0)


def test_passes_too_far_apart_fail(tmp_path: Path) -> None:
    found = plane_score(tmp_path, leave_out_passes(problem_named(PLANE), plane_rows()))
    assert found.score == 0 and "times the scallop limit" in found.reason
    assert found.judged is not None and found.judged.finished < 0.8


def test_passes_in_the_air_finish_nothing(tmp_path: Path) -> None:
    found = plane_score(tmp_path, plane_rows(lift=0.5))
    assert found.score == 0 and found.judged is not None and found.judged.finished == 0 and found.judged.length == 0


def test_one_point_too_deep_fails(tmp_path: Path) -> None:
    found = plane_score(tmp_path, sink_one_point(problem_named(PLANE), plane_rows()))
    assert found.score == 0 and "gouge 0.1000 mm" in found.reason


def test_right_points_with_a_wrong_way_between_them_fail(tmp_path: Path) -> None:
    """The tips stand on the face, and the straight way from one to the next goes through it."""
    problem = problem_named("passes-tube")
    face, axis = problem.asked[0], problem.axis
    assert axis is not None
    u0, u1, v0, v1 = face.bounds
    ends = np.array([[u0, (v0 + v1) / 2], [u1, (v0 + v1) / 2]])
    tips = place(face, problem.tools[0], ends, axis)
    path = tmp_path / f"{problem.name}.csv"
    write_rows(path, np.column_stack([[1, 1], tips, np.tile(axis, (2, 1))]))
    found = score_file(path)
    assert found.score == 0 and found.judged is not None and found.judged.gouge > 0.1


def test_a_holder_in_the_wall_fails(tmp_path: Path) -> None:
    problem = problem_named("fixed-axis-wall")
    rows = np.array([[1, 0.0, y, 1.0, 0.0, 0.0, 1.0] for y in (-5.0, 0.0, 5.0)])
    write_rows(tmp_path / "fixed-axis-wall.csv", lean_into_the_wall(problem, rows))
    found = score_file(tmp_path / "fixed-axis-wall.csv")
    assert found.score == 0 and re.match(r"(shank|holder|cutter) is .* needed", found.reason), found.reason


def test_another_axis_than_the_given_one_fails(tmp_path: Path) -> None:
    problem = problem_named("passes-plane")
    rows = plane_rows()
    rows[:, 4:] = unit(rows[:, 4:] + [0.001, 0.0, 0.0])
    write_rows(tmp_path / "passes-plane.csv", rows)
    found = judge_entry(problem, read_entry(tmp_path / "passes-plane.csv", problem))
    assert problem.axis is not None and "which the problem gives" in found.reason
    assert score_of(problem, found, 100.0) == 0


@pytest.mark.parametrize(("text", "words"), [
    ("", "begins with 'nothing': its first line must be pass,x,y,z,i,j,k"),
    ("x,y,z\n1,2,3\n", "begins with 'x,y,z'"),
    ("pass,x,y,z,i,j,k\n", "has 0 rows"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n1,0,0,0,0,0\n", "row 2 has 6 columns: 7 are needed"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n1,nan,0,0,0,0,1\n", "row 2 is '1,nan,0,0,0,0,1': every number must be finite"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n1,a,0,0,0,0,1\n", "row 2 is '1,a,0,0,0,0,1': every column must be a number"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n1,1,0,0,0,0,2\n", "row 2: the axis is 2 long"),
    ("pass,x,y,z,i,j,k\n1.5,0,0,0,0,0,1\n1,1,0,0,0,0,1\n", "row 1: pass is 1.5"),
    ("pass,x,y,z,i,j,k\n0,0,0,0,0,0,1\n0,1,0,0,0,0,1\n", "row 1: no pass begins here"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n2,1,0,0,0,0,1\n", "row 1: no pass begins here"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n1,1e9,0,0,0,0,1\n", "row 2: the tip is 1e+09 mm away"),
    ("pass,x,y,z,i,j,k\n1,0,0,0,0,0,1\n1,1,0,0,0,0.6,0.8\n", "row 2: the axis turns by 36.9 deg")])
def test_what_cannot_be_judged_is_refused_in_a_sentence(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / f"{PLANE}.csv").write_text(text)
    with pytest.raises(BadEntry, match=re.escape(words)):
        read_entry(tmp_path / f"{PLANE}.csv", problem_named(PLANE))
    found = score_file(tmp_path / f"{PLANE}.csv")
    assert found.refused and found.score == 0 and words in found.reason


def test_unknown_problems_and_empty_folders_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UnknownProblem, match="no problem is called 'fixed-axis-pear'"):
        problem_named("fixed-axis-pear")
    with pytest.raises(BadEntry, match="has no entries"):
        score_folder(tmp_path)
    with pytest.raises(BadEntry, match="is no folder"):
        score_folder(tmp_path / "none")


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    problem = problem_named(PLANE)
    write_rows(tmp_path / f"{PLANE}.csv", plane_rows(3))
    (once,) = read_entry(tmp_path / f"{PLANE}.csv", problem)
    write_entry(tmp_path / "again.csv", [(0, once.path)])
    (again,) = read_entry(tmp_path / "again.csv", problem)
    assert np.abs(once.tips - again.tips).max() <= 1e-6 and (once.kind == again.kind).all()
    high = once.tips[once.kind == Motion.LINK] @ plane_rows(3)[0, 4:]
    assert high.max() > (plane_rows(3)[:, 1:4] @ plane_rows(3)[0, 4:]).max() + 15  # drawn back between the passes


def test_records_and_tables_are_of_the_problems_there_are() -> None:
    assert set(load_records()) <= set(load_problems())
    for task in TASKS:
        with (ROOT / "axisbench" / "results" / f"{task}.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        assert rows and {row["problem"] for row in rows} == {name for name, one in load_problems().items()
                                                            if one.task == task}


def test_the_entry_of_the_readme_runs_and_passes(tmp_path: Path) -> None:
    (code,) = re.findall(r"^```python\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    (tmp_path / "ENTRY").mkdir()
    code = code.replace("axisbench/data", (ROOT / "axisbench" / "data").as_posix())
    subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=tmp_path, check=True, timeout=60)
    done = subprocess.run([sys.executable, "-m", "axisbench", "score", str(tmp_path / "ENTRY")], cwd=ROOT,
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 passed" in done.stdout
    (tmp_path / "ENTRY" / "fixed-axis-pear.csv").write_text("pass,x,y,z,i,j,k\n")
    done = subprocess.run([sys.executable, "-m", "axisbench", "score", str(tmp_path / "ENTRY")], cwd=ROOT,
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 2 and "no problem is called 'fixed-axis-pear'" in done.stdout


def test_the_tables_of_the_readme_count_what_there_is() -> None:
    told = re.search(r"(\d+) faces and (\d+) whole parts with exact data, (\d+) problems", README)
    assert told is not None
    problems = load_problems().values()
    assert [int(value) for value in told.groups()] == [len(build_faces()), len({p.data for p in problems if p.is_part}),
                                                       len(problems)]
    assert all(f"`{task}`" in README for task in TASKS)


def test_a_tool_that_the_part_has_not_is_refused(tmp_path: Path) -> None:
    name = "whole-part-mould"
    (tmp_path / f"{name}.csv").write_text("tool,pass,x,y,z,i,j,k\n2,1,0,0,50,0,0,1\n2,1,1,0,50,0,0,1\n")
    with pytest.raises(BadEntry, match="row 1: tool is 2; it must be a whole number from 1 to 1"):
        read_entry(tmp_path / f"{name}.csv", problem_named(name))


def test_an_apt_file_is_an_entry_too(tmp_path: Path) -> None:
    rows = plane_rows()
    lines = ["PARTNO/PLANE", "UNITS/MM", "MULTAX/ON"]
    for number in range(1, 20):
        here = rows[rows[:, 0] == number, 1:]
        high = here[0, :3] + 60 * here[0, 3:], here[-1, :3] + 60 * here[-1, 3:]
        goto = [f"GOTO/{','.join(f'{value:.6f}' for value in (*tip, *here[0, 3:]))}"
                for tip in (high[0], *here[:, :3], high[1])]
        lines += ["RAPID", goto[0], "RAPID", goto[1], "FEDRAT/1000,MMPM", *goto[2:-1], "RAPID", goto[-1]]
    (tmp_path / f"{PLANE}.apt").write_text("\n".join([*lines, "FINI"]) + "\n")
    found = score_file(tmp_path / f"{PLANE}.apt")
    assert found.judged is not None and found.judged.passed and found.judged.passes == 19, found.reason
    assert found.score == pytest.approx(plane_score(tmp_path, rows).score, rel=1e-3)
