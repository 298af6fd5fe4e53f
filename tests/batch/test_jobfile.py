"""Job files: what is understood, what is refused in a sentence, and when two jobs are the same."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import KEYS, CheckedJob, read_jobs
from toolaxis.errors import InvalidInput
from toolaxis.plan.document import tool_document

STEP = "ISO-10303-21;\n"


@pytest.fixture
def here(tmp_path: Path) -> Path:
    (tmp_path / "a.step").write_text(STEP)
    (tmp_path / "b.step").write_text(STEP + "b")
    return tmp_path


def read(folder: Path, text: str) -> tuple[CheckedJob, ...]:
    (folder / "jobs.toml").write_text(text)
    return read_jobs(folder / "jobs.toml")


def test_clearances_are_said_as_in_the_command_or_as_a_list(here: Path) -> None:
    jobs = read(here, """
        [defaults]
        part = "a.step"
        scallop = 0.02
        [[jobs]]
        name = "text"
        clearances = "0.1,0.3,2"
        [[jobs]]
        name = "list"
        clearances = [0.1, 0.3, 2]
        tolerance = 0.02
        """)
    kept = [job.spec.inputs.tolerance for job in jobs]
    assert all((one.cutter_clearance, one.shank_clearance, one.holder_clearance) == (0.1, 0.3, 2.0) for one in kept)
    assert [one.gouge for one in kept] == [0.01, 0.02] and all(one.shank_share is None for one in kept)
    with pytest.raises(InvalidInput, match=r"clearances 5 are not understood"):
        read(here, '[[jobs]]\npart = "a.step"\nscallop = 0.02\nclearances = 5\n')


def test_defaults_hold_for_all_jobs_and_files_are_meant_from_the_job_files_folder(here: Path) -> None:
    (here / "cutter.toml").write_text('kind = "ball"\ndiameter = 6\n')
    one, two = read(here, """
        [defaults]
        tool = "torus:12x1"
        scallop = 0.02
        verify = true
        [[jobs]]
        part = "a.step"
        faces = [1, [3, 4], 7]
        regions = "auto"
        offset = [1, -2.5, 3]
        machine = "mikron-ucp-710"
        timeout = 60
        [[jobs]]
        name = "second"
        part = "a.step"
        tool = "cutter.toml"
        stickout = 40
        holder = [[10, 0], [10, 40]]
        obstacles = "b.step"
        memory = 2000
        """)
    assert (one.name, two.name) == ("a", "second")
    assert one.spec.numbers == (1, (3, 4), 7) and one.spec.regions == "auto"
    assert one.spec.place == pytest.approx([1, -2.5, 3]) and one.machine is not None
    assert one.own["timeout"] == 60 and one.own["verify"] and two.own["memory"] == 2000
    assert two.tools[0].radius == 3 and two.tools[0].stickout == 40 and np.shape(two.tools[0].holder) == (2, 2)
    task = two.task()
    assert task.part.content == STEP.encode() and [body.content for body in task.obstacles] == [(STEP + "b").encode()]
    assert tool_document(task.tools[0]) == tool_document(two.tools[0])


@pytest.mark.parametrize("text, said", [
    ("", "no jobs"), ("[[jobs]]", "job 1: there is no 'part'"), ("jobs = 3", "each job a table"),
    ('[[jobs]]\npart="a.step"', "no 'scallop'"), ("[[jobs", "not valid TOML"), ("[job]\nx=1", "unknown 'job'"),
    ("[defaults]\ncolour=1", r"\[defaults\] has 'colour'"), ('[defaults]\nname="x"', "'name', which is each job's own"),
    ("{scallop}\ncolour=1", r"job 1: unknown 'colour': use name, part, tool"),
    ('{scallop}\nname="two"\ntoolpath=1', r"job 1 \(two\): unknown 'toolpath'"),
    ('[[jobs]]\npart="a.step"\ntool="torus:12x7"\nscallop=0.1', "corner radius is 7"),
    ('[[jobs]]\npart="a.step"\ntool="drill:3"\nscallop=0.1', "nor one of the tools"),
    ('[[jobs]]\npart="a.step"\ntool="ball:8"\nscallop="fine"', "scallop is 'fine': give a finite number"),
    ('[[jobs]]\npart="a.step"\ntool="ball:8"\nscallop=true', "scallop is True"),
    ('[[jobs]]\npart="a.step"\ntool="ball:8"\nscallop=-1', "scallop is -1"),
    ("{scallop}\ntolerance=1", "machining tolerance is 1 mm: it must be a number from 0.0005 to 0.1 mm"),
    ("{scallop}\ntolerance='fine'", "machining tolerance is 'fine'"),
    ("{scallop}\ntolerance=true", "machining tolerance is True"),
    ('[[jobs]]\npart="gone.step"\ntool="ball:8"\nscallop=0.1', "gone.step' does not exist"),
    ('[[jobs]]\npart=""\ntool="ball:8"\nscallop=0.1', "path of the part is empty"),
    ("{scallop}\nfaces=true", "faces is True"), ("{scallop}\nfaces='3-1'", "faces '3-1' is not understood"),
    ("{scallop}\nregions=0", "sub-surfaces is 0"), ("{scallop}\norientations='few'", "orientations is 'few'"),
    ("{scallop}\nmachine='mill'", "machine 'mill' is neither"), ("{scallop}\noffset=[1,2,3]", "without a machine"),
    ("{scallop}\nlimits='sphere'", "limits 'sphere' are not understood"), ("{scallop}\nmethod='luck'", "luck"),
    ("{scallop}\ntimeout=0", "timeout is 0: give a finite number above zero"),
    ("{scallop}\nminutes=-5", "minutes is -5: give a finite number above zero"),
    ("{scallop}\nmemory='2G'", "memory is"),
    ("{scallop}\nafter='b'", "after is 'b': give the name of a job that stands before this one"),
    ("{scallop}\nafter='a'", "after is 'a': give the name of a job that stands before this one"),
    ("{scallop}\nafter=[1]", "after is 1: give the name"),
    ("{scallop}\n{scallop}\nname='b'\nafter=['a']\nfaces='1'", r"job 2 \(b\): faces are named, and earlier setups too"),
    ("{scallop}\nverify='yes'", "verify is 'yes': give true or false"), ("{scallop}\nname='../x'", "makes no folder"),
    ("{scallop}\nname='.work'", "makes no folder"), ("{scallop}\nobstacles=['no.step']", "no.step' does not exist"),
    ("{scallop}\n{scallop}", "jobs 1 and 2 are both called 'a'"),
    ("{scallop}\nname='One'\n{scallop}\nname='one'", "jobs 1 and 2 are both called"),
])
def test_a_wrong_job_is_refused_in_a_sentence(here: Path, text: str, said: str) -> None:
    good = '[[jobs]]\npart="a.step"\ntool="ball:8"\nscallop=0.1'
    with pytest.raises(InvalidInput, match=said) as caught:
        read(here, text.replace("{scallop}", good))
    assert "\n" not in str(caught.value)


def test_a_rack_is_several_tools_a_library_or_both_and_the_general_rack_where_nothing_is_named(here: Path) -> None:
    (here / "rack.toml").write_text('[[tool]]\nkind = "ball"\ndiameter = 6\n[[tool]]\nkind = "ball"\ndiameter = 3\n')
    some, library, both, general = read(here, """
        [defaults]
        part = "a.step"
        scallop = 0.02
        [[jobs]]
        name = "some"
        tool = ["ball:8", "ball:4"]
        [[jobs]]
        name = "library"
        tools = "rack.toml"
        [[jobs]]
        name = "both"
        tool = "torus:12x1"
        tools = "rack.toml"
        feedrate = 700
        [[jobs]]
        name = "general"
        """)
    radii = [[tool.radius for tool in job.tools] for job in (some, library, both)]
    assert radii == [[4, 2], [3, 1.5], [6, 3, 1.5]]
    assert len(general.tools) > 10 and len({job.key for job in (some, library, both, general)}) == 4
    options = [job.task().options for job in (some, both)]
    assert [(one["feedrate"], one["spindle"], one["objective"]) for one in options] == [(None, None, None),
                                                                                       (700.0, None, None)]


@pytest.mark.parametrize("more, said", [
    ({"tool": []}, "the rack is empty"), ({"tool": [3]}, "tool is 3: give a text, a Tool, or a list"),
    ({"tools": "general-rack", "stickout": 40}, "a holder or stick-out is given beside several tools"),
    ({"tools": "general-rack", "regions": 2}, "regions is planned with one tool and several are given"),
    ({"tool": ["ball:8", "ball:4"], "compare": True}, "a comparison is planned with one tool"),
])
def test_what_a_rack_cannot_do_ends_the_batch_before_it_begins(here: Path, more: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        read_jobs([{"name": "x", "part": here / "a.step", "scallop": 0.1, **more}])


def test_a_job_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"nowhere.toml does not exist"):
        read_jobs(tmp_path / "nowhere.toml")
    with pytest.raises(InvalidInput, match="cannot be read"):
        read_jobs(tmp_path)


def test_a_job_is_the_same_wherever_it_lies_and_another_one_with_every_other_setting(here: Path,
                                                                                     tmp_path: Path) -> None:
    first: dict[str, Any] = {"name": "x", "part": here / "a.step", "tool": "ball:8", "scallop": 0.1}
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    (moved / "c.step").write_text(STEP)
    same = [{}, {"tolerance": 0.01}, {"part": moved / "c.step"}, {"tool": ta.Tool.ball(diameter=8)}, {"name": "y"},
            {"timeout": 9}, {"memory": 900}]
    rough = {"strategy": "multiscale", "tool": "torus:10x3", "machine": "bc-table-table"}
    other = [{"part": here / "b.step"}, {"tool": "ball:6"}, {"scallop": 0.2}, {"faces": "1"}, {"regions": 2},
             {"stickout": 30}, {"obstacles": [here / "b.step"]}, {"machine": "mikron-ucp-710"}, {"verify": True},
             {"limits": "cone:0,0,1,45"}, {"feedrate": 500}, {"compare": True}, {"pictures": True},
             {"tolerance": 0.005}, {"minutes": 5}, {"strategy": "sturz"}, rough, {**rough, "roughness": 0.8}]
    keys = [read_jobs([{**first, **change}])[0].key for change in same]
    assert len(set(keys)) == 1
    others = [read_jobs([{**first, **change}])[0].key for change in other]
    assert len({keys[0], *others}) == len(other) + 1


def test_roughness_is_told_in_micrometres_and_only_where_it_is_looked_at(here: Path) -> None:
    job = {"part": here / "a.step", "tool": "torus:10x3", "scallop": 0.1, "machine": "bc-table-table"}
    asked = [{"strategy": "multiscale", "roughness": 0.8}, {"strategy": "multiscale"}, {}]
    assert [read_jobs([{**job, **more}])[0].task().options["roughness"] for more in asked] == [0.0008, None, None]
    for wrong, said in (({"roughness": 0.8}, "applies to strategy 'multiscale' only"),
                        ({"strategy": "multiscale", "roughness": -1}, "above zero"),
                        ({"strategy": "multiscale", "tool": "ball:8"}, "a smaller corner radius"),
                        ({"strategy": "multiscale", "machine": None}, "name a machine")):
        with pytest.raises(InvalidInput, match=said):
            read_jobs([{**job, **wrong}])


def test_a_part_that_changes_while_the_batch_runs_is_told(here: Path) -> None:
    job, = read_jobs([{"part": here / "a.step", "tool": "ball:8", "scallop": 0.1}])
    (here / "a.step").write_text("other")
    with pytest.raises(InvalidInput, match="changed while the batch ran"):
        job.task()
    (here / "a.step").unlink()
    with pytest.raises(InvalidInput, match="cannot be read"):
        job.task()


def test_objects_need_a_name_and_are_known_by_their_faces() -> None:
    points = [[[x, y, 0.01 * x * y] for y in range(4)] for x in range(4)]
    face, same = ta.Face.from_bspline(points), ta.Face.from_bspline(points)
    with pytest.raises(InvalidInput, match="needs one"):
        read_jobs([{"part": face, "tool": "ball:2", "scallop": 0.1}])
    keys = [read_jobs([{"name": "f", "part": part, "tool": "ball:2", "scallop": 0.1}])[0].key for part in (face, same)]
    assert keys[0] == keys[1]
    with pytest.raises(InvalidInput, match="has its own holder"):
        read_jobs([{"name": "f", "part": face, "tool": ta.Tool.ball(diameter=2), "stickout": 9.0, "scallop": 0.1}])


def test_the_example_of_the_manual_is_one(here: Path) -> None:
    manual = Path(__file__).parents[2] / "resources" / "manual" / "batches.md"
    (here / "bracket.step").write_text(STEP)
    text = manual.read_text(encoding="utf-8")
    first, second = read(here, text.partition("```toml\n")[2].partition("```")[0])
    assert (first.name, second.name, first.own["timeout"]) == ("bracket", "bracket-fine", 1800)
    assert all(f"{key}" in text for key in KEYS)
