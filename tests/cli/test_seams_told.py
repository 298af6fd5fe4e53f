"""A file whose faces do not meet: `inspect` lists where, `plan` names and keeps it, and neither side charges it."""

import json
import re
from pathlib import Path

import cadquery as cq
import pytest

from toolaxis.cad.load import load
from toolaxis.cli.main import main
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.job.output.verify import verify_plan

LOW = 0.004


@pytest.fixture(scope="module")
def lowered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A box whose top was moved 0.004 mm down in its file: edges and sides stand where they were."""
    path = tmp_path_factory.mktemp("lowered") / "box.step"
    cq.exporters.export(cq.Workplane().box(30, 20, 10), str(path))
    text = path.read_text()
    frames = re.findall(r"= PLANE\('',#(\d+)\)", text)
    for frame in frames:
        placed = re.search(rf"#{frame} = AXIS2_PLACEMENT_3D\('',\s*#(\d+),\s*#(\d+)", text)
        assert placed is not None
        point, way = placed.groups()
        at = re.search(rf"#{point} = CARTESIAN_POINT\('',\(([^)]*),5.\)\)", text)
        if at and re.search(rf"#{way} = DIRECTION\('',\(0.,0.,1.\)\)", text):
            whole = f"#{point} = CARTESIAN_POINT('',({at.group(1)},5.))"
            path.write_text(text.replace(whole, whole.replace(",5.)", f",{5 - LOW})")))
            return path
    raise AssertionError("the file of the box has no plane z = 5")


def top_of(path: Path) -> int:
    return next(face.number for face in load(path).faces if face.box[0][2] > 4)


def test_inspect_lists_the_widest(lowered: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(lowered)]) == 0
    told = capsys.readouterr()
    assert told.err.count("apart along their shared edge near") == 4
    assert "4 pairs, the widest gaps first" in told.out
    assert main(["inspect", str(lowered), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["seams"]
    assert len(found) == 4
    top = top_of(lowered)
    for seam in found:
        assert top in seam["faces"] and seam["kind"] == "convex" and not seam["counted"]
        assert seam["gap"] == pytest.approx(LOW) and seam["step"] == pytest.approx(LOW)


def test_plan_and_verify_do_not_charge_it(lowered: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(lowered), "--tool=ball:8", "--scallop=0.2", "--tolerance=0.002",
                 f"--faces={top_of(lowered)}", "--no-pictures", "--out", str(out)]) == 0
    told = capsys.readouterr()
    assert (told.out + told.err).count("are 0.0040 mm apart along their shared edge") == 4
    document = json.loads((out / "plan.json").read_text())
    assert len(document["part"]["seams"]) == len(document["part"]["warnings"]) == 4
    assert document["operations"][0]["orientation"]["gouge"] <= document["inputs"]["tolerance"]["gouge"]
    verdict = verify_plan(read_plan(out))
    assert verdict.passed, verdict.reasons
