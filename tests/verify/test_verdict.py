"""The verdict on operations that are known to be good or bad."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.progress import Progress
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.verify.component_clearance import Clearance
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import NOT_CHECKED, judge, verify

WIDTH = 2.171571  # R6 r1, lead 10 deg, h = 0.02
HOLDER = {"holder": np.array([[12.0, 40.0], [12.0, 80.0]])}


def rectangle(corner, one, two, number=1):
    corner, one, two = (np.asarray(x, dtype=float) for x in (corner, one, two))
    face = Face.from_bspline(np.array([[corner + s * one + t * two for t in (0, 1)] for s in (0, 1)]), degree=(1, 1))
    return replace(face, number=number, label=str(number))


FLOOR = rectangle([-8, -8, 0], [16, 0, 0], [0, 16, 0], 7)


def task(plane_passes, width=0.999 * WIDTH, **change):
    offsets = -8 + width * (np.arange(int(np.ceil(16 / width)) + 1) - 0.25)
    tips, axes, kind = plane_passes((6, 1), np.radians(10), offsets, span=(-10.0, 10.0))
    return replace(VerificationTask("floor", tips, axes, kind, Profile(5, 1, 0, 24), (FLOOR,), 0.02, outlines=HOLDER),
                   **change)


def test_good_passes_pass_and_every_figure_stands(plane_passes):
    found = judge(task(plane_passes), spacing=0.3)
    assert found.passed
    assert found.share_within == 1.0
    assert found.scallop_max == pytest.approx(0.02 * 0.999**2, rel=1e-3)
    assert found.gouge_max < 1e-6
    assert found.worst_gouge == ()
    assert found.zones == ()
    assert found.area == pytest.approx(256, rel=1e-9)
    assert found.faces == ("7",)
    assert found.rays > 2500
    assert found.uncertainty < 1e-5
    assert found.clearance["cutter"] == found.clearance["shank"] == NOT_CHECKED
    assert set(found.reasons) == {"cutter not checked: there is nothing besides the machined skin",
                                  "shank not checked: its outline is not known"}
    # The holder's rim is 40 cos - 12 sin above the tip, which lies 1 - cos + 5 sin below its height over the contact.
    assert isinstance(found.clearance["holder"], Clearance)
    assert found.clearance["holder"].distance > 30


def test_passes_too_far_apart_fail_by_the_share_they_leave(plane_passes):
    found = judge(task(plane_passes, 1.1 * WIDTH), spacing=0.3)
    assert not found.passed
    assert found.scallop_max == pytest.approx(0.02 * 1.1**2, rel=0.01)
    # The section is a parabola in good measure: it is above 1.02 h beyond sqrt(1.02) / 1.1 of the half distance.
    assert found.share_within == pytest.approx(np.sqrt(1.02) / 1.1, abs=0.02)
    assert "of the area is within 1.02 times the scallop limit 0.02 mm, 99.90 % must be" in found.reasons[0]


def test_allowance_moves_the_target(plane_passes):
    raised = task(plane_passes)
    raised = replace(raised, tips=raised.tips + np.array([0, 0, 0.3]))
    assert judge(replace(raised, allowance=0.3), spacing=0.5).passed
    assert judge(raised, spacing=0.5).share_within == 0.0
    thin = judge(replace(raised, allowance=0.31), spacing=0.5)
    assert thin.gouge_max == pytest.approx(0.01, abs=1e-4)


def test_missing_pass_is_a_zone_not_reached(plane_passes):
    whole = task(plane_passes)
    lost = (np.abs(whole.tips[:, 1] - 0.58 * WIDTH) > 1.2 * WIDTH) | (whole.kind == 3)
    holed = replace(whole, tips=whole.tips[lost], axes=whole.axes[lost], kind=whole.kind[lost])
    found = judge(holed, spacing=0.3)
    assert not found.passed
    assert len(found.zones) >= 1
    assert "the largest of" in found.reasons[0]
    assert "on face 7" in found.reasons[0]


WIDE = rectangle([-8, -8, 0], [16, 0, 0], [0, 32, 0], 7)


def beyond(y):
    """The piece of the wide floor on the far side of y."""
    v = (y + 8) / 32
    return WIDE.trimmed((np.array([[0, v], [1, v], [1, 1], [0, 1.0]]),))


def test_in_declared_zones_nothing_is_asked_for(plane_passes):
    bare = task(plane_passes, targets=(WIDE,))
    lost = judge(bare, spacing=0.5)
    assert not lost.passed
    assert lost.share_within == pytest.approx(0.55, abs=0.05)
    assert lost.zones[0].reason == "not reached"
    edge = 9.8  # a little before the strip of the last pass ends
    found = judge(replace(bare, left=(beyond(edge),)), spacing=0.5)
    assert found.passed
    assert found.share_within == 1.0
    assert not found.zones
    assert found.scallop_max <= 0.02 * 1.02
    assert found.declared == pytest.approx(16 * (24 - edge), rel=0.02)


def test_a_zone_declared_too_small_does_not_hide_what_lies_beside_it(plane_passes):
    """The same share of the area elsewhere would hide it, were shares compared."""
    bare = task(plane_passes, targets=(WIDE,))
    found = judge(replace(bare, left=(beyond(12.0),)), spacing=0.5)
    assert not found.passed
    assert found.zones[0].low[1] == pytest.approx(9.9, abs=0.5)
    assert found.zones[0].high[1] < 12.0
    assert "of the area that is not left as rest material is within" in found.reasons[0]
    good = WIDE.trimmed((np.array([[0, 0], [1, 0], [1, 0.48], [0, 0.48]]),))  # all of it is machined
    assert not judge(replace(bare, left=(good,)), spacing=0.5).passed


def test_just_outside_of_a_zone_is_a_strip_in_which_nothing_is_asked_for(plane_passes):
    """Outlines are straight between their vertices: a hundredth of the cutter's radius beside them is theirs."""
    floor = replace(FLOOR, number=7, label="7")
    half = floor.trimmed((np.array([[0, 0], [0.5, 0], [0.5, 1], [0, 1.0]]),))
    found = judge(task(plane_passes, targets=(floor,), left=(half,)), spacing=0.05)
    assert found.declared == pytest.approx(16 * (8 + 0.01 * 6), rel=2e-3)


def test_planted_gouge_is_named_with_face_place_and_motion(plane_passes):
    bad = task(plane_passes, tolerance=Tolerance(gouge=0.002))
    at = int(np.argmin(np.linalg.norm(bad.tips[:, :2] - [-8, 2.0], axis=1) + 9 * (bad.kind == 3)))
    bad.tips[at, 2] -= 0.005
    assert judge(replace(bad, tolerance=Tolerance()), spacing=0.3).passed, "0.01 mm unless given"
    found = judge(bad, spacing=0.3)
    assert not found.passed
    assert found.gouge_max == pytest.approx(0.005, abs=1e-4)
    reason = next(r for r in found.reasons if r.startswith("gouge"))
    assert reason.startswith("gouge 0.005")
    assert "at face 7 (" in reason
    assert "allowed 0.002 mm" in reason
    assert f"point {at + 1}" in reason or f"point {at + 2}" in reason


def test_gouge_into_the_skin_counts(plane_passes):
    # The neighbour continues the floor beyond its border but rises by 0.02 mm: the run-out cuts it.
    skin = rectangle([8, -8, 0.02], [3, 0, 0], [0, 16, 0], 9)
    found = judge(task(plane_passes, skin=(skin,)), spacing=0.4)
    assert not found.passed
    assert found.gouge_max == pytest.approx(0.02, abs=1e-3)
    assert found.worst_gouge[0].face == "9"
    assert found.share_within == 1.0


def test_link_through_what_the_passes_leave_is_named(plane_passes):
    gap = task(plane_passes, targets=(WIDE,), left=(beyond(9.8),))
    assert judge(gap, spacing=0.5).link_cut is None
    home = gap.tips[-1:] + np.array([[0.0, 4.0, 0.0]])
    # The lowest point of the corner is 5 sin 10 deg + 1 - cos 10 deg below the tip: here 0.3 mm above the face.
    tip = 0.3 + 5 * np.sin(np.radians(10)) + 1 - np.cos(np.radians(10))
    low = np.array([[home[0, 0] - 4, 15.0, tip], [home[0, 0] - 12, 15.0, tip]])
    rapid = replace(gap, tips=np.vstack([gap.tips, home, low]), axes=np.vstack([gap.axes, gap.axes[:3]]),
                    kind=np.append(gap.kind, [3, 3, 3]).astype(np.int8))
    found = judge(rapid, spacing=0.5)
    assert not found.passed
    assert found.link_cut.face == "7"
    # Heights are followed up to 1 mm; rays 0.5 mm apart miss the lowest line of the swept corner by up to 0.25 mm.
    assert found.link_cut.value == pytest.approx(0.7, abs=5e-3)
    assert found.gouge_max < 1e-6
    assert any("link motion to point" in r and "into what the passes leave on face 7" in r for r in found.reasons)


@pytest.mark.parametrize("deep", [0.0, 0.1])
def test_back_of_a_thin_wall_is_not_taken_for_a_gouge(plane_passes, deep):
    back = rectangle([-8, -8, -0.4], [0, 16, 0], [16, 0, 0], 8)
    good = task(plane_passes, skin=(back,))
    good.tips[good.kind == 0, 2] -= deep
    found = judge(good, spacing=0.5)
    assert found.passed == (deep == 0.0)
    if deep:
        assert {place.face for place in found.worst_gouge} == {"7"}
        assert found.gouge_max == pytest.approx(0.1, abs=1e-3)


def test_holder_touch_and_cutter_too_near_are_named(plane_passes):
    good = task(plane_passes)
    wall = rectangle([-30, 18.0, 0], [60, 0, 0], [0, 0, 60], 3)
    nearest = good.tips[:, 1].max() + 12
    touch = rectangle([-30, nearest - 0.005, 0], [60, 0, 0], [0, 0, 60], 3)
    free = judge(replace(good, surroundings=(wall,)), spacing=0.8)
    assert isinstance(free.clearance["cutter"], Clearance)
    assert free.clearance["cutter"].distance == pytest.approx(18 - good.tips[:, 1].max() - 6, abs=1e-3)
    found = judge(replace(good, surroundings=(touch,)), spacing=0.8)
    assert not found.passed
    assert found.clearance["holder"].distance == pytest.approx(-0.005, abs=1e-3)
    assert any(r.startswith("holder is 0.005") and "inside face 3" in r and "needed 1.0 mm" in r for r in found.reasons)


def test_verdict_of_many_and_its_sentences(plane_passes):
    good, bad = task(plane_passes), replace(task(plane_passes, 1.2 * WIDTH), name="second")
    both = verify([good, bad], spacing=0.8)
    assert not both.passed
    assert verify([good], spacing=0.8).passed
    assert any(r.startswith("second: ") for r in both.reasons)
    assert not verify([]).passed


@pytest.mark.parametrize(("change", "message"), [
    ({"scallop": 0.0}, "scallop limit"), ({"targets": ()}, "machines no face"), ({"left": (WIDE,)}, "does not machine"),
    ({"allowance": np.nan}, "allowance")])
def test_bad_tasks_are_named(plane_passes, change, message):
    with pytest.raises(InvalidInput, match=message):
        task(plane_passes, **change)


def test_empty_and_broken_cutter_locations_are_named(plane_passes):
    good = task(plane_passes)
    empty = replace(good, tips=np.empty((0, 3)), axes=np.empty((0, 3)), kind=np.empty(0, dtype=np.int8))
    with pytest.raises(InvalidInput, match="holds no point"):
        verify([empty])
    good.tips[5, 1] = np.nan
    with pytest.raises(InvalidInput, match="tool tip row 5"):
        verify([good])


def test_stops_when_asked(plane_passes):
    with pytest.raises(Cancelled):
        verify([task(plane_passes)], progress=Progress(cancelled=lambda: True))
