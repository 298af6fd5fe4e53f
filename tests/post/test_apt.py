"""APT CL files: what is written is read back, and what is broken is refused with its line."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.post import apt
from toolaxis.post.apt import apt_text, cutter_statement, locations_text
from toolaxis.post.read_apt import read_apt
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(diameter=12, corner_radius=1)


def path_of(passes: int, points: int, seed: int) -> ToolPath:
    rng = np.random.default_rng(seed)
    count = passes * points
    cl = rng.uniform(-2000, 2000, (count, 3))
    axis = rng.normal(size=(count, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    kind = np.tile([Motion.LINK, Motion.ENTRY, *[Motion.CUT] * (points - 3), Motion.EXIT], passes).astype(np.int8)
    return ToolPath(cl, cl, axis, axis, kind, np.arange(0, count + 1, points))


@settings(deadline=None, max_examples=40)
@given(passes=st.integers(1, 5), points=st.integers(4, 12), seed=st.integers(0, 2**32 - 1))
def test_what_is_written_is_read_back(passes: int, points: int, seed: int) -> None:
    path = path_of(passes, points, seed)
    back = read_apt(apt_text(path, TOOL, "op01-face1", 1200.0, 8000.0))
    assert np.abs(back.tip - path.cl).max() <= 0.5001e-6
    assert np.abs(back.axis - path.axis).max() <= 2e-9
    assert np.array_equal(back.kind, path.kind)
    assert np.array_equal(back.breaks, path.breaks)
    assert np.isinf(back.feedrate[path.kind == Motion.LINK]).all()
    assert (back.feedrate[path.kind != Motion.LINK] == 1200.0).all()


def test_text_of_a_small_path() -> None:
    cl = np.array([[0, 0, 5], [0, 0, 0], [10, 0, 0], [10.25, -0.5, 0], [10.25, -0.5, 5.0]])
    axis = np.tile([0.0, 0.6, 0.8], (5, 1))
    kind = np.array([Motion.LINK, Motion.ENTRY, Motion.CUT, Motion.EXIT, Motion.LINK], dtype=np.int8)
    text = apt_text(ToolPath(cl, cl, axis, axis, kind, np.array([0, 5])), TOOL, "op01-faceé$1", 800, 9000)
    assert text.splitlines() == [
        "PARTNO/op01-face__1", "UNITS/MM", "MULTAX/ON", "CUTTER/12,1,5,1,0,0,24", "LOADTL/1", "SPINDL/RPM,9000,CLW",
        "PPRINT/PASS 1", "PPRINT/LINK", "RAPID",
        "GOTO/0.000000,0.000000,5.000000,0.000000000,0.600000000,0.800000000",
        "PPRINT/ENTRY", "FEDRAT/MMPM,800",
        "GOTO/0.000000,0.000000,0.000000,0.000000000,0.600000000,0.800000000",
        "PPRINT/CUT",
        "GOTO/10.000000,0.000000,0.000000,0.000000000,0.600000000,0.800000000",
        "PPRINT/EXIT",
        "GOTO/10.250000,-0.500000,0.000000,0.000000000,0.600000000,0.800000000",
        "PPRINT/LINK", "RAPID",
        "GOTO/10.250000,-0.500000,5.000000,0.000000000,0.600000000,0.800000000",
        "SPINDL/OFF", "FINI"]


def test_lines_are_continued_at_72_columns() -> None:
    text = apt_text(path_of(2, 6, 1), TOOL, "x" * 200, 800, 9000)
    assert max(map(len, text.splitlines())) <= 72
    assert "$\n" in text


@pytest.mark.parametrize("tool, statement", [
    (Tool.ball(diameter=8), "CUTTER/8,4,0,4,0,0,16"),
    (Tool.flat(diameter=20), "CUTTER/20,0,10,0,0,0,40"),
    (Tool.tapered(diameter=6, corner_radius=3, half_angle_deg=4), "CUTTER/6,3,0,3,0,4,12"),
])
def test_cutter_statement(tool: Tool, statement: str) -> None:
    assert cutter_statement(tool) == statement


def test_words_of_other_writers() -> None:
    text = ("$$ made elsewhere\nPARTNO COVER\nUNITS / INCHES\nMULTAX\nTLAXIS/0,0,1\nRAPID\nGOTO / 1, 0, 0, 0, 0, 1\n"
            "FEDRAT/ 10.0, IPM\nGOTO / 2, 0, $\n 0, 0, 0, 1 $$ on the way\nGOTO/3,0,0\nFINI\n")
    found = read_apt(text)
    assert np.allclose(found.tip, [[25.4, 0, 0], [50.8, 0, 0], [76.2, 0, 0]], atol=1e-12)
    assert np.array_equal(found.axis, np.tile([0.0, 0.0, 1.0], (3, 1)))
    assert found.kind.tolist() == [Motion.LINK, Motion.CUT, Motion.CUT]
    assert found.feedrate.tolist() == [np.inf, 254.0, 254.0]


def test_inches_hold_for_a_run_of_locations_too() -> None:
    rows = [f"GOTO/{k},{2 * k},-1,0,0.6,0.8" for k in range(5)]
    found = read_apt("\n".join(["UNITS/INCHES", "MULTAX/ON", *rows, "FINI"]))
    steps = np.arange(5)[:, None] * [25.4, 50.8, 0.0]
    assert np.allclose(found.tip, steps - [0, 0, 25.4], atol=1e-12) and np.allclose(found.axis, [0, 0.6, 0.8])


def test_words_of_systems_that_end_each_path() -> None:
    text = ("TOOL PATH/CONTOUR_1,TOOL,BULL_12\nTLDATA/MILL,12.0,1.0,60.0,0.0,0.0\nMSYS/0.0,0.0,0.0,1.0,0.0,0.0\n"
            "$$ centerline data\nPAINT/PATH\nSPINDL/RPM,2000,CLW\nRAPID\nGOTO/0.0,0.0,50.0,0.0,0.6,0.8\n"
            "PPRINT DOWN\nFEDRAT/MMPR,0.1\nGODLTA/-10.0\nGODLTA/1.0,2.0,0.0\nEND-OF-PATH\n"
            "TOOL PATH/CONTOUR_2,TOOL,BULL_12\nMSYS/0.0,0.0,0.0,1.0,0.0,0.0\nFEDRAT/10,IPM\n"
            "GOTO/2.0,3.0,40.0\nEND-OF-PATH\n")
    found = read_apt(text)
    assert np.allclose(found.tip, [[0, 0, 50], [0, -6, 42], [1, -4, 42], [2, 3, 40]], atol=1e-12)
    assert np.allclose(found.axis, [0.0, 0.6, 0.8], atol=1e-15) and found.told and found.spindle == 2000.0
    assert np.allclose(found.feedrate, [np.inf, 200.0, 200.0, 254.0])


def test_a_file_without_axes_says_so() -> None:
    found = read_apt("GOTO/0,0,0\nGOTO/1,0,0\nFINI")
    assert not found.told and np.array_equal(found.axis, [[0.0, 0.0, 1.0]] * 2)


@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), rapid_first=st.booleans())
def test_what_was_read_is_written_again(seed: int, rapid_first: bool) -> None:
    rng = np.random.default_rng(seed)
    lines = ["UNITS/MM", "MULTAX/ON", "SPINDL/RPM,8000,CLW", *(["RAPID"] if rapid_first else [])]
    for _ in range(12):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        lines += ["GOTO/" + ",".join(f"{x:.8f}" for x in [*rng.uniform(-99, 99, 3), *axis])]
        lines += [["RAPID"], [f"FEDRAT/MMPM,{rng.integers(1, 9999)}"], []][rng.integers(3)]
    found = read_apt("\n".join([*lines, "FINI"]))
    again = read_apt(locations_text(found, "again", TOOL))
    assert np.abs(again.tip - found.tip).max() <= 0.5001e-6 and np.abs(again.axis - found.axis).max() <= 2e-9
    assert again.kind.tolist() == found.kind.tolist() and again.feedrate.tolist() == found.feedrate.tolist()
    assert again.spindle == found.spindle == 8000.0 and again.breaks.tolist() == found.breaks.tolist()


def test_a_printed_link_is_no_rapid() -> None:
    found = read_apt("PPRINT/LINK\nGOTO/0,0,0,0,0,1\nGOTO/1,0,0,0,0,1\nFINI")
    assert found.kind.tolist() == [Motion.CUT, Motion.CUT]


HEAD = "UNITS/MM\nMULTAX/ON\nGOTO/0,0,0,0,0,1\n"


@pytest.mark.parametrize("text, said", [
    ("", "without FINI"),
    (HEAD + "GOTO/1,0,0,0,0,1\n", "ends without FINI after 2 points"),
    (HEAD + "FINI", "at least two"),
    (HEAD + "GOTO/1,0,x,0,0,1\nFINI", "line 4"),
    (HEAD + "GOTO/1,0,nan,0,0,1\nFINI", "line 4"),
    (HEAD + "GOTO/1,0,0,0,0\nFINI", "line 4: .* has 5 numbers"),
    (HEAD + "GOTO/1,0,0,0,0,2\nFINI", "line 4: the axis .* length 2"),
    (HEAD + "CIRCLE/1,0,0,0,0,1,5\nFINI", "line 4: CIRCLE is not understood"),
    (HEAD + "FEDRAT/MMPM,0\nFINI", "feed rate 0"),
    (HEAD + "FEDRAT/MMPM\nFINI", "line 4: FEDRAT/MMPM has no feed rate"),
    (HEAD + "GOTO/1,0,0,inf,0,1\nFINI", "line 4"),
    (HEAD + "GODLTA/1,2\nFINI", "line 4: GODLTA/1,2 must follow"),
    ("GODLTA/1,2,3\nFINI", "line 1: GODLTA/1,2,3 must follow"),
    (HEAD + "$$ 50 x\nFEDRAT/0.1,MMPR\nFINI", "line 5: .* no SPINDL"),
    (HEAD + "MSYS/0,0,0\nMSYS/0,0,1\nFINI", "line 5: .* another coordinate system"),
    (HEAD + "END-OF-PATH\nGOTO/1,0,0", "without FINI after 2 points, at line 5"),
    (HEAD + "TRANS/1,0,0\nFINI", "line 4: TRANS is not understood"),
    ("UNITS/FEET\nFINI", "UNITS/FEET"),
    ("MULTAX/ON\nGOTO/0,0,0\nFINI", "has 3 numbers"),
])
def test_broken_files_are_refused(text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        read_apt(text)


def test_a_long_path_is_written_some_points_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    count = 60_000
    x = np.linspace(0.0, 500.0, count)
    tips = np.column_stack([x, np.sin(x), np.cos(x)])
    up = np.tile([0.0, 0.0, 1.0], (count, 1))
    path = ToolPath(tips, tips, up, up, np.full(count, Motion.CUT, dtype=np.int8), np.array([0, count]))
    tracemalloc.start()
    text = apt_text(path, TOOL, "op01-face1", 1000.0, 8000.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 * len(text)
    monkeypatch.setattr(apt, "_BLOCK", 7)
    assert apt_text(path, TOOL, "op01-face1", 1000.0, 8000.0) == text
