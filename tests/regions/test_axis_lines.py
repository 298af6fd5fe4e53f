"""What lines along tools' axes prove stands up to lines, places and tools that are drawn at random."""

import numpy as np
import pytest
from benchmarks.out_of_reach import Attack, Claim, draw_places, rack
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.numeric.vectors import unit
from toolaxis.regions.axis_cones import first_cones
from toolaxis.regions.axis_lines import _TURNED, AxisLine, AxisLines, _Cone, lines_of_rack
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.solid_grid import SolidGrid, pack_grid
from toolaxis.regions.solid_kernel import ConeLines, sweep_lines
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

HOLDER = [(12, 0), (16, 40)]
TOOLS = (Tool.ball(4, stickout=30, holder=HOLDER),
         Tool.torus(diameter=8, corner_radius=1.5, stickout=30, holder=HOLDER),
         Tool.tapered(4, 2, 4, stickout=30, holder=HOLDER))


def draw_grid(rng: np.random.Generator) -> tuple[Bools, Bools, SolidGrid]:
    """Blocks of material and places of faces in a grid, drawn at random."""
    material, held = np.zeros((40, 34, 30), dtype=bool), np.zeros((40, 34, 30), dtype=bool)
    for _ in range(rng.integers(1, 5)):
        low = rng.integers(3, 20, 3)
        high = low + rng.integers(2, 18, 3)
        material[low[0]:high[0], low[1]:high[1], low[2]:high[2]] = True
    low = rng.integers(5, 20, 3)
    held[low[0], low[1]:low[1] + 12, low[2]:low[2] + 9] = True
    return material, held, pack_grid(material, held, np.array([1.0, -2.0, 0.5]), 0.5)


def draw_lines(cone: _Cone, start: Array, off: float, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Beginnings near a place, in cells, and unit directions in a cone, (count, 3) each: every second at its border."""
    way = rng.uniform(-1, 1, (count, 2))
    way[::2] = np.sign(way[::2])
    slopes = np.array(cone.slope) + way * np.array(cone.spread)
    axis = np.empty((count, 3))
    axis[:, _TURNED[cone.main]] = cone.forth * np.column_stack([np.ones(count), slopes])
    aside = unit(rng.normal(size=(count, 3))) * rng.uniform(0.3, 1.0, (count, 1))
    aside[::3] /= np.linalg.norm(aside[::3], axis=1)[:, None]
    return start + off * aside, np.asarray(unit(axis))


def is_met(lines: tuple[Array, Array], length: float, thick: float, cells: tuple[Bools, Bools]) -> Bools:
    """Whether lines meet a cell of material, or, where they are thick, one near to a face: place by place, (n,)."""
    material, near = cells
    way = np.arange(0.0, length, 0.04)
    index = np.floor(lines[0][:, None] + way[None, :, None] * lines[1][:, None]).astype(int)
    inside = ((index >= 0) & (index < material.shape)).all(axis=2)
    index = np.clip(index, 0, np.array(material.shape) - 1)
    met = material[tuple(index.transpose(2, 0, 1))] | (near[tuple(index.transpose(2, 0, 1))] & (way >= thick))
    return np.asarray((met & inside).any(axis=1))


def test_no_line_gets_by_where_all_are_said_to_be_stopped() -> None:
    from scipy.ndimage import binary_dilation, generate_binary_structure

    rng, cones = np.random.default_rng(4), first_cones()
    told = passed = 0
    for _ in range(12):
        material, held, grid = draw_grid(rng)
        near = binary_dilation(held, generate_binary_structure(3, 2))
        for k in rng.integers(len(cones), size=30):
            (cone,) = _Cone.each_of(cones.pick(np.array([k])).halve().pick(np.array([rng.integers(4)])))
            start, off = rng.uniform(-2, 36, (40, 3)), rng.uniform(0.0, 1.5, 40)
            thick, length = float(rng.choice([4.0, np.inf])), float(rng.uniform(10, 60))
            stopped = np.zeros(40, dtype=bool)
            sweep_lines(grid.open[cone.main], grid.clear[cone.main],
                        ConeLines(cone.forth, cone.slope, cone.spread, thick, length), start[:, _TURNED[cone.main]],
                        off, stopped)
            for row in np.flatnonzero(stopped):
                lines = draw_lines(cone, start[row], off[row], 60, rng)
                assert is_met(lines, length, thick, (material, near)).all(), (k, start[row], off[row])
            told += int(stopped.sum())
            passed += int((~stopped).sum())
    assert told > 300 and passed > 300


def test_a_wall_stops_what_it_hides_and_nothing_else() -> None:
    material = np.zeros((60, 60, 20), dtype=bool)
    material[10:50, 10:50, 12:15] = True
    grid = pack_grid(material, np.zeros_like(material), np.zeros(3), 1.0)
    (cone,) = _Cone.each_of(first_cones().halve().halve().pick(np.flatnonzero(
        first_cones().halve().halve().middle[:, 2] > 0.998)[:1]))
    x, y = np.meshgrid(np.arange(2.5, 60), np.arange(2.5, 60), indexing="ij")
    start = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 4.5)])
    stopped = np.zeros(len(start), dtype=bool)
    sweep_lines(grid.open[2], grid.clear[2], ConeLines(cone.forth, cone.slope, cone.spread, np.inf, 40.0),
                start[:, _TURNED[2]], np.full(len(start), 0.5), stopped)
    hidden = ((start[:, :2] > 14) & (start[:, :2] < 46)).all(axis=1)
    beside = ((start[:, :2] < 9) | (start[:, :2] > 51)).any(axis=1)
    assert stopped[hidden].all() and not stopped[beside].any()


@pytest.mark.parametrize("tools", [TOOLS, rack(), (Tool.flat(8, stickout=30, holder=HOLDER), TOOLS[1])],
                         ids=["three", "general rack", "flat"])
def test_every_tool_holds_the_common_line_and_a_thick_one(tools: tuple[Tool, ...]) -> None:
    rng, enough = np.random.default_rng(8), 0.9
    ways = np.stack(np.meshgrid(*[np.linspace(-1, 1, 5) / np.sqrt(2)] * 2), axis=-1).reshape(-1, 2)
    lines = lines_of_rack(tools, np.array([[-0.01, 0.5, 1.0, 0.0]] * 2), enough)
    assert lines is not None
    for tool in tools:
        steepest = np.pi / 2 - tool.half_angle
        for angle in (0.0, steepest, *rng.uniform(0, steepest, 6)):
            aside = lines.common.off * np.column_stack([ways[:, 0], np.zeros(len(ways)), ways[:, 1]])
            begins = begin_at(tool, angle, lines.common) + aside
            assert any(holds(tool, begin, (0.0, lines.common.length), 0.1, rng) for begin in begins), tool.name
            assert any(holds(tool, begin_at(tool, angle, line), (line.thick, line.length), enough + 0.1, rng)
                       for line in lines.thick if line.thick < 60), tool.name


def begin_at(tool: Tool, angle: float, line: AxisLine) -> Array:
    """Where a line begins whose tool touches a face with a normal at an angle to its axis, (3,) in the tool's frame."""
    normal = np.array([-np.sin(angle), 0.0, np.cos(angle)])
    contact = np.array([tool.flat_radius, 0.0, tool.corner_radius]) - tool.corner_radius * normal
    return np.asarray(contact + line.above * normal - [line.aside, 0.0, 0.0])


def holds(tool: Tool, begin: Array, way: tuple[float, float], radius: float, rng: np.random.Generator) -> bool:
    """Whether balls around places of a line along the axis, from one way on it to another, lie in a tool."""
    places = begin + np.linspace(*way, 150)[:, None] * [0.0, 0.0, 1.0]
    around = places[:, None] + radius * unit(rng.normal(size=(len(places), 40, 3)))
    return bool(tool.distance(around.reshape(-1, 3)).value.max() <= 1e-6)


def test_lines_are_none_where_a_face_may_lie_deep_in_a_tool() -> None:
    assert lines_of_rack(TOOLS, np.array([[-0.2, 0.5, 1.0, 0.0]] * 2), 0.9) is None
    assert lines_of_rack((), np.array([[0.0, 0.5, 1.0, 0.0]] * 2), 0.9) is None


def scene_of(solid: object) -> ReachScene:
    """A part with what stands in the way on it, which takes a second to be made."""
    return ReachScene.of(ta.load(solid))


@pytest.fixture(scope="module")
def undercut() -> ReachScene:
    """A block with a T-slot, shut at both ends: 6 mm wide and 40 long at the top, 26 mm wide and 10 high below."""
    cq = pytest.importorskip("cadquery")
    wide = cq.Workplane().box(61, 26, 10).translate((0, 0, -5))
    narrow = cq.Workplane().box(40, 6, 20).translate((0, 0, 10))
    ends = [cq.Workplane().box(2, 40, 30).translate((side * 31, 0, 0)) for side in (-1, 1)]
    return scene_of(cq.Workplane().box(60, 40, 30).cut(wide).cut(narrow).union(ends[0]).union(ends[1]))


def places_of(face: Face) -> Array:
    """Places of a face, (n, 3); none of a narrow frame."""
    return np.asarray(face.evaluate(face.grid(9, 9)).point)


def look(scene: ReachScene, at: tuple[int, float], tools: tuple[Tool, ...] = TOOLS) -> tuple[Claim, float]:
    """What is proven of the largest face whose places have some coordinate, and the area of that face."""
    faces = [face for face in scene.part.faces
             if len(places_of(face)) and np.allclose(places_of(face)[:, at[0]], at[1])]
    face = max(faces, key=lambda one: one.area)
    found = AxisLines.look(face, tools, scene.required(face, steps_count=False), scene, 5000)
    area = float(sum(one.area.sum() for one in found.proven))
    return Claim(face, area, np.concatenate([one.rectangles for one in found.proven])), face.area


def test_the_grid_holds_no_place_outside_the_part_and_none_near_no_face(undercut: ReachScene) -> None:
    """Against a part that is told by hand."""
    grid = undercut.solid.grid
    assert grid is not None
    rng = np.random.default_rng(6)
    cells = rng.integers(0, grid.shape, (20_000, 3))
    places = grid.origin + (cells + rng.random((20_000, 3))) * grid.size
    boxes = np.array([[[-32, 32], [-20, 20], [-15, 15]], [[-30, 30], [-13, 13], [-10, 0]],
                      [[-20, 20], [-3, 3], [0, 20]]])
    away = np.maximum(boxes[:, None, :, 0] - places, places - boxes[:, None, :, 1])
    depth = np.linalg.norm(np.maximum(away, 0), axis=2) + np.minimum(away.max(axis=2), 0)
    inside = (depth[0] < 0) & (depth[1] > 0) & (depth[2] > 0)
    x, y, z = cells.T
    material = (grid.open[2][z, y // 64, x] >> (y % 64).astype(np.uint64)) & np.uint64(1) == 0
    closed = (grid.clear[2][z, y // 64, x] >> (y % 64).astype(np.uint64)) & np.uint64(1) == 0
    assert inside[material].all() and material.sum() > 0.8 * inside.sum()
    nearest = np.abs(depth).min(axis=0)
    assert nearest[closed & ~material].max() <= grid.away
    for words, turn in ((grid.open[0], (x, z, y)), (grid.open[1], (y, x, z))):
        assert (((words[turn[0], turn[1] // 64, turn[2]] >> (turn[1] % 64).astype(np.uint64)) & np.uint64(1) == 0)
                == material).all()


def test_what_an_undercut_hides_is_proven_and_the_rest_is_not(undercut: ReachScene) -> None:
    attack = Attack(undercut.part, TOOLS, axes=200)
    for at, least in (((2, 0.0), 0.6), ((1, -13.0), 0.6)):
        claim, whole = look(undercut, at)
        assert least * whole < claim.area <= whole * (1 + 1e-9), at
        rng = np.random.default_rng(5)
        for place in draw_places(claim, 6, rng):
            assert attack.reach(place).lack > 0, place.point
    floor, whole = look(undercut, (2, -10.0))
    assert 0.2 * whole < floor.area < 0.9 * whole
    v = np.vstack([one.point for one in draw_places(floor, 200, np.random.default_rng(7))])
    assert not ((np.abs(v[:, 1]) < 1.0) & (np.abs(v[:, 0]) < 15.0)).any(), "what lies under the slot is open"
    assert look(undercut, (2, 15.0))[0].area == 0.0


def test_a_wide_gap_in_the_roof_lets_lines_by() -> None:
    """The same room with an end open: the more of it is reached, the less is proven."""
    cq = pytest.importorskip("cadquery")
    room = cq.Workplane().box(50, 26, 10)
    closed = scene_of(cq.Workplane().box(60, 40, 20).cut(room).cut(cq.Workplane().box(3, 3, 12).translate((0, 0, 5))))
    opened = scene_of(cq.Workplane().box(60, 40, 20).cut(room).cut(cq.Workplane().box(30, 12, 12).translate((0, 0, 5))))
    areas = [look(scene, (2, -5.0))[0].area for scene in (closed, opened)]
    assert areas[0] > 0.85 * 50 * 26 and areas[1] < 0.75 * areas[0]


def test_a_seam_where_bodies_touch_is_no_gap_for_thick_tools() -> None:
    cq = pytest.importorskip("cadquery")
    tub = cq.Workplane().box(60, 40, 30).cut(cq.Workplane().box(50, 30, 25).translate((0, 0, 5)))
    lids = [cq.Workplane().box(30, 40, 5).translate((side * 15, 0, 17.5)) for side in (-1, 1)]
    scene = scene_of(cq.Workplane(cq.Compound.makeCompound([tub.val(), lids[0].val(), lids[1].val()])))
    floor, whole = look(scene, (2, -7.5))
    assert floor.area > 0.8 * whole, "nothing gets into it but along the seam of the lids"


def test_in_a_thin_shell_and_an_open_one_nothing_is_proven() -> None:
    cq = pytest.importorskip("cadquery")
    thin = scene_of(cq.Workplane().box(60, 60, 40).faces("<Z").shell(-0.1))
    assert look(thin, (2, 20.0))[0].area == 0.0
    whole = cq.Workplane().box(60, 60, 40)
    faces = whole.faces(">Z or <X or >X or <Y or >Y").vals()
    shell = scene_of(cq.Workplane(cq.Compound.makeCompound([cq.Shell.makeShell(faces)])))
    assert shell.solid.grid is None
    assert look(shell, (2, 20.0))[0].area == 0.0


def test_less_time_proves_no_more(undercut: ReachScene) -> None:
    scene = undercut
    face = next(one for one in scene.part.faces if np.allclose(one.evaluate(one.grid(3, 3)).point[:, 1], -13.0))
    required = scene.required(face, steps_count=False)
    areas = [sum(float(one.area.sum()) for one in AxisLines.look(face, TOOLS, required, scene, most).proven)
             for most in (0, 20, 5000)]
    assert areas[0] == areas[1] == 0.0 < areas[2]
