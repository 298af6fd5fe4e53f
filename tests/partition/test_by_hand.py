"""Sub-surfaces put together, cut apart and cut out: areas add up, and what cannot be is refused in a sentence."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.partition.manual_edit import cut_along, cut_out, halves, merge_sub_surfaces
from toolaxis.shape.face import Face

QUARTER = np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])


def sheet() -> Face:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 20, 5), indexing="ij")
    return Face.from_bspline(np.dstack([x, y, 2 * np.sin(x / 10)]))


def pieces(loops: list[tuple[np.ndarray, ...]]) -> list[Face]:
    return [sheet().trimmed(loop, f"1{'abcdefg'[k]}") for k, loop in enumerate(loops)]


def quarters() -> list[Face]:
    return pieces([(QUARTER + shift,) for shift in ([0, 0], [0.5, 0], [0, 0.5], [0.5, 0.5])])


def test_halves_are_cut_across_the_longer_side_and_can_be_put_together_again() -> None:
    whole = sheet()
    parts = pieces(list(halves(whole)))
    assert len(parts) == 2 and sum(one.area for one in parts) == pytest.approx(whole.area, rel=1e-9)
    assert [one.bounds[:2] for one in parts] == [(0.0, 0.5), (0.5, 1.0)], "the sheet is longer along u"
    assert [one[0][:, 1].max() for one in halves(whole, "v", 0.25)] == [0.25, 1.0]
    assert sheet().trimmed(merge_sub_surfaces(parts)).area == pytest.approx(whole.area, rel=1e-9)


def test_three_of_four_quarters_make_an_angle() -> None:
    four = quarters()
    loops = merge_sub_surfaces([four[0], four[3], four[1]])
    assert len(loops) == 1 and sheet().trimmed(loops).area == pytest.approx(sum(four[k].area for k in (0, 1, 3)))
    with pytest.raises(ta.InvalidInput, match="1a does not touch 1d along a line"):
        merge_sub_surfaces([four[0], four[3]])


def test_a_line_cuts_and_goes_on_beyond_its_ends() -> None:
    whole = sheet()
    found = pieces(list(cut_along(whole, [[0.4, 0.3], [0.6, 0.7]])))
    assert len(found) == 2 and sum(one.area for one in found) == pytest.approx(whole.area, rel=1e-6)
    assert all(one.area > 0.4 * whole.area for one in found)
    bent = pieces(list(cut_along(whole, [[0.3, 0.1], [0.5, 0.5], [0.3, 0.9]])))
    assert sum(one.area for one in bent) == pytest.approx(whole.area, rel=1e-6)
    assert sheet().trimmed(merge_sub_surfaces(bent)).area == pytest.approx(whole.area, rel=1e-9)


def test_a_closed_line_cuts_out_of_all_that_it_meets() -> None:
    four = quarters()
    ring = [[0.25, 0.3], [0.7, 0.3], [0.7, 0.75], [0.25, 0.75]]
    own, stay = cut_out(four, ring)
    area = sheet().trimmed(own).area
    assert area == pytest.approx(sheet().trimmed((np.array(ring),)).area, rel=1e-6)
    left = sum(sheet().trimmed(loops).area for rest in stay for loops in rest)
    assert area + left == pytest.approx(sheet().area, rel=1e-6)
    assert [len(rest) for rest in stay] == [1, 1, 1, 1]


def test_a_sub_surface_inside_the_line_goes_as_a_whole() -> None:
    own, stay = cut_out(quarters(), [[-0.2, -0.2], [0.6, -0.2], [0.6, 0.6], [-0.2, 0.6]])
    assert stay[0] == () and sheet().trimmed(own).bounds == pytest.approx((0, 0.6, 0, 0.6), abs=1e-5)


@pytest.mark.parametrize(("line", "words"), [
    ([[2.0, 0.1], [2.0, 0.9]], "does not cross"), ([[0.5, 0.5]], "1 different corners"),
    ([[0.5, 0.5], [0.5, 0.5]], "1 different corners"), ([[0.5, np.nan], [1, 1]], "no corners")])
def test_lines_that_do_not_cut_are_refused(line: list[list[float]], words: str) -> None:
    with pytest.raises(ta.InvalidInput, match=words):
        cut_along(sheet(), line)


def test_a_closed_line_beside_the_face_is_refused() -> None:
    with pytest.raises(ta.InvalidInput, match="nothing of the face lies"):
        cut_out([sheet()], [[2, 2], [3, 2], [3, 3]])
    with pytest.raises(ta.InvalidInput, match="does not cross sub-surface 1"):
        halves(sheet(), "u", 1.5)
    with pytest.raises(ta.InvalidInput, match="two or more of one face"):
        merge_sub_surfaces([sheet()])
