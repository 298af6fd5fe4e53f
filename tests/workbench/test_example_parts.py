"""The example parts walked through a document: the command's plan, machines, CAM jobs, saving; and axes that move."""

import json
import os
import re
import time
from pathlib import Path
from types import SimpleNamespace

import FreeCAD
import numpy as np
import Part as FreecadPart
import pytest
from freecad.toolaxis.cam.jobs import count_jobs, make_jobs
from freecad.toolaxis.cam.work_offsets import OFFSETS, shared_of
from freecad.toolaxis.document import machine_angles, machine_limits
from freecad.toolaxis.document.blade_links import turned_copies
from freecad.toolaxis.document.kinds import is_operation, is_plan, plan_of
from freecad.toolaxis.document.machine import place_machine
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.sub_surface_shape import CLEAN_UP, is_shown
from freecad.toolaxis.services import api
from freecad.toolaxis.services.export import export, plan_task

from toolaxis.cldata.toolpath import Motion
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.progress import NO_PROGRESS

FOLDER = Path(__file__).resolve().parents[2] / os.environ.get("TOOLAXIS_PREPARED", "out/freecad/example_parts")
ASKED = json.loads((FOLDER / "asked.json").read_text()) if (FOLDER / "asked.json").exists() else {}
EVERY = "freeform", "trimmed", "boss", "bosses", "blisk", "kj66", "kj66-whole"
MOVING = "freeform-sturz", "trimmed-sturz"
#: Greatest difference of angles as the tree writes them, degrees.
ANGLE = 0.0006
#: The last digit of the places in CL files, mm.
DIGIT = 1e-6
NUMBER = re.compile(r"-?\d+\.\d+")

pytestmark = pytest.mark.long


def told(text):
    """Print where pytest does not swallow it."""
    os.write(2, f"{text}\n".encode())


def planned(name):
    """The command's plan, and the same through a document."""
    if name not in ASKED:
        pytest.skip(f"{name} was not prepared: set TOOLAXIS_SHARED for the parts by others, and see `prepared`")
    _, tool, scallop, rest = ASKED[name]
    given = dict(rest)
    place, machine, faces = given.pop("offset", None), given.pop("machine", None), given.pop("faces", None)
    if machine:
        given["limits"] = machine_limits.text_of(machine, place)
    document = FreeCAD.newDocument("Walk")
    document.UndoMode = 1
    thing = document.addObject("Part::Feature", "Imported")
    thing.Shape = FreecadPart.read(str(FOLDER / f"{name}.step"))
    document.recompute()
    begin = time.perf_counter()
    made = api.plan(document, (thing, faces) if faces else thing, tool, scallop,
                       **{"shank": None, "holder": None, **given})
    told(f"{name}: planned in FreeCAD in {time.perf_counter() - begin:.1f} s")
    theirs = json.loads((FOLDER / name / "plan.json").read_text())
    return SimpleNamespace(name=name, document=document, thing=thing, made=made, theirs=theirs,
                           plan=read_plan(FOLDER / name))


@pytest.fixture(scope="module", params=EVERY)
def walk(request, prepared):
    found = planned(request.param)
    yield found
    FreeCAD.closeDocument(found.document.Name)


def originals(walk):
    """The operations of plan.json that no turned operation stands for: blades that differ have some of their own."""
    copies = {} if walk.plan.blades is None else walk.plan.blades.copies
    paths = {op.number: op.path for op in walk.plan.operations}
    return [op for op in walk.theirs["operations"]
            if op["number"] not in copies or not congruent(paths[op["number"]], paths[copies[op["number"]]])]


def congruent(one, other):
    """Whether a path is another one turned, or neither is there."""
    if one is None or other is None:
        return one is other
    away = [np.linalg.norm(path.cl - path.cl.mean(axis=0), axis=1) for path in (one, other)]
    return len(away[0]) == len(away[1]) and np.abs(away[0] - away[1]).max() < 10 * DIGIT


def check_reasons(ours, theirs):
    """The same sentences; the last digits of a kernel may let the search look at one axis more or less."""
    assert len(ours) == len(theirs)
    for one, other in zip(ours, theirs, strict=True):
        if not other.startswith("of "):
            assert one == other
            continue
        assert re.sub(r"\d+", "", one) == re.sub(r"\d+", "", other)
        counts = zip(re.findall(r"\d+", one), re.findall(r"\d+", other), strict=True)
        assert all(abs(int(a) - int(b)) <= 2 for a, b in counts), (one, other)


def check_figures(ours, op):
    """An operation of the tree against one of plan.json."""
    found = op["orientation"]
    assert json.loads(ours.Details)["label"] == op["label"]
    assert ours.Outcome == found["outcome"]
    check_reasons(list(ours.Reasons), found["reasons"])
    assert bool(ours.Motions) == (op["cl_file"] is not None)
    if found["axis"] is None:
        return
    assert tuple(ours.Axis) == pytest.approx(found["axis"], abs=1e-6)
    assert ours.Passes == found["passes"]
    assert ours.CuttingLength.Value == pytest.approx(found["length"], rel=1e-6)
    assert ours.LeftToCleanUp == pytest.approx(found["unreached"], abs=1e-6)


def test_the_tree_holds_the_commands_plan(walk):
    """Labels, outcomes, reasons, axes, passes, lengths and clean-up zones."""
    theirs, rows = walk.theirs, originals(walk)
    for ours, op in zip(walk.made, rows, strict=True):
        check_figures(ours, op)
        assert bool(zones_of(ours)) == bool(op["zones"]), op["label"]
    above = plan_of(walk.made[0])
    if above is not None:
        assert above.Outcome == theirs["outcome"]
        assert above.CuttingLength.Value == pytest.approx(theirs["length"], rel=1e-6)


def zones_of(operation):
    return [one for one in operation.Group if is_shown(one) and one.Shows == CLEAN_UP]


def test_turned_copies_are_links_and_nothing_is_out_of_date(walk):
    turned = len(walk.theirs["operations"]) - len(originals(walk))
    idle = sum(1 for op in walk.theirs["operations"] if not op["cl_file"]) - sum(not one.Motions for one in walk.made)
    links = [link for one in walk.made for link in turned_copies(one)]
    assert len(links) == turned - idle
    for link in links:
        stands = link.Placement.multiply(next(one for one in link.LinkedObject.Group
                                              if one.TypeId == "Path::Feature").Placement)
        assert stands.Rotation.multVec(FreeCAD.Vector(0, 0, 1)).isEqual(link.Axis, 1e-6)
    assert not [one.Name for one in walk.document.Objects if "Invalid" in one.State]
    assert not [one.Label for one in walk.document.Objects if (is_operation(one) or is_plan(one)) and one.Stale]


@pytest.fixture(scope="module")
def standing(walk):
    """The operations and turned copies that stand in the document, by their labels."""
    labels = [one.Label for ours in walk.made for one in (ours, *(turned_copies(ours) if ours.Motions else ()))]
    return dict(zip(labels, plan_task(walk.made)(NO_PROGRESS).operations, strict=True))


def test_what_is_exported_is_the_commands_plan(walk, tmp_path):
    """Every point of every path, copies included, links apart: their height hangs on each kernel's box of the part."""
    ours = {}
    export(walk.made, tmp_path / "out")
    for op in read_plan(tmp_path / "out").operations:
        ours.setdefault(op.face.label, []).append(op)
    for op in walk.plan.operations:
        if op.path is None:
            continue
        found = [one for one in ours[op.face.label] if one.path is not None and len(one.path.cl) == len(op.path.cl)]
        on = op.path.kind != Motion.LINK
        away = [np.abs(one.path.cl - op.path.cl)[on].max() for one in found]
        assert away and min(away) < 1e-4, op.face.label
        one = found[int(np.argmin(away))]
        assert (one.path.kind == op.path.kind).all() and (one.path.breaks == op.path.breaks).all()
        assert np.abs(one.path.axis - op.path.axis).max() < 1e-6


def angles_in(text):
    """The angles of a text of the tree, degrees in [0, 360), and what it says against them."""
    angles, _, reason = text.partition(" (")
    return tuple(float(word.rstrip("\u00b0")) for word in angles.split()[1::2]), reason


def same_angles(one, other):
    return np.abs((np.array(one) - other + 180) % 360 - 180).max() < ANGLE


@pytest.mark.parametrize("machine", ["bc-table-table", "ab-trunnion"])
def test_both_solutions_of_a_machine_are_the_commands(walk, machine):
    """What the tree allows is what the library finds for the command's CL data; all else has its reason."""
    rows = [(ours, op) for ours, op in zip(walk.made, originals(walk), strict=True) if ours.Motions]
    if "limits" in walk.theirs["inputs"] and walk.theirs["machine"] is not None and machine == "bc-table-table":
        found = [(list(ours.RotaryAngles), np.degrees(op["rotary"])) for ours, op in rows]
    else:
        numbered = {op.number: op for op in walk.plan.operations}
        mounted = machine_limits.mounting(f"machine:{machine}@0,0,60", walk.plan.tools[0])
        ways = machine_angles.in_order(mounted, [(op.orientation.axis, op.path.cl) for op in
                                           (numbered[row["number"]] for _, row in rows)])
        texts = [machine_angles.texts_of(mounted.machine, *one) for one in ways]
        place_machine(walk.document, machine, (0, 0, 60), [(ours, text) for (ours, _), text in
                                                           zip(rows, texts, strict=True)])
        held = [mounted.hold_side(numbered[row["number"]].path.cl, numbered[row["number"]].orientation.axis)
                for _, row in rows]
        found = [(list(ours.RotaryAngles), np.degrees(one)) for (ours, _), one in zip(rows, held, strict=True)]
    for texts, theirs in found:
        told_of = [angles_in(text) for text in texts]
        allowed = [angles for angles, reason in told_of if not reason or "collides" in reason]
        assert len(texts) in (0, 2), texts
        assert len(allowed) == len(theirs), (texts, theirs)
        assert all(any(same_angles(one, other) for other in theirs) for one in allowed), (texts, theirs)
        for _, reason in told_of:
            assert not reason or any(words in reason for words in ("beyond its range", "leaves its travel by",
                                                                   "collides with the")), reason


def stands_of(walk):
    """The plane of each operation and turned copy in the document's space, by its label."""
    found = {}
    for ours in walk.made:
        passes = next((one for one in ours.Group if one.TypeId == "Path::Feature"), None)
        if passes is not None:
            found[ours.Label] = passes.Placement
            found |= {link.Label: link.Placement.multiply(passes.Placement) for link in turned_copies(ours)}
    return found


@pytest.fixture(scope="module")
def jobs(walk):
    begin, before = time.perf_counter(), len(walk.document.Objects)
    made = make_jobs(walk.document, walk.made)
    told(f"{walk.name}: {len(made)} jobs with {len(walk.document.Objects) - before} objects in "
         f"{time.perf_counter() - begin:.1f} s")
    return made


def test_every_job_is_posted_and_lies_on_the_cl_data(walk, standing, jobs, posting):
    stands = stands_of(walk)
    assert len(jobs) == count_jobs(walk.made)
    assert sorted(one.MadeFor for job in jobs for one in job.Operations.Group) == sorted(stands)
    begin = time.perf_counter()
    for job in jobs:
        text, plane = posting.posted(job), stands[job.Operations.Group[0].MadeFor]
        for one in job.Operations.Group:
            posting.check_on_cl(text, one, standing[one.MadeFor].path, plane)
            turn = matrix_of(stands[one.MadeFor])[:3, 2]
            assert np.abs(turn - matrix_of(plane)[:3, 2]).max() < 1e-6
    told(f"{walk.name}: posted and compared in {time.perf_counter() - begin:.1f} s")
    assert not [one.Name for one in walk.document.Objects if "Invalid" in one.State]


def test_no_two_orientations_share_a_work_offset_in_silence(jobs):
    offsets = [name for job in jobs for name in job.Fixtures]
    assert len(offsets) == len(jobs) and set(offsets) <= set(OFFSETS)
    shared = [job for job, name in zip(jobs, offsets, strict=True) if offsets.count(name) > 1]
    assert shared_of(jobs) == shared and bool(shared) == (len(jobs) > len(OFFSETS))
    for job in jobs:
        assert job.Operations.Group[0].Gcode[0].startswith("(work offset") == (job in shared)


def figures(document):
    """What the tree tells of each operation and plan."""
    names = "Outcome", "Stale", "StaleReasons", "CuttingLength", "Passes", "Reasons", "RotaryAngles"
    return {one.Name: [*(str(getattr(one, name, None)) for name in names),
                       *np.round(getattr(one, "Axis", ()), 12).tolist()]
            for one in document.Objects if is_operation(one) or is_plan(one)}


def program(posting, job):
    """What a job is posted as, without the lines that name the time and the document's file."""
    return [line for line in posting.posted(job).splitlines() if not re.search("Time:|Date:|Cam File:", line)]


def test_saved_and_opened_again_nothing_is_to_be_computed(walk, jobs, posting, tmp_path):
    path = tmp_path / "Walk.FCStd"
    for job in jobs:
        posting.posted(job)  # sets the post-processor, which is saved
    walk.document.recompute()
    begin = time.perf_counter()
    walk.document.saveCopy(str(path))
    saved = time.perf_counter()
    again = FreeCAD.openDocument(str(path))
    told(f"{walk.name}: saved in {saved - begin:.1f} s, {path.stat().st_size / 2**20:.1f} MB, opened in "
         f"{time.perf_counter() - saved:.1f} s")
    try:
        touched = [one.Name for one in again.Objects if {"Touched", "Invalid"}.intersection(one.State)]
        assert not touched
        assert figures(again) == figures(walk.document)
        some = jobs[:: max(1, len(jobs) // 10)]
        wanted = [program(posting, job) for job in some]
        FreeCAD.setActiveDocument(again.Name)
        for job, lines in zip(some, wanted, strict=True):
            for one, other in zip(program(posting, again.getObject(job.Name)), lines, strict=True):
                assert NUMBER.sub("", one) == NUMBER.sub("", other)
                pairs = zip(NUMBER.findall(one), NUMBER.findall(other), strict=True)
                assert all(abs(float(a) - float(b)) <= posting.DIGIT + 1e-9 for a, b in pairs), "ties may round apart"
    finally:
        FreeCAD.closeDocument(again.Name)


@pytest.mark.parametrize("name", MOVING)
def test_an_axis_that_moves_is_the_commands(name, prepared, tmp_path):
    """Figures and every point of the path, links apart."""
    walk = planned(name)
    try:
        for ours, op in zip(walk.made, walk.theirs["operations"], strict=True):
            assert ours.AxisMoves and ours.Strategy == ASKED[name][3]["strategy"]
            check_figures(ours, op)
        export(walk.made, tmp_path / "out")
        for ours, theirs in zip(read_plan(tmp_path / "out").operations, walk.plan.operations, strict=True):
            on = theirs.path.kind != Motion.LINK
            assert (ours.path.kind == theirs.path.kind).all()
            assert np.abs(ours.path.cl - theirs.path.cl)[on].max() < 1e-4
            assert np.abs(ours.path.axis - theirs.path.axis).max() < 1e-6
            assert np.ptp(theirs.path.axis, axis=0).max() > 0.01
    finally:
        FreeCAD.closeDocument(walk.document.Name)
