"""The origin and the stock of a plan: in its frames, on disk, in programs and on their setup sheet."""

import json
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.post import post_plan
from toolaxis.job.planning.edit_origin import with_origin
from toolaxis.plan.plan import Plan

MARGINS = (1.0, 2.0, 3.0, 4.0, 0.0, 5.0)
#: Of the part below: its box reaches from 0, 0, 0 to 20, 16, 1.
CORNER = [-1.0, -3.0, 6.0]
_MOTION = re.compile(r"G[01] X(\S+) Y(\S+) Z(\S+)")


@cache
def planned() -> Plan:
    x, y = np.meshgrid(np.linspace(0, 20, 5), np.linspace(0, 16, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.01 * (x - 10) ** 2], axis=-1))
    return ta.plan(ta.Part.from_faces([face]), "ball:6", 0.1, machine="mikron-ucp-710", workers=1,
                   origin="stock:top-front-left", stock_box=MARGINS)


def first_point(text: str) -> list[float]:
    """The first point of a program's passes, in its plane."""
    return next([float(word) for word in found.groups()] for found in map(_MOTION.search, text.splitlines()) if found)


def test_frames_have_their_origin_on_the_stock() -> None:
    plan = planned()
    box = plan.part.box
    corner = [box[0, 0] - 1, box[0, 1] - 3, box[1, 2] + 5]
    assert np.allclose(plan.datum, CORNER) and np.allclose(corner, CORNER)
    assert all(op.frame is None or np.allclose(op.frame.origin, CORNER) for op in plan.operations)
    assert plan.blank is not None and np.allclose(plan.blank.size, box[1] - box[0] + [3, 7, 5])


def test_it_comes_back_from_disk_and_old_files_have_none(tmp_path: Path) -> None:
    plan = write_plan(planned(), tmp_path)
    back = read_plan(tmp_path)
    assert back.inputs.origin == "stock:top-front-left" and back.inputs.stock_margins == MARGINS
    assert np.allclose(back.datum, plan.datum) and back.blank == plan.blank
    document = json.loads((tmp_path / "plan.json").read_text())
    del document["inputs"]["origin"], document["inputs"]["stock_box"]
    (tmp_path / "plan.json").write_text(json.dumps(document))
    older = read_plan(tmp_path)
    assert older.inputs.origin == "" and older.blank is None and np.allclose(older.datum, plan.datum)


def test_another_origin_moves_programs_and_nothing_else() -> None:
    plan = planned()
    other = with_origin(plan, "part:top", None)
    shift = other.datum - plan.datum
    assert shift[2] == pytest.approx(-5.0) and other.blank is None
    for before, after in zip(plan.operations, other.operations, strict=True):
        assert after.path is before.path and after.orientation is before.orientation
        assert after.frame is not None and np.array_equal(after.frame.origin, other.datum)
    texts = [next(text for file, text in post_plan(one, "fanuc", plan.machine).items() if file.endswith(".nc"))
             for one in (plan, other)]
    assert "(ORIGIN: FRONT LEFT CORNER OF THE TOP OF THE STOCK)" in texts[0]
    assert "(ORIGIN: MIDDLE OF THE TOP OF THE PART)" in texts[1]
    assert with_origin(other, plan.inputs.origin, MARGINS).datum == pytest.approx(plan.datum)
    assert with_origin(plan, "", None, (1.0, 2.0, 3.0)).datum.tolist() == [1, 2, 3]


def test_the_program_counts_from_the_origin() -> None:
    """The points of a program, in its plane, are as far apart as the origins that they count from."""
    plan = planned()
    other = with_origin(plan, "point:3,4,0", None)
    points = [first_point(next(text for file, text in post_plan(one, "fanuc", plan.machine).items()
                               if file.endswith(".nc"))) for one in (plan, other)]
    away = np.linalg.norm(np.subtract(*points))
    assert away == pytest.approx(np.linalg.norm(other.datum - plan.datum), abs=2e-3)


def test_the_setup_sheet_tells_origin_and_stock() -> None:
    plan = planned()
    sheet = next(text for file, text in post_plan(plan, "fanuc", plan.machine).items() if file.startswith("setup"))
    assert ("Origin: front left corner of the top of the stock, at -1.0000, -3.0000, 6.0000 in the part's frame."
            in sheet)
    assert plan.blank is not None
    height = plan.blank.size[2]
    assert (f"Stock: 23.000 x 23.000 x {height:.3f} mm along the part's axes; from the origin X 0.0000 to 23.0000, "
            f"Y 0.0000 to 23.0000, Z {-height:.4f} to 0.0000.") in sheet
    bare = with_origin(plan, "", None)
    sheet = next(text for file, text in post_plan(bare, "fanuc", plan.machine).items() if file.startswith("setup"))
    assert "Origin: the datum of the plan, at 0.0000, 0.0000, 0.0000" in sheet and "Stock: " not in sheet


def test_what_does_not_go_together_is_refused() -> None:
    plan = planned()
    with pytest.raises(ta.InvalidInput, match="is a point of the stock and there is none"):
        with_origin(plan, "stock:top", None)
    with pytest.raises(ta.InvalidInput, match="datum and origin 'part:top' are both given"):
        with_origin(plan, "part:top", None, (1.0, 0.0, 0.0))


def test_a_batch_takes_them(tmp_path: Path) -> None:
    part = ta.Part.from_faces([planned().part.faces[0]])
    job, = read_jobs([{"name": "one", "part": part, "tool": "ball:6", "scallop": 0.1, "origin": "stock:top",
                       "stock_box": list(MARGINS)}])
    assert job.task().options["origin"] == "stock:top" and job.task().options["stock_box"] == "1,2,3,4,0,5"
