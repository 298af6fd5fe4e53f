"""Machine files: what they may say, and one sentence for what they may not."""

import json
from math import radians
from pathlib import Path

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import Drive
from toolaxis.machine.freecad_machine import machine_from_fcm
from toolaxis.machine.kinematics import inverse, placement, rotary_angles
from toolaxis.machine.library import library, load_machine, machine_from_toml

LINEAR = "".join(f'[[linear]]\nname="{name}"\ndirection={way}\nlimits=[-100,100]\n'
                 "velocity=500\nacceleration=2500\njerk=5000\n"
                 for name, way in (("X", [1, 0, 0]), ("Y", [0, 1, 0]), ("Z", [0, 0, 1])))
TABLE = '[[table]]\nname="A"\ndirection=[1,0,0]\nlimits=[-30,120]\nvelocity=90\nacceleration=300\njerk=1800\n'
GOOD = 'name="mill"\n' + LINEAR + TABLE


def test_the_good_one() -> None:
    machine = machine_from_toml(GOOD)
    assert machine.names == ("X", "Y", "Z", "A") and machine.kind == "table"
    assert machine.rotary[0].high == pytest.approx(radians(120)) and machine.linear[0].high == 100


@pytest.mark.parametrize(("old", "new", "said"), [
    ('name="mill"', "", "no name"),
    ('name="mill"', 'name="mill"\ncolour="red"', "unknown 'colour'"),
    ('name="A"', 'name="Q"', "'Q' is no name of a rotary axis: use one of A, B, C"),
    ('name="Y"', 'name="X"', "two axes X"),
    ("velocity=90", "velocity=-90", "velocity of axis A is -1.57"),
    ("velocity=90", "velocity=0", "must be a finite number above zero"),
    ("velocity=500", "velocity=nan", "must be a finite number above zero"),
    ("jerk=1800", "", "axis A has no jerk"),
    ("jerk=5000", 'jerk="much"', "jerk of axis X is 'much'"),
    ("limits=[-30,120]", "limits=[120,-30]", "the lower one comes first"),
    ("limits=[-30,120]", "limits=[120]", "2 numbers are needed"),
    ("direction=[1,0,0]\nlimits=[-30,120]", "direction=[0,0,0]", "not all zero"),
    ("direction=[1,0,0]\nlimits=[-30,120]", "direction=[0,0,1]", "lies along the spindle"),
    ("direction=[0, 1, 0]", "direction=[1, 0, 0]", "do not lie in one plane"),
    ("jerk=1800", "jerk=1800\nby_hand=true", "set by hand and has a velocity"),
    ("jerk=1800", "jerk=1800\nincrement=-1", "increment of axis A"),
    ('name="mill"', 'name="mill', "not valid TOML"),
    (TABLE, TABLE + TABLE.replace('"A"', '"B"'), "are parallel"),
    (TABLE, TABLE + TABLE.replace('"A"', '"B"').replace("[1,0,0]", "[0,1,0]")
     + TABLE.replace('"A"', '"C"').replace("[1,0,0]", "[0,0,1]"), "3 rotary axes: at most two"),
    ('name="mill"', 'name="mill"\nspindle=[0,0]', "3 numbers are needed"),
    (TABLE, "", ""),
    ("[[linear]]", "linear = 3\n[[linear]]", "not valid TOML"),
])
def test_bad_files(old: str, new: str, said: str) -> None:
    text = GOOD.replace(old, new, 1)
    if not said:
        assert machine_from_toml(text).kind == "three axes"
        return
    with pytest.raises(InvalidInput) as caught:
        machine_from_toml(text)
    assert said in str(caught.value) and "\n" not in str(caught.value)


def test_the_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(GOOD.replace("jerk=1800", ""))
    with pytest.raises(InvalidInput, match=r"machine file bad\.toml: axis A has no jerk"):
        load_machine(str(path))
    with pytest.raises(InvalidInput, match="neither a file nor one of the library: ab-trunnion"):
        load_machine("nonsense")


def test_a_library_of_ones_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mill.toml").write_text(GOOD)
    monkeypatch.setenv("TOOLAXIS_MACHINES", str(tmp_path))
    assert load_machine("mill").name == "mill" and next(iter(library())) == "mill"


def test_wrong_poses() -> None:
    machine = load_machine("mikron-ucp-710")
    for bad in (np.eye(3), np.diag([1.0, 1, -1, 1]), np.diag([2.0, 2, 2, 1]), [1.0, 2.0, np.nan]):
        with pytest.raises(InvalidInput, match="work offset"):
            placement(bad)
    with pytest.raises(InvalidInput, match="no direction"):
        rotary_angles(machine, (0, 0, 0))
    with pytest.raises(InvalidInput, match="2 finite ones"):
        rotary_angles(machine, (0, 0, 1), near=(1.0,))
    with pytest.raises(InvalidInput, match="one for each"):
        inverse(machine, np.zeros((3, 3)), np.eye(3)[:2])


def _freecad(axes: dict[str, object]) -> str:
    return json.dumps({"freecad_version": "26.3.0", "version": 1, "machine": {"name": "from FreeCAD", "units": "metric",
                                                                              "axes": axes}})


def _line(way: list[int], **more: object) -> dict[str, object]:
    return {"type": "linear", "joint": {"origin": [0, 0, 0], "axis": way}, "limits": {"min": 0, "max": 400},
            "max_velocity": 12000, "role": "head_linear", **more}


THREE = {"X": _line([1, 0, 0]), "Y": _line([0, 1, 0]), "Z": _line([0, 0, 1])}
TRUNNION = {"C": {"type": "angular", "joint": {"origin": [0, 0, 5], "axis": [0, 0, 1]},
                  "limits": {"min": -360, "max": 360}, "max_velocity": 3600, "role": "table_rotary", "sequence": 0},
            "A": {"type": "angular", "joint": {"origin": [0, 0, 5], "axis": [1, 0, 0]},
                  "limits": {"min": -120, "max": 120}, "max_velocity": 1800, "role": "table_rotary", "sequence": 1,
                  "parent": "C"}}


def test_freecads_machine() -> None:
    machine = machine_from_fcm(_freecad({**TRUNNION, **THREE}))
    assert machine.chain == "w C' A' b X Y Z t" and machine.linear[2].drive == Drive(200.0)
    assert machine.rotary[1].high == pytest.approx(radians(120)) and machine.rotary[0].point.tolist() == [0, 0, 5]
    with pytest.raises(InvalidInput, match="axis X has no acceleration"):
        machine.linear[0].drive.levels("X")


def test_freecads_older_files() -> None:
    old = {name: {"type": "linear", "joint": [way, [0, 0, 0]], "min": 0, "max": 1000, "sequence": 0}
           for name, way in (("X", [1, 0, 0]), ("Y", [0, 1, 0]), ("Z", [0, 0, 1]))}
    machine = machine_from_fcm(_freecad(old))  # type: ignore[arg-type]
    assert machine.kind == "three axes" and machine.linear[1].high == 1000
    assert machine.directions.tolist() == np.eye(3).tolist()
    head = {"B": {"type": "rotary", "joint": [[0, 0, 0], [0, 1, 0]], "role": "head_rotary", "sequence": 0},
            "C": {"type": "rotary", "joint": [[0, 0, 0], [0, 0, 1]], "role": "head_rotary", "sequence": 1}}
    assert machine_from_fcm(_freecad({**THREE, **head})).chain == "w b X Y Z C B t"


@pytest.mark.parametrize(("text", "said"), [
    ("{", "not a FreeCAD machine file"), ("[]", "not a FreeCAD machine file"), ("{}", "not a FreeCAD machine file"),
    (_freecad({**THREE, "X": 3}), "axis X is 3"),
    (_freecad({**THREE, "X": _line([1, 0, 0], type="curved")}), "type of axis X is 'curved'"),
    (_freecad({**THREE, "X": _line([1, 0, 0], role="table_rotary")}), "role of axis X"),
    (_freecad({**THREE, "X": _line([1, 0, 0], max_velocity="fast")}), "max_velocity of axis X is 'fast'"),
    (_freecad({**THREE, "X": _line([1, 0, 0], joint=[[0, 0, 0]])}), "joint of axis X"),
    (_freecad({**THREE, "X": _line([0, 0, 0])}), "direction of axis X"),
    (_freecad({"X": _line([1, 0, 0])}), "do not lie in one plane"),
])
def test_bad_freecad_files(text: str, said: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        machine_from_fcm(text)
    assert said in str(caught.value)


def test_a_real_freecad_machine_file() -> None:
    roots = ("/usr/share/freecad", "/usr/lib/freecad")
    files = [path for root in roots for path in Path(root).rglob("Machine/machines/*.fcm")]
    if not files:
        pytest.skip("no FreeCAD with machine files is installed here")
    for path in files:
        load_machine(str(path))
