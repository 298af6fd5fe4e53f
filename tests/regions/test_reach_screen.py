"""Screening of reach: against the proof's bounds at random postures, dense points, and cases known exactly."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.placement import tips
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.machine.limits import Cone
from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.partition.uv_grid import Lattice
from toolaxis.regions import reach_kernel, reach_screen
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.reach_kernel import ReachTips
from toolaxis.regions.reach_screen import ReachScreen, screen_reach, seen_cells
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.skin.find import find_skins
from toolaxis.skin.join import join
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import COMPONENTS, Tool

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
UP = np.array([0.0, 0.0, 1.0])
#: Share of wrong answers to either side, at most.
WRONG = 0.01


def some_of(part: Part, count: int) -> list[Face]:
    """Sculptured faces drawn at random."""
    faces = part.sculptured
    drawn = np.random.default_rng(5).choice(len(faces), min(count, len(faces)), replace=False)
    return [faces[k] for k in drawn]


def compare(part: Part, tools: list[Tool], faces: list[Face]) -> np.ndarray:
    """Counts of random postures by what the bounds say (row: blocked, free) and what the screen says (column)."""
    rng, count = np.random.default_rng(5), np.zeros((2, 2), dtype=int)
    scene = ReachScene.of(part)
    for face in faces:
        cells = FaceCells.of(face, 1.0)
        axes = rng.permutation(screening_axes([cells]))[:8]
        drawn = rng.choice(len(cells), min(30, len(cells)), replace=False)
        free = screen_reach(cells, tools, axes, scene)
        for number, tool in enumerate(tools):
            kept = scene.tolerance.for_cutter(tool.radius)
            judge = Feasibility(face, tool, group_surroundings(face, kept, part=part), kept)
            seen = seen_cells(cells, tool, axes, scene.tolerance)
            assert not (free[number] & ~seen).any()
            for a, axis in enumerate(axes):
                rows = drawn[seen[a, drawn]]
                truth = judge.reach(cells.uv[rows], axis, itself=True)
                np.add.at(count, (truth.astype(int), free[number, a, rows].astype(int)), 1)
    return count


def check(count: np.ndarray, least: int) -> None:
    """Enough of both, and few wrong answers to either side."""
    blocked, free = count
    assert blocked.sum() >= least and free.sum() >= least, count
    assert blocked[1] <= WRONG * blocked.sum() and free[0] <= WRONG * free.sum(), count


def test_a_pocket_is_screened_as_the_bounds_say(scenes) -> None:
    part = scenes.pocket()
    check(compare(part, scenes.rack(), some_of(part, 3)), 400)


@pytest.mark.parametrize(("name", "faces"), [("freeform", 1), ("bosses", 2),
                                             pytest.param("blisk", 5, marks=pytest.mark.long)])
def test_an_example_is_screened_as_the_bounds_say(scenes, name: str, faces: int) -> None:
    pytest.importorskip("OCP")
    part = ta.load(EXAMPLES / f"{name}.step")
    check(compare(part, scenes.rack(), some_of(part, faces)), 150)


@pytest.mark.parametrize(("name", "member"), [("skin", 1), pytest.param("mousecover", 33, marks=pytest.mark.long)])
def test_a_skin_is_screened_as_the_bounds_say(scenes, request: pytest.FixtureRequest, name: str, member: int) -> None:
    """Of six patches whose parameters go together, and of faces that are seen in a plane."""
    pytest.importorskip("OCP")
    folder = EXAMPLES if name == "skin" else request.getfixturevalue("shared_parts")
    part = ta.load(folder / f"{name}.step")
    (numbers,) = (some for some in find_skins(part).joined if member in some)
    whole = join(part, numbers)
    skin = whole.face(numbers[0])
    assert len(skin.own_faces) > 1 or name == "skin"
    check(compare(whole, scenes.rack(), [skin]), 30)


@pytest.mark.parametrize(("name", "faces"), [("mousecover.step", 6),
                                             pytest.param("ctc02.stp", 6, marks=pytest.mark.long)])
def test_a_real_part_is_screened_as_the_bounds_say(scenes, shared_parts: Path, name: str, faces: int) -> None:
    pytest.importorskip("OCP")
    if not (shared_parts / name).is_file():
        pytest.skip(f"{name} is not among the parts made by others")
    part = ta.load(shared_parts / name)
    check(compare(part, scenes.rack(), some_of(part, faces)), 400)


def floor_and(*others: Face) -> tuple[Part, FaceCells]:
    """A plane of 40 x 40 mm with other faces, and its cells."""
    x, y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 40, 4), indexing="ij")
    part = Part.from_faces([Face.from_bspline(np.stack([x, y, 0 * x], axis=-1)), *others])
    return part, FaceCells.of(part.faces[0], 1.0)


@pytest.mark.parametrize("tool", [Tool.ball(6), Tool.torus(10, 1), Tool.flat(8)])
def test_an_upright_tool_keeps_its_distance_from_a_wall(scenes, tool: Tool) -> None:
    wall = scenes.plate([[30.0, 0, -5], [30, 40, -5], [30, 0, 30], [30, 40, 30]])
    part, cells = floor_and(wall)
    scene = ReachScene.of(part)
    lean = np.radians(1.0)
    axis = np.array([0.0, np.sin(lean), np.cos(lean)])
    free = screen_reach(cells, [tool], [axis], scene)[0, 0]
    tip = tips(cells.point, cells.normal, axis, tool)
    room = np.abs(30.0 - tip[:, 0]) - tool.radius
    beside = (tip[:, 1] > 0) & (tip[:, 1] < 38)  # the tool leans towards y, and the wall ends at 40
    assert (free == (room >= 0.1))[beside & (np.abs(room - 0.1) > 0.005)].all()
    assert 0.3 < free.mean() < 0.95


def test_a_tool_passes_through_a_hole_that_is_trimmed_out_of_a_plate() -> None:
    turn = np.linspace(0, 2 * np.pi, 61)[:-1]
    hole = 0.5 + 0.15 * np.stack([np.cos(-turn), np.sin(-turn)], axis=1)  # 6 mm of 40
    lid = Face.from_bspline(np.array([[[0.0, 0, 15], [0, 40, 15]], [[40, 0, 15], [40, 40, 15]]]), (1, 1),
                            trims=(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), hole))
    part, cells = floor_and(lid)
    tool = Tool.ball(4)
    free = screen_reach(cells, [tool], [UP], ReachScene.of(part))[0, 0]
    inside = 6.0 - np.hypot(*(cells.point[:, :2] - 20.0).T) - tool.radius
    assert (free == (inside >= 0.1))[np.abs(inside - 0.1) > 0.05].all()
    assert free.sum() > 10


def test_what_holds_the_tool_goes_on_upwards() -> None:
    far = Face.from_bspline(np.array([[[15.0, 15, 90], [15, 25, 90]], [[25, 15, 90], [25, 25, 90]]]), (1, 1))
    part, cells = floor_and(far)
    away = np.linalg.norm(np.maximum(np.abs(cells.point[:, :2] - 20) - 5, 0), axis=1) - 2.0
    for tool, least in ((Tool.ball(4), 0.1), (Tool.ball(4, stickout=20.0), 0.5)):
        free = screen_reach(cells, [tool], [UP], ReachScene.of(part))[0, 0]
        assert (free == (away >= least))[np.abs(away - least) > 0.01].all() and not free.all()
    held = Tool.ball(4, stickout=20.0, holder=[(1.0, 0.0), (3.0, 10.0)])
    free = screen_reach(cells, [held], [UP], ReachScene.of(part))[0, 0]
    assert (free == (away >= 2.0))[np.abs(away - 2.0) > 0.01].all()
    alone = ReachScene.of(Part.from_faces(part.faces[:1]))
    assert screen_reach(cells, [Tool.ball(4)], [UP], alone).all()
    assert np.array_equal(screen_reach(cells, [held], [UP], ReachScene.of(alone.part, far))[0, 0], free)


def test_dense_points_agree(scenes) -> None:
    """Nothing shared but the tool's distance: every component at points about 0.6 mm apart on all faces."""
    part, tools = scenes.pocket(), scenes.rack()[2:5]
    scene, face = ReachScene.of(part), part.faces[0]
    cells = FaceCells.of(face, 2.0)
    axes = unit(np.array([[0.1, 0.2, 1.0], [-0.5, 0.1, 1.0], [0.2, -0.9, 1.0]]))
    even = np.stack(np.meshgrid(*[np.linspace(0, 1, 81)] * 2), axis=-1).reshape(-1, 2)
    clouds = [one.evaluate(even[one.contains(even)]).point for one in part.faces]
    free = screen_reach(cells, tools, axes, scene)
    some = np.random.default_rng(1).choice(len(cells), 40, replace=False)
    count = np.zeros(2, dtype=int)
    for number, tool in enumerate(tools):
        for a, axis in enumerate(axes):
            x = unit(np.cross(axis, [1.0, 0, 0]))
            frame = np.stack([x, np.cross(axis, x), axis], axis=1)
            for n in some[seen_cells(cells, tool, axes, scene.tolerance)[a, some]]:
                tip = tips(cells.point[n:n + 1], cells.normal[n:n + 1], axis, tool)
                room = np.inf
                for k, cloud in enumerate(clouds):
                    local = (cloud - tip) @ frame
                    least = [-0.01 if k == 0 else 0.1, 0.5, 1.0]
                    room = min(room, *(float(tool.distance(local, name).value.min()) - least[c]
                                       for c, name in enumerate(COMPONENTS)))
                if free[number, a, n]:
                    assert room > -0.005
                else:  # between the points a face may come a little nearer
                    assert room < 0.05
                count[int(free[number, a, n])] += 1
    assert count.min() > 30


def test_moving_everything_changes_nothing(scenes) -> None:
    part, tools = scenes.pocket(), scenes.rack()[:5]
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation([1.0, 2.0, -0.5], 1.1), [30.0, -200.0, 12.0]
    moved = part.transformed(matrix)
    axes = screening_axes([FaceCells.of(part.faces[0], 1.0)])[::9]
    one = screen_reach(FaceCells.of(part.faces[0], 1.0), tools, axes, ReachScene.of(part))
    other = screen_reach(FaceCells.of(moved.faces[0], 1.0), tools, axes @ matrix[:3, :3].T, ReachScene.of(moved))
    assert one.shape == other.shape and 0.02 < one.mean() < 0.98
    assert (one != other).mean() < 1e-3


def test_limits_and_stock_count(scenes) -> None:
    part, tools = scenes.pocket(), scenes.rack()[:4]
    cells = FaceCells.of(part.faces[0], 1.0)
    axes = screening_axes([cells])
    usual = screen_reach(cells, tools, axes, ReachScene.of(part))
    cone = Cone(UP, np.radians(20))
    limited = screen_reach(cells, tools, axes, ReachScene.of(part, limits=cone))
    within = cone.allowed(axes)
    assert 0 < within.sum() < len(axes) and usual[:, ~within].any()
    assert not limited[:, ~within].any() and np.array_equal(limited[:, within], usual[:, within])
    assert len(screening_axes([cells], cone)) == within.sum()
    # With stock left on the floor a tool stands that much farther off, and reaches no less in the open.
    thick = screen_reach(cells, tools, axes, ReachScene.of(part, allowance=0.5))
    assert thick.any() and (thick != usual).any()


def test_a_smaller_tool_with_the_same_body_reaches_no_less(scenes) -> None:
    part = scenes.pocket()
    cells = FaceCells.of(part.faces[0], 1.0)
    body = {"flute_length": 8.0, "stickout": 40.0, "holder": [(9.0, 0.0), (9.0, 40.0)]}
    small, large = screen_reach(cells, [Tool.ball(4, **body), Tool.ball(8, **body)], [UP], ReachScene.of(part))[:, 0]
    assert not (large & ~small).any() and (small & ~large).any()


def test_a_holder_of_many_steps_is_the_holder_that_it_amounts_to(scenes) -> None:
    part = scenes.pocket()
    cells = FaceCells.of(part.faces[0], 1.0)
    axes = screening_axes([cells])[::7]
    steps = [(9.0, 0.5 * k) for k in range(81)]
    plain, fine = (Tool.ball(6, stickout=30.0, holder=line) for line in ([(9.0, 0.0), (9.0, 40.0)], steps))
    assert len(fine.pieces) > 64
    found = screen_reach(cells, [plain, fine], axes, ReachScene.of(part))
    assert (found[0] != found[1]).mean() < 1e-3 and 0.02 < found[0].mean() < 0.98


@pytest.mark.parametrize("number", range(8))
def test_all_normals_of_a_seen_cell_are_within_the_angles(scenes, number: int) -> None:
    tool, face = scenes.rack()[number], scenes.pocket().faces[0]
    cells = FaceCells.of(face, 4.0)
    axes = unit(np.random.default_rng(2).normal(size=(400, 3)))
    lead = np.radians(0.5)
    keep = Tolerance(min_lead=lead, least_lean=np.radians(10))
    seen = seen_cells(cells, tool, axes, keep)
    lines = Lattice(face, cells.shape).lines
    for n in np.random.default_rng(3).choice(len(cells), 20, replace=False):
        (i, j), share = cells.index[n], np.linspace(0, 1, 9)
        u = lines[0][i] + share * (lines[0][i + 1] - lines[0][i])
        v = lines[1][j] + share * (lines[1][j + 1] - lines[1][j])
        dense = face.normal(np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2))
        angle = angle_between(axes[seen[:, n]][:, None], dense[None])
        slack = 0.1 * cells.spread[n]  # between nine samples normals turn on a little
        assert angle.max() <= np.pi / 2 - tool.half_angle + slack
        assert angle.min() >= keep.least_angle(tool.flat_radius) - slack
    assert 0.3 < seen.mean() <= 0.5


def test_no_tools_and_no_axes_are_no_answers(scenes) -> None:
    part = scenes.pocket()
    cells, scene = FaceCells.of(part.faces[0], 4.0), ReachScene.of(part)
    assert screen_reach(cells, [], [UP], scene).shape == (0, 1, len(cells))
    assert screen_reach(cells, scenes.rack()[:2], np.empty((0, 3)), scene).shape == (2, 0, len(cells))


def test_a_screen_that_is_asked_again_answers_as_one_made_anew(scenes, monkeypatch) -> None:
    part, tools = scenes.pocket(), scenes.rack()
    cells, scene = FaceCells.of(part.faces[0], 2.0), ReachScene.of(part)
    axes = screening_axes([cells])[::7]
    fresh = screen_reach(cells, tools, axes, scene)
    looked, required = [], ReachScene.required
    monkeypatch.setattr(ReachScene, "required", lambda *some: looked.append(some) or required(*some))
    screen = ReachScreen(cells, scene)
    for number in (2, 0, 5, 2, 6):  # other corners before, between and behind
        assert np.array_equal(screen.screen([tools[number]], axes)[0], fresh[number])
    some = np.random.default_rng(4).permutation(len(cells))[::3]
    assert np.array_equal(screen.pick(some).screen(tools, axes), fresh[:, :, some])
    assert len(looked) == 1 and 0.02 < fresh.mean() < 0.98


def test_only_what_is_asked_for_is_answered_and_as_without_asking(scenes, monkeypatch) -> None:
    part, tools = scenes.pocket(), scenes.rack()[:5]
    cells, scene = FaceCells.of(part.faces[0], 2.0), ReachScene.of(part)
    axes = screening_axes([cells])[::7]
    whole = screen_reach(cells, tools, axes, scene)
    asked = np.random.default_rng(4).random(whole.shape) < 0.5
    looked, find = [], reach_kernel.find_blocked
    monkeypatch.setattr(reach_kernel, "find_blocked", lambda *some: looked.append(len(some[2].place)) or find(*some))
    found = ReachScreen(cells, scene).screen(tools, axes, asked)
    assert np.array_equal(found, whole & asked) and (whole & ~asked).any()
    half = sum(looked)
    looked.clear()
    screen_reach(cells, tools, axes, scene)
    assert half < 0.6 * sum(looked)


@pytest.mark.parametrize("size", [pytest.param(1.0, marks=pytest.mark.long), 2.5])
def test_the_promising_axes_of_a_tool_are_screened_whole_and_others_for_what_these_miss(scenes, size: float) -> None:
    part = scenes.pocket()
    cells, tools, scene = FaceCells.of(part.faces[0], size), scenes.rack(), ReachScene.of(part)
    axes = screening_axes([cells])
    among = np.random.default_rng(7).random((len(tools), len(axes), len(cells))) < 0.95
    whole = screen_reach(cells, tools, axes, scene) & among
    promising = ReachScreen(cells, scene).screen_promising(tools, axes, among)
    assert not (promising & ~whole).any()
    assert np.array_equal(promising.any(axis=1), whole.any(axis=1))
    assert promising.sum() < 0.8 * whole.sum()
    area, some = whole @ cells.area, promising @ cells.area
    for number in range(len(tools)):
        assert some[number].max() >= 0.99 * area[number].max()
        held = some[number] == area[number]  # these were screened whole
        assert held.any() and some[number, held].max() == some[number].max()


def test_few_cells_are_screened_whole(scenes) -> None:
    part = scenes.pocket()
    cells, tools, scene = FaceCells.of(part.faces[0], 1.0).pick(np.arange(9)), scenes.rack()[:3], ReachScene.of(part)
    axes = screening_axes([cells])
    among = np.ones((3, len(axes), len(cells)), dtype=bool)
    found = ReachScreen(cells, scene).screen_promising(tools, axes, among)
    assert np.array_equal(found, screen_reach(cells, tools, axes, scene))


def screen_without_balls(cells: FaceCells, tools: list[Tool], axes: np.ndarray, scene: ReachScene) -> np.ndarray:
    """What the screen says where no ball at a contact tells anything."""
    find = reach_kernel.find_blocked

    def find_without(tree, tool, known, room, blocked) -> None:
        find(tree, tool, ReachTips.of(known.place, known.axis), room, blocked)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reach_kernel, "find_blocked", find_without)
        return screen_reach(cells, tools, axes, scene)


def test_balls_that_fit_at_contacts_change_no_answer_in_a_pocket(scenes) -> None:
    part, tools = scenes.pocket(), scenes.rack()
    scene, face = ReachScene.of(part), some_of(part, 1)[0]
    cells = FaceCells.of(face, 1.5)
    axes = screening_axes([cells], None, np.radians(25))
    found = screen_reach(cells, tools, axes, scene)
    assert found.any() and (~found).any()
    assert np.count_nonzero(found != screen_without_balls(cells, tools, axes, scene)) <= 2e-3 * found.size


@pytest.mark.parametrize("height", [1.0, 2.0, 3.0, 4.5])
def test_balls_that_fit_at_contacts_hide_no_low_step_from_a_leaning_tool(scenes, height: float) -> None:
    # The wall keeps the balls small; the tools lean away from it, over a step that is lower than their middles.
    wall = scenes.plate([[5.0, 0, -5], [5, 40, -5], [5, 0, 30], [5, 40, 30]])
    step = scenes.plate([[32.0, 0, -5], [32, 40, -5], [32, 0, height], [32, 40, height]])
    part, cells = floor_and(wall, step)
    tools = [Tool.ball(4, stickout=30.0, flute_length=20.0, shank=[(2.5, 20.0), (2.5, 30.0)],
                       holder=[(4.0, 0.0), (6.0, 20.0)]),
             Tool.torus(6, 0.5, flute_length=12.0, stickout=25.0, holder=[(5.0, 0.0), (5.0, 20.0)])]
    lean = np.radians([50.0, 60.0, 65.0, 70.0, 75.0, 80.0])
    axes = np.stack([np.sin(lean), 0.05 * np.ones(6), np.cos(lean)], axis=1)
    found = screen_reach(cells, tools, axes, ReachScene.of(part))
    without = screen_without_balls(cells, tools, axes, ReachScene.of(part))
    assert found.any(axis=(1, 2)).all() and not found.all(axis=(1, 2)).any()
    assert np.count_nonzero(found != without) <= 1e-3 * found.size


def test_a_shank_keeps_more_than_the_cutter_from_the_floor_that_it_leans_over() -> None:
    part, cells = floor_and()
    tool = Tool.ball(4, flute_length=4.0, stickout=30.0, holder=[(3.0, 0.0), (3.0, 20.0)])
    for lean in np.radians([60.0, 70.0, 74.0, 80.0]):
        # The shank is a cylinder as wide as the cutter, whose lower end comes nearest.
        room = 2.0 + 2.0 * np.cos(lean) - 2.0 * np.sin(lean)
        axis = np.array([np.sin(lean), 0.0, np.cos(lean)])
        free = screen_reach(cells, [tool], [axis], ReachScene.of(part))[0, 0]
        inner = (cells.point[:, 0] < 30) & (np.abs(cells.point[:, 1] - 20) < 15)
        assert (free[inner] == (room >= 0.5)).all(), np.degrees(lean)


def test_the_largest_balls_beside_a_wall_are_those_that_keep_their_distance(scenes) -> None:
    part, cells = floor_and(scenes.plate([[30.0, 0, -5], [30, 40, -5], [30, 0, 30], [30, 40, 30]]))
    found = ReachScreen(cells, ReachScene.of(part)).largest_balls
    ladder = np.concatenate([[0.0], reach_screen._BALLS])
    room = np.abs(30.0 - cells.point[:, 0]) - 0.1
    sure = np.abs(room[:, None] - ladder).min(axis=1) > 0.01
    assert np.array_equal(found[sure], ladder[np.searchsorted(ladder, room[sure]) - 1])
    assert len(np.unique(found)) > 8
