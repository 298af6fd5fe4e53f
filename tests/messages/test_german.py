"""Real sentences of the program, made by what makes them: each comes out in German, with all its values."""

import re
from dataclasses import replace
from itertools import product
from math import nan, radians
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import KEYS, read_jobs
from toolaxis.cad.step.precheck import read_text
from toolaxis.cad.unit_checks import tool_warnings, unit_warnings
from toolaxis.cldata.toolpath import Motion
from toolaxis.collision.machine_collision import CollisionPoint, words
from toolaxis.errors import ToolAxisError, fault
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import OTHER, SKIN, TOUCHING, CheckSurfaces
from toolaxis.feasibility.violations import BACK, CUTTER, GOUGE, HOLDER, LIMITS, SHANK, WANDERS, Violation
from toolaxis.feed.jerk_profile import profile
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.limits import parse_limits
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.messages.translate import matching, translate
from toolaxis.numeric.vectors import as_rows
from toolaxis.partition.partition import check_count
from toolaxis.plan.plan import PlanInputs
from toolaxis.plan.tally import COUNTED
from toolaxis.plan.zone import Zone
from toolaxis.post.read_apt import read_apt
from toolaxis.post.read_nc import read_nc
from toolaxis.progress import Progress
from toolaxis.search.fixed_axis import evaluate_axis
from toolaxis.search.messages import left_reasons, nothing_to_cut, sentence
from toolaxis.shape.half_space import HELD_SIDE
from toolaxis.shape.seams import seam_warnings
from toolaxis.strategies.inputs import check_strategy
from toolaxis.strategies.registry import strategies
from toolaxis.strategies.strategy import Asked
from toolaxis.strategies.two_point.postures import REASONS as CONTACTS
from toolaxis.tools.profile import Profile
from toolaxis.verify.axis_limits import machine_faults
from toolaxis.verify.held_side import HeldSide
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge

#: Numbers; the 2 of mm2 is none.
NUMBER = re.compile(r"(?<![\w^.,])\d+(?:[.,]\d+)?")
#: What is written in both languages alike: what stands in quotation marks, names with hyphens, words of inputs.
ALIKE = re.compile(r"'[^']*'|\w+(?:-\w+)+|length, passes")
#: Words that no German sentence holds, outside of quotation marks.
ENGLISH = re.compile(r"\b(the|is|are|of|by|with|and|or|from|to|it|its|axis|face|faces|must|allowed|required|holder|"
                     r"shank|cutter|passes|found|above|below|at|on|this|that)\b")
DRIVE = Drive(100.0, 1000.0, 10000.0)
HELD = {"stickout": 14, "flute_length": 6, "holder": [(9, 0), (9, 30)]}


def check(english):
    """That a sentence is German, and has the numbers of the English one with a decimal comma."""
    german = translate(english, "german", ",")
    before, after = ALIKE.sub("", english), ALIKE.sub("", german)
    numbers = [sorted(number.replace(".", ",") for number in NUMBER.findall(text)) for text in (before, after)]
    return german != english and not ENGLISH.search(after) and numbers[0] == numbers[1]


def all_german(sentences):
    """Whether there are sentences, and all of them come out in German; those that do not are told."""
    sentences = list(dict.fromkeys(sentences))
    assert sentences
    lost = [f"{text}\n    -> {translate(text, 'german', ',')}\n    entry: {matching(text, 'german') or 'none'}"
            for text in sentences if not check(text)]
    assert not lost, f"{len(lost)} of {len(sentences)}:\n" + "\n".join(lost)


def refusal(call):
    """What a call is refused with."""
    with pytest.raises(ToolAxisError) as found:
        call()
    return str(found.value)


def wavy(seed, height):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 16, 6), np.linspace(0, 12, 6), indexing="ij")
    z = height * np.sin(x / rng.uniform(2, 6) + rng.uniform(0, 3)) * np.cos(y / rng.uniform(2, 6))
    return ta.Face.from_bspline(np.stack([x, y, z], axis=-1))


def plate(corner, one, two):
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def small_machine():
    linear = tuple(LinearAxis(name, way, DRIVE, -200.0, 200.0)
                   for name, way in zip("XYZ", np.eye(3), strict=True))
    table = (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE),
             RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), DRIVE, radians(-10), radians(60)))
    return Machine("small", linear, table)


@pytest.mark.parametrize("allowance", [0.0, 0.3])
def test_any_reason_against_an_axis(allowance):
    face, beside = wavy(1, 0.3), plate((16, 0, -9), (0, 12, 0), (0, 0, 9)).trimmed((), "2")
    groups = (CheckSurfaces(SKIN, (face,), np.array([allowance - 0.001, 0.5, 1.0])),
              CheckSurfaces(TOUCHING, (beside,), np.array([-0.001, 0.5, 1.0])),
              CheckSurfaces(OTHER, (plate((-1, -5, -5), (0, 30, 0), (0, 0, 20)).trimmed((), "7"),),
                            np.array([0.1, 0.5, 1.0])))
    tool = ta.Tool.torus(diameter=8, corner_radius=1, **HELD)
    of = Feasibility(face, tool, groups, ta.Tolerance(gouge=0.002), allowance=allowance)
    nowhere, here = np.full(3, nan), np.array([1.0, -2.0, 0.25])
    all_german(sentence(Violation(reason, amount, label, point, distance=distance), of)
               for reason, label, point, distance, amount in product(
                   (LIMITS, BACK, WANDERS, GOUGE, CUTTER, SHANK, HOLDER), ("", "1", "2", "7"), (nowhere, here),
                   (nan, 0.0, -4e-3, -2.0, 4e-3, 0.3, 25.0), (1e-6, 1.3)))
    all_german([nothing_to_cut(face)])


@pytest.mark.parametrize("case", range(5))
def test_searches_that_find_nothing(case):
    lid, held = plate((-30, -30, 9), (80, 0, 0), (0, 80, 0)), ta.Tool.ball(6, **HELD)
    face, tool, more = (
        (wavy(1, 0.3), held, {"obstacles": [lid], "limits": "cone:0,0,1,25"}),
        (wavy(3, 0.3), held, {"limits": "cone:0,0,-1,30"}),
        (wavy(4, 0.0), ta.Tool.flat(diameter=6), {"limits": "cone:0,0,1,0.2"}),
        (wavy(5, 6.0), ta.Tool.torus(diameter=12, corner_radius=2), {"limits": "cone:0,0,1,30"}),
        (wavy(6, 9.0), ta.Tool.tapered(8, 1, 30), {}))[case]
    found = ta.best_axis(face, tool, 0.2, **more)
    assert found.axis is None
    all_german(found.reasons)


def test_counts_of_refused_axes():
    all_german(f"214 axes tested: 31 {COUNTED[1]}, {17 + k} {words}" for k, words in enumerate(COUNTED) if k > 1)


def test_axes_that_a_machine_does_not_hold():
    held = Mounting(small_machine())
    up = evaluate_axis(wavy(1, 0.3), ta.Tool.ball(6, **HELD), (0, -0.96, 0.28), 0.2, held)
    far = replace(held, table_from_part=np.array([190.0, 0, 0]), tool_length=100.0)
    point = CollisionPoint("holder", "table", 0.42, 0)
    all_german([*up.reasons, far.out_of_travel([[50.0, 0, 0]], (0, 0, 1.0)),
                words(held, np.array([0.1, 0.2]), point, 1.0),
                words(held, np.array([0.1, 0.2]), point._replace(distance=-0.42), 1.0)])
    tips, axes = np.array([[0.0, 0, 0], [250, 20, 10]]), np.tile([0.0, -np.sin(1.3), np.cos(1.3)], (2, 1))
    faults = machine_faults(small_machine(), tips, axes, np.zeros(3), 100.0)
    steep = machine_faults(small_machine(), tips, np.tile([0.0, -0.479, 0.878], (2, 1)), np.zeros(3), 100.0)
    all_german([*faults, *steep])


def test_what_is_left_to_clean_up():
    face = wavy(1, 0.3)
    left = face.outline
    zones = (Zone(left, 0.3 * face.area, at_wall=True, avoided=("7", HELD_SIDE)),
             Zone(left, 0.1 * face.area, at_wall=False))
    all_german(left_reasons(zones, face))


@pytest.fixture(scope="module")
def lowered():
    """Passes over a floor that go too deep, too far apart, against a wall, with a holder that hits it."""
    axis, rows, kind = np.array([np.sin(0.2), 0.0, np.cos(0.2)]), [], []
    for y in np.arange(-8, 0.1, 4.0):
        x = np.arange(-10, 10.1, 0.5)
        tip = np.column_stack([x, np.full_like(x, y), np.full_like(x, -0.05)])
        rows += [tip[:1] + 10 * axis, tip]
        kind += [int(Motion.LINK), *[int(Motion.CUT)] * len(tip)]
    tips, floor = np.vstack(rows), plate((-8, -8, 0), (16, 0, 0), (0, 16, 0))
    wall = plate((9, -20, 0), (0, 40, 0), (0, 0, 80)).trimmed((), "2")
    return VerificationTask("floor", tips, np.tile(axis, (len(tips), 1)), np.array(kind, dtype=np.int8),
                            Profile(5, 1, 0, 24), (floor,), 0.02, surroundings=(wall,), left=(),
                            outlines={"holder": np.array([[12.0, 40.0], [12.0, 80.0]])}, machine=small_machine(),
                            named=np.array([0.0, 0.0, 1.0]))


def test_reasons_of_the_judge(lowered):
    found = judge(lowered, spacing=0.5)
    text = " ".join(found.reasons)
    for part in ("names the axis", "of the area", "gouge", "holder is", "not checked"):
        assert part in text, found.reasons
    all_german(found.reasons)
    all_german([*judge(replace(lowered, surroundings=(), outlines={}), spacing=0.5).reasons])
    for height in (-0.1, 60.0):  # the cutter near it, and the tool in it
        side = HeldSide(np.array([0, 0, height]), np.array([0, 0, -1.0]))
        held = judge(replace(lowered, held=side), spacing=0.5).reasons
        assert any("the clamped side, needed" in why for why in held), held
        all_german(held)


def test_warnings_of_a_part():
    from toolaxis.shape.adjacency import Border, edges_from_borders
    from toolaxis.shape.part import Part

    def two(step):
        beside = plate((0, 0, step), (40, 0, 0), (0, 20, 0)).trimmed((), "2")
        faces = [plate((-40, 0, 0), (40, 0, 0), (0, 20, 0)), beside]
        at = np.linspace(0, 1, 9)
        border = Border((1, 2), np.column_stack([0 * at, 20 * at, 0 * at]), np.column_stack([0 * at + 1, at]),
                        np.column_stack([0 * at, at]), True, False)
        return Part.from_faces(faces, edges_from_borders(Part.from_faces(faces).faces, [border]))

    steps = [two(0.004), two(0.4)]
    many = seam_warnings([edge for k in range(12) for edge in two(0.004 + 0.001 * k).edges])
    scaled = [replace(Part.from_faces([plate((0, 0, 0), (size, 0, 0), (0, 0.7 * size, 0))]), unit="mm")
              for size in (1e-3, 1e6)]
    all_german([*(text for part in steps for text in part.warnings), *many,
                *(text for part in scaled for text in unit_warnings(part)), *tool_warnings(steps[0], 55.5)])


def test_wrong_tools_limits_and_numbers():
    tool = ta.Tool
    calls = (lambda: tool.ball(-1), lambda: tool.ball(nan), lambda: tool.ball("x"), lambda: tool.torus(12, 8),
             lambda: tool.torus(12, 0), lambda: tool.tapered(4, 1, 95), lambda: tool.parse("ball"),
             lambda: tool.ball(6, holder=[(9, 0), (9, 30)]), lambda: tool.ball(6, stickout=2, holder=[(9, 0), (9, 30)]),
             lambda: tool.ball(6, stickout=20, flute_length=30), lambda: tool.ball(6, stickout=20, flute_length=1),
             lambda: tool.ball(6, stickout=20, holder=[(9, 5), (9, 3)]),
             lambda: tool.ball(6, stickout=20, holder=[(9, 5)]),
             lambda: tool.ball(6, stickout=20, holder=[(-9, 5), (9, 6)]),
             lambda: parse_limits("cone:0,0"), lambda: parse_limits("cone:0,0,1,300"), lambda: parse_limits("odd"),
             lambda: parse_limits("rotary:tilt=50..10"), lambda: check_count(0),
             lambda: check_count(10**6, "orientations"),
             lambda: ta.load_machine("unheard-of"), lambda: ta.Tolerance(gouge=-1.0),
             lambda: PlanInputs(scallop=0.02, feedrate=-1.0), lambda: PlanInputs(scallop=-0.02),
             lambda: PlanInputs(scallop=0.02, allowance=-1.0), lambda: PlanInputs(scallop=0.02, objective="beauty"),
             lambda: ta.plan(wavy(1, 0.3), "ball:6", 5.0), lambda: ta.plan(wavy(1, 0.3), "ball:6", 0.05, faces=[7]))
    all_german(map(refusal, calls))


def test_what_does_not_go_with_a_strategy():
    torus, machine = ta.Tool.torus(12, 1), small_machine()
    by_hand = replace(machine, table=tuple(replace(axis, drive=None) for axis in machine.table))
    found = []
    for name, change in product(strategies(), ({}, {"method": "roman"}, {"objective": "time"}, {"roughness": -1.0},
                                               {"roughness": 0.001}, {"orientations": 3}, {"machine": by_hand},
                                               {"held": "axis or feed of Op1 are locked"},
                                               {"tool": ta.Tool.flat(6)}, {"method": "one", "orientations": 2})):
        for given in (None, machine):
            try:
                check_strategy(name, Asked(**{"tool": torus, "machine": given, **change}))
            except ToolAxisError as reason:
                found.append(str(reason))
    assert len(set(found)) > 20
    all_german(found)


def test_contacts_of_the_two_point_strategy():
    all_german(f"{words} on 12.5 % of the passes" for words in CONTACTS)


@pytest.mark.parametrize(("old", "new"), [
    ("ISO-10303-21;", "PK something"), ("END-ISO-10303-21;", ""), ("ENDSEC;\nEND-ISO", "END-ISO"),
    ("#12=", "#11="), ("0.", "nan"), ("CARTESIAN_POINT('',(", "CARTESIAN_POINT('',((("),
    ("ADVANCED_FACE(", "ADVANCED_FACES("), ("CLOSED_SHELL", "SHELL"), ("EDGE_LOOP('',(", "EDGE_LOOP('',(#9999999,"),
    ("PLANE('',", "PLANE('',#1,"), ("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.MILLI.,.PARSEC.)"), ("(3,3,", "(0,0,")])
def test_step_files_that_are_refused(tmp_path, old, new):
    whole = (Path(__file__).parents[2] / "examples" / "saddle.step").read_text()
    path = tmp_path / "part.step"
    for text in (whole.replace(old, new), whole.replace(old, new, 1), whole[:len(whole) // 2], ""):
        path.write_text(text)
        try:
            notes = [*read_text(path).notes]
        except ToolAxisError as reason:
            notes = [str(reason)]
        for note in notes:
            all_german([note.replace(str(path), "'part.step'")])


def test_jobs_that_are_refused(tmp_path):
    (tmp_path / "a.step").write_text("ISO-10303-21;")
    job = 'part = "a.step"\ntool = "ball:6"\nscallop = 0.02\n'
    found = []
    for text in ("", "odd = 1", "defaults = 3\njobs = 4", '[defaults]\nname = "a"', "[defaults]\nodd = 1",
                 "[[jobs]]\nodd = 1", "[[jobs]]", "not toml", f"[[jobs]]\n{job}name = '.odd/'",
                 f"[[jobs]]\n{job}[[jobs]]\n{job}", f"[[jobs]]\n{job}memory = -1", f"[[jobs]]\n{job}verify = 3",
                 f"[[jobs]]\n{job.replace('a.step', 'b.step')}", f"[[jobs]]\n{job.replace('a.step', '')}"):
        (tmp_path / "jobs.toml").write_text(text)
        found.append(refusal(lambda: read_jobs(tmp_path / "jobs.toml")))
    all_german(text.replace(str(tmp_path) + "/", "").replace(", ".join(KEYS), "words") for text in found
               if "TOML" not in text)


def test_programs_that_are_refused():
    machine, found = ta.load_machine("bc-table-table"), []
    for line in ("G2 X1 Y2", "G91\nG1 X1 Y2 Z3 B0 C0", "CYCL DEF 7", "G1 X1 Y2 Z3 F-1", "G93", "G1 V3 X1 Y2 Z3",
                 "G43.4\nX1 Y2 Z3 B0 C0", "G43.4\nG1 X1 Y2 Z3", "G1 X1 Y2 Z3 B0 C0", "G1 ?? X1", "G43.5"):
        found.append(refusal(lambda line=line: read_nc(f"%\n{line}\nM30\n", machine)))
    for text in ("GOTO/1,2", "GOTO/1,2,nan", "FEDRAT/MMPM", "FEDRAT/-1", "UNITS/YARDS", "GODLTA/1", "CIRCLE/1,2,3",
                 "MULTAX/ON\nGOTO/1,2,3,0,0,2", "GOTO/1,2,x", "FEDRAT/1,MMPR", "GOTO/1,2,3"):
        found.append(refusal(lambda text=text: read_apt(f"{text}\n")))
    all_german(found)


def test_arrays_of_the_wrong_shape():
    calls = (lambda: as_rows("x", 3, "tool tips"), lambda: as_rows([[1, 2]], 3, "feed directions"),
             lambda: as_rows([[1, nan, 2]], 3, "ray normal"), lambda: profile(-1.0, 1.0, 1.0, 1.0),
             lambda: profile(1.0, 1.0, 1.0, 1.0, (2.0, 0.0)), lambda: profile(1.0, -1.0, 1.0, 1.0),
             lambda: ta.Face.from_bspline(np.zeros((2, 2))), lambda: ta.Face.from_bspline(np.full((4, 4, 3), nan)))
    all_german(map(refusal, calls))


def test_errors_of_the_program_itself():
    for kind in (ValueError("x"), MemoryError()):
        try:
            raise kind
        except (ValueError, MemoryError) as reason:
            assert translate(fault(reason).sentence, "german").startswith("fehlgeschlagen")


def test_stages_of_plan_and_verify():
    stages = []
    progress = Progress(lambda stage, done, total: stages.append(stage))
    made = ta.plan(wavy(1, 0.3), "ball:6", 0.2, regions=2, orientations=2, compare=True, workers=1, progress=progress,
                   limits="cone:0,0,1,15")
    ta.verify(made, progress=progress)
    left = sorted({stage for stage in stages if translate(stage, "german") == stage})
    kinds = {re.sub(r"\d+", "#", stage) for stage in stages}
    assert len(kinds) >= 30 and not left, (kinds, left)
    moving = ta.plan(wavy(1, 0.3), "torus:12x1", 0.2, strategy="sturz", workers=1)
    all_german(why for op in moving.operations for why in op.orientation.reasons)


def test_a_sentence_keeps_what_it_does_not_know():
    assert translate("nobody says this at all", "german", ",") == "nobody says this at all"
    assert translate("the part was deleted", "klingon") == "the part was deleted"
    assert translate("", "german") == ""


def test_lists_places_and_names():
    assert translate("Op1, Op2 and more: the part has changed; tool was changed", "german") == (
        "Op1, Op2 und weitere: das Teil hat sich geändert; Werkzeug geändert")
    assert translate("face 3 (1 of 2): axes", "german") == "Fläche 3 (1 von 2): Achsen"
    said = translate("the holder collides with face 4 by 0.42 mm at (1.5, 0, -3)", "german", ",")
    assert said == "Kollision: Halter und Fläche 4, 0,42 mm bei (1,5; 0; -3)"
    assert translate("the holder collides with face 4 by 0.42 mm", "german") == (
        "Kollision: Halter und Fläche 4, 0.42 mm")
