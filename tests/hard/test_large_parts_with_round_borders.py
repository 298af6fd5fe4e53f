"""Found: a large part had no axis: loops strayed from round borders by a share of the size, into the cutter's way."""

import numpy as np
import pytest

import toolaxis as ta

cq = pytest.importorskip("cadquery")


@pytest.mark.parametrize("size", [100.0, 1000.0])
def test_the_flat_top_of_an_obliquely_cut_cylinder_is_machined_whatever_its_size(size: float) -> None:
    above = cq.Workplane("XZ").polyline([(-2 * size, 0.2 * size), (2 * size, size), (2 * size, 3 * size),
                                         (-2 * size, 3 * size)]).close().extrude(2 * size, both=True)
    part = ta.load(cq.Workplane().circle(size).extrude(size).cut(above))
    upright = [face.normal(face.grid(3, 3))[0, 2] for face in part.faces]
    top = part.faces[int(np.argmax(upright))]
    found = ta.best_axis(top, ta.Tool.ball(diameter=size / 5), size / 50, "cone:-0.2,0,1,4", part=part)
    assert found.outcome == "feasible", found.reasons
    assert found.gouge <= 0.002
