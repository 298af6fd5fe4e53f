"""Programs of machines with one rotary axis: what they say is the path that was planned."""

import numpy as np
import pytest
from benchmarks._blades import loft

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.job.files.read_cl import read_cl
from toolaxis.job.output.post import post_plan
from toolaxis.machine.setup import Mounting
from toolaxis.post.context import Options

TOOL = ta.Tool.ball(8, stickout=90, holder=[(12.5, 0), (12.5, 60)])
PLACE = np.array([10.0, -5.0, 20.0])


@pytest.fixture(scope="module")
def plan():
    face = loft("turbine", 5.0, place=lambda p: np.stack([p[..., 2], p[..., 0], p[..., 1]], axis=-1))
    return ta.plan(face, TOOL, 0.1, strategy="blade", machine="four-axis-a", offset=PLACE, direction="climb", workers=1)


def mounting():
    return Mounting(ta.load_machine("four-axis-a"), np.block([[np.eye(3), PLACE[:, None]], [np.zeros(3), 1.0]]))


@pytest.mark.parametrize("dialect", ["heidenhain", "siemens"])
def test_a_program_with_one_rotary_axis_says_the_path(plan, dialect, tmp_path):
    files = post_plan(plan, dialect, mounting(), Options())
    name = next(name for name in files if name.startswith("program"))
    (tmp_path / name).write_text(files[name])
    found = read_cl(tmp_path / name, "four-axis-a", offset=PLACE)
    path = plan.operations[0].path
    for tip, axis in zip(path.cl[5:-5:97], path.axis[5:-5:97], strict=True):
        away = np.linalg.norm(found.tip - tip, axis=1)
        k = int(np.argmin(away + np.linalg.norm(found.axis - axis, axis=1)))
        assert away[k] < 2e-3 and np.linalg.norm(found.axis[k] - axis) < 2e-4


def test_fanuc_needs_two(plan):
    with pytest.raises(InvalidInput, match=r"drives 1 rotary axes: Fanuc G43\.4 needs two"):
        post_plan(plan, "fanuc", mounting(), Options())
