"""Documents that the add-on saved before it knew divisions, machines and jobs: they open, and go on as if made today.

They were saved by commit 1816a7b in FreeCAD 1.1 and 1.0: a block with one operation on its wavy face.
"""

import shutil
from pathlib import Path

import FreeCAD
import pytest
from freecad.toolaxis import bridge
from freecad.toolaxis.objects import is_operation
from freecad.toolaxis.objects.passes import moves
from freecad.toolaxis.results import child

SAVED = Path(__file__).with_name("saved")
NEWER = FreeCAD.Version()[:2] >= ["1", "1"]
#: A newer FreeCAD opens both, an older one its own.
FILES = ["before-divisions-1.0.FCStd", *(["before-divisions.FCStd"] if NEWER else [])]


@pytest.fixture(params=FILES)
def opened(request, tmp_path):
    shutil.copy(SAVED / request.param, tmp_path)
    document = FreeCAD.openDocument(str(tmp_path / request.param))
    yield document
    FreeCAD.closeDocument(document.Name)


@pytest.fixture
def operation(opened):
    return next(thing for thing in opened.Objects if is_operation(thing))


def test_it_opens_as_it_was_saved(opened, operation, parts):
    """Results are those of that time and nothing is stale; what came later is there with its plain value."""
    assert operation.Outcome == "feasible" and not operation.Stale and not bridge.is_stale(operation)
    assert operation.Axis.getAngle(parts.LEANING) < 1e-9
    assert operation.Passes == 5 and len(moves(child(operation, "Path::Feature"))[0]) > 100
    fresh = parts.planned(opened, (opened.getObject("Block"), parts.sculptured_name(opened.getObject("Block"))))[0]
    assert set(fresh.PropertiesList) == set(operation.PropertiesList)
    opened.recompute(None, True)
    assert not operation.Stale, operation.StaleReasons


def test_it_is_verified_and_planned_again(opened, operation, parts):
    assert bridge.verify(operation).passed
    inputs = bridge.inputs_of(operation)
    assert (inputs.tool, inputs.scallop, inputs.holder) == (parts.TOOL, parts.SCALLOP, parts.HOLDER)
    again = parts.planned(opened, *inputs.faces)[0]
    assert again.Passes == operation.Passes
    assert again.CuttingLength.Value == pytest.approx(operation.CuttingLength.Value, rel=1e-9)
