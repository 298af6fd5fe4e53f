"""The ball that encloses a piece of a tool: it holds the piece, and the bound of a curved cell holds for all points."""

import numpy as np
import pytest

from toolaxis.contact.clearance.ball_bound import ball_around, enclosing_gap, least_form
from toolaxis.contact.clearance.ball_bound_numpy import CurvedCells, enclosing_gap_numpy
from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, motions, segment_motions
from toolaxis.contact.placement import place
from toolaxis.numeric.vectors import unit
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.shape.face import Face
from toolaxis.tools.solid import nearest_piece_numpy, solid_pieces
from toolaxis.tools.tool import Tool

BODY = {"stickout": 60, "shank": [(5, 0), (5, 60)], "holder": [(10, 0), (10, 40), (25, 40), (25, 80)]}
TOOLS = [Tool.torus(12, 1), Tool.torus(20, 5), Tool.ball(8), Tool.flat(10), Tool.tapered(6, 1, 10),
         Tool.ball(10, **BODY)]
PIECES = np.vstack([solid_pieces(t.profile, t.outlines) for t in TOOLS])


def _outline(piece):
    """Points of the border of a piece in the meridian plane, (n, 2)."""
    f, r, cb, sb, low, top, rim, _ = piece
    turn = np.linspace(-np.pi / 2, -np.arctan2(sb, cb), 200)
    arc = np.stack([f + r * np.cos(turn), low + r + r * np.sin(turn)], axis=1)
    arc = arc[arc[:, 1] <= top + 1e-12]
    side = np.linspace(arc[-1], [rim, top], 200)
    return np.vstack([[[0, low]], arc, side])


@pytest.mark.parametrize("piece", PIECES, ids=lambda p: "-".join(f"{x:.3g}" for x in p))
def test_ball_holds_the_lower_part_and_the_plane_the_rest(piece):
    f, r, cb, sb, low, top = piece[:6]
    line, held = _outline(piece), 0
    for phi in np.linspace(0.03, 1.5, 40):
        rise, climb = np.sin(phi), -np.cos(phi)
        if cb * climb + sb * rise >= 0:
            continue
        radius, behind = ball_around(tuple(piece[:7]), rise, climb)
        p, n = np.array([f + r * rise, low + r + r * climb]), np.array([rise, climb])
        rim = np.vstack([line, line * [-1, 1]])
        within = rim[:, 1] <= low + min(top - low, 2 * (f + r)) + 1e-9
        above = ~within if within.any() else within
        assert ((rim[above] - p) @ n <= -behind + 1e-9).all()
        if np.isfinite(radius):
            held += 1
            # a circle about the axis is farthest from any centre in the meridian plane at one of its two ends
            assert (np.linalg.norm(rim[within] - (p - radius * n), axis=1) <= radius * (1 + 1e-9)).all()
            assert radius >= r + f / rise - 1e-9
    assert held > 10 or top == low


def test_least_form_is_below_every_value():
    rng = np.random.default_rng(1)
    tight = 0
    for _ in range(400):
        root, cross, turn = rng.normal(size=(2, 2)), rng.normal(size=3), rng.uniform(-1, 1, 2)
        if rng.random() < 0.4:
            turn = np.sign(turn)
        h = root @ root.T
        slopes = rng.normal(size=3) * rng.choice([0.1, 1.0])
        along = (cross[0], cross[1], cross[2]**2) if rng.random() < 0.7 else (0.0, 0.0, 0.0)
        slopes[2] *= along[2] > 0
        least = least_form((h[0, 0], h[0, 1], h[1, 1]), tuple(slopes), along, tuple(turn))
        side = np.linspace(-1, 1, 41)
        x, y, m = np.meshgrid(side - turn[0], side - turn[1], side, indexing="ij")
        value = (h[0, 0] * x * x + 2 * h[0, 1] * x * y + h[1, 1] * y * y + 2 * (slopes[0] * x + slopes[1] * y)
                 + 2 * m * (slopes[2] + along[0] * x + along[1] * y) + along[2] * m * m).min()
        assert least <= value + 1e-12
        tight += least > value - 0.02
    assert tight > 40
    assert least_form((1.0, 2.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0)) == -np.inf


def _cases(count, rng):
    """Cells that touch, nearly touch or cut a piece, in any position, standing and moving."""
    piece = PIECES[rng.integers(len(PIECES), size=count)]
    turn, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    axis = turn[:, :, 2]
    phi = rng.uniform(0.05, 1.4, count)
    n = np.sin(phi)[:, None] * turn[:, :, 0] - np.cos(phi)[:, None] * axis
    f, r, low = piece[:, 0], piece[:, 1], piece[:, 4]
    contact = f[:, None] * turn[:, :, 0] + (low + r)[:, None] * axis + r[:, None] * n
    size = 10.0**rng.uniform(-1.5, 0.7, count)[:, None]
    e1 = unit(np.cross(n, rng.normal(size=(count, 3))))
    e2 = np.cross(n, e1)
    skew = rng.uniform(-0.5, 0.5, (count, 2, 1))
    a, b = size * (e1 + skew[:, 0] * e2), size * rng.uniform(0.2, 1, (count, 1)) * (e2 + skew[:, 1] * e1)
    curve = rng.uniform(-0.04, 0.08, (count, 3, 1)) * [[1], [0.5], [1]]
    second = curve * size[:, None]**2 * n[:, None] + 0.05 * size[:, None]**2 * rng.normal(size=(count, 3, 3))
    rest = 1e-4 * size[:, 0]
    at = rng.uniform(-1.2, 1.2, (count, 2, 1))
    gap = rng.choice([0.0, -0.002, 0.01, 0.3], count)[:, None]
    w = (contact + gap * n - at[:, 0] * a - at[:, 1] * b
         - (at[:, 0]**2 * second[:, 0] + 2 * at[:, 0] * at[:, 1] * second[:, 1] + at[:, 1]**2 * second[:, 2]) / 2)
    c = np.where(rng.random((count, 1)) < 0.5, 0.0, 1.0) * size * 0.3 * (e1 + 0.05 * rng.normal(size=(count, 3)))
    bend = np.column_stack([second.reshape(count, 9), rest])
    return CurvedCells(w, axis, np.stack([a, b, c], axis=1), bend, piece)


def _sampled(cells, k, rng):
    """Least phi over samples of one cell, what the second-order form leaves included as single displacements."""
    s, t = np.meshgrid(np.linspace(-1, 1, 41), np.linspace(-1, 1, 41))
    s, t = s.reshape(-1, 1), t.reshape(-1, 1)
    a, b, c = cells.span[k]
    suu, suv, svv, rest = *cells.bend[k, :9].reshape(3, 3), cells.bend[k, 9]
    x = cells.w[k] + s * a + t * b + (s * s * suu + 2 * s * t * suv + t * t * svv) / 2
    x = np.vstack([x + m * c for m in (-1, -0.4, 0, 0.6, 1)])
    x = x + rest * unit(rng.normal(size=x.shape))
    z = x @ cells.axis[k]
    rho = np.linalg.norm(x - z[:, None] * cells.axis[k], axis=1)
    return nearest_piece_numpy(cells.piece[k:k + 1], rho, z)[:, 0].min()


def _asked(cells, k):
    triple = [tuple(row) for row in (cells.w[k], cells.axis[k], *cells.span[k])]
    bend = (*(tuple(row) for row in cells.bend[k, :9].reshape(3, 3)), cells.bend[k, 9])
    return enclosing_gap(tuple(triple), tuple(cells.piece[k, :7]), bend)


def test_bounds_hold_for_every_sample():
    rng = np.random.default_rng(2)
    cells = _cases(3000, rng)
    near = 0
    for k in range(len(cells.w)):
        lower, _ = _asked(cells, k)
        seen = _sampled(cells, k, rng)
        assert lower <= seen + 1e-9
        near += lower > seen - 0.002
    assert near > 600


def test_upper_bound_is_a_place_of_the_cell():
    """With a dense sampling some sample comes as near as ``upper``, apart from the samples' own spacing."""
    rng = np.random.default_rng(4)
    cells = _cases(400, rng)
    for k in range(len(cells.w)):
        _, upper = _asked(cells, k)
        if np.isfinite(upper):
            reach = np.linalg.norm(cells.span[k, :2], axis=1).sum()
            assert _sampled(cells, k, rng) <= upper + 1e-9 + 0.06 * reach


def test_plain_twin_says_the_same():
    cells = _cases(2000, np.random.default_rng(3))
    lower, upper = enclosing_gap_numpy(cells)
    one = np.array([_asked(cells, k) for k in range(len(cells.w))])
    for mine, theirs in ((lower, one[:, 0]), (upper, one[:, 1])):
        assert (np.isfinite(mine) == np.isfinite(theirs)).mean() > 0.999
        both = np.isfinite(mine) & np.isfinite(theirs)
        assert mine[both] == pytest.approx(theirs[both], abs=1e-9)


@pytest.mark.parametrize("tool", TOOLS[:4], ids=lambda t: t.name)
def test_few_cells_decide(tool):
    """Next to a contact the plane of a cell tells little: without the ball a flat end's motions take some 770 cells."""
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.linspace(0, 100, 7), np.linspace(0, 100, 7), indexing="ij")
    face = Face.from_bspline(np.stack([x, y, 2 * rng.standard_normal(x.shape)], axis=-1))
    tree, axis = forest([face]), unit([0.3, -0.2, 1.0])
    uv = np.stack([np.linspace(0.1, 0.9, 240), np.full(240, 0.37)], axis=1)
    tips = place(face, tool, uv, axis)
    limit = np.array([[-0.002, -np.inf, -np.inf]])
    assert np.median(keeps_limits(tree, tool, motions(tips, axis), limit).looked) < 80
    assert np.median(keeps_limits(tree, tool, segment_motions(tips, axis), limit).looked) < 100
    assert np.median(lower_bounds(tree, tool, segment_motions(tips, axis), 0.0, 0.0003, limit).looked) < 140
