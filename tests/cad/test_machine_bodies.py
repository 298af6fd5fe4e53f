"""Machines whose head is a STEP file: each solid as its convex hull, in the check, in plans and in their files."""

import re
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.machine.library import machine_from_toml, machine_to_toml
from toolaxis.machine.setup import Mounting

cadquery = pytest.importorskip("cadquery")


@pytest.fixture
def machine_file(tmp_path: Path) -> Path:
    """The BC table-table with a head from a file: a box of 100 x 60 x 80 and a cylinder of 30 mm radius beside it."""
    head = cadquery.Workplane("XY").box(100, 60, 80).translate((0, 0, 140)).union(
        cadquery.Workplane("XY").workplane(offset=20).center(300, 0).circle(30).extrude(100))
    cadquery.exporters.export(head, str(tmp_path / "head.step"))
    text = machine_to_toml(ta.load_machine("bc-table-table"))
    text = text[:text.index("[[body]]")] + """[[body]]
name = "table"
carried = "C"
box = [[-90, -90, -40], [90, 90, 0]]

[[body]]
name = "head"
carried = "Z"
step = "head.step"
"""
    (tmp_path / "machine.toml").write_text(text, encoding="utf-8")
    return tmp_path / "machine.toml"


def test_solids_are_read_as_their_hulls(machine_file: Path) -> None:
    machine = ta.load_machine(str(machine_file))
    head = [body for body in machine.bodies if body.name == "head"]
    assert len(head) == 2 and all(body.kind == "points" and body.carried == "Z" for body in head)
    ways = np.random.default_rng(2).normal(size=(100, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    box = np.abs(ways) @ [50.0, 30, 40] + ways @ [0, 0, 140.0]
    turned = 30 * np.hypot(ways[:, 0], ways[:, 1]) + 50 * np.abs(ways[:, 2]) + ways @ [300.0, 0, 70]
    far = [(body.convex.support(ways) * ways).sum(axis=1) for body in head]
    if far[0].max() > 250:
        far = far[::-1]
    assert (far[0] >= box - 1e-6).all() and (far[0] <= box + 0.5).all()
    assert (far[1] >= turned - 1e-6).all() and (far[1] <= turned + 3.0).all()


def test_a_plan_takes_the_hulls_along(machine_file: Path, tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(0, 20, 4), np.linspace(0, 15, 4), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.002 * (x - 10) ** 2], axis=-1))
    tool = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10.0, 0.0), (10.0, 40.0)])
    made = ta.plan(face, tool, 0.3, machine=str(machine_file), offset=(0.0, 0.0, 60.0), limits="cone:0,0,1,20")
    assert made.outcome == "complete" and "collision with the machine itself" not in made.not_checked
    again = machine_from_toml(machine_to_toml(made.machine.machine))
    assert [body.kind for body in again.bodies] == ["box", "points", "points"]


def test_a_missing_file_is_one_sentence(machine_file: Path) -> None:
    (machine_file.parent / "head.step").unlink()
    with pytest.raises(InvalidInput, match=r"body head: .*head\.step") as refused:
        ta.load_machine(str(machine_file))
    assert "\n" not in str(refused.value)
    with pytest.raises(InvalidInput, match=r"body head is the file .*head\.step and was not read"):
        Mounting(machine_from_toml(machine_file.read_text(encoding="utf-8"), machine_file.parent))


def test_a_body_that_lacks_a_face_is_refused(machine_file: Path) -> None:
    """The hull of the other faces might not hold it."""
    head = machine_file.parent / "head.step"
    text = head.read_text()
    surface = re.search(r"= CYLINDRICAL_SURFACE\('',#(\d+)", text).group(1)
    point = re.search(rf"#{surface} = AXIS2_PLACEMENT_3D\('',#(\d+)", text).group(1)
    head.write_text(re.sub(rf"(#{point} = CARTESIAN_POINT\('',\()[^,]*", r"\g<1>1.E+30", text))
    with pytest.raises(InvalidInput, match=r"body head: .*head\.step: face \d+ \(#\d+\) was left out: its coordinate"):
        ta.load_machine(str(machine_file))
