"""Pictures of a plan are drawn by several processes at once: the same ones, each whole, and a failure costs its own."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import Cancelled, JobError
from toolaxis.job.output import pictures
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.verify.verdict import Verdict


def sheet(x: float) -> ta.Face:
    grid = np.meshgrid([x, x + 10.0, x + 20.0], [0.0, 10.0, 20.0], indexing="ij")
    return ta.Face.from_bspline(np.stack([*grid, 0.02 * (grid[0] - x) * grid[1]], axis=-1), degree=(2, 2))


@pytest.fixture(scope="module")
def made() -> Plan:
    """Of three faces: with two processes the last is begun when one of the others is finished."""
    return ta.plan([sheet(0.0), sheet(40.0), sheet(80.0)], "ball:12", 0.2, machine="cone:0,0,1,10", workers=1)


@pytest.fixture(scope="module")
def judged(made: Plan) -> Verdict:
    return ta.verify(made, spacing=1.0)


def images(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_any_number_of_processes_draws_the_same(made: Plan, judged: Verdict, tmp_path: Path) -> None:
    drawn = []
    for workers in (1, 2):
        folder = tmp_path / str(workers)
        folder.mkdir()
        pictures.draw_verdict(made, judged, folder, workers=workers)
        drawn.append(images(folder))
    assert drawn[0] == drawn[1]
    assert drawn[0].keys() == {f"{op.name}-verdict.png" for op in made.operations}


def test_what_cannot_be_drawn_costs_no_other_picture(made: Plan, tmp_path: Path,
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a plan, and the others are the same with one process and two."""
    first, *others = made.operations
    usual = pictures.operation_picture

    def fail(plan: Plan, op: object) -> object:
        if op is first:
            raise ZeroDivisionError("no width")
        return usual(plan, op)

    monkeypatch.setattr(pictures, "operation_picture", fail)
    drawn = []
    for workers in (1, 2):
        folder = tmp_path / str(workers)
        folder.mkdir()
        with pytest.raises(JobError, match=f"drawing, {first.name}: failed: ZeroDivisionError: no width"):
            pictures.draw_plan(made, folder, workers=workers)
        drawn.append(images(folder))
    assert drawn[0] == drawn[1]
    assert {f"{op.name}-passes.png" for op in others} < drawn[0].keys()
    assert not any(name.startswith(first.name) for name in drawn[0])


@pytest.mark.parametrize("workers", [1, 2])
def test_a_stop_leaves_whole_pictures_only(made: Plan, judged: Verdict, tmp_path: Path, workers: int) -> None:
    asked = []

    def stop() -> bool:
        asked.append(True)
        return any(tmp_path.glob("op*.png"))

    with pytest.raises(Cancelled):
        pictures.draw_verdict(made, judged, tmp_path, Progress(None, stop), workers=workers)
    assert asked and all(path.is_file() for path in tmp_path.iterdir()), "no folder stays"
    for image in images(tmp_path).values():
        assert image.startswith(b"\x89PNG") and image.endswith(b"IEND\xaeB`\x82")
