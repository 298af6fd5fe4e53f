"""Points along passes: close enough for the chord tolerance, and not without end where the normal jumps."""

import numpy as np

from toolaxis.path.chord_tolerance import follow
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

UP = np.array([0.0, 0.0, 1.0])
#: Over the band, and to either side of it.
PASS = np.array([[0.5 - 2e-5, 0.5 + 3e-5, 0.5]])


def _with_rough_band() -> Face:
    """A plane 40 mm long with 1,000 ripples, 8e-7 mm long, in its middle."""
    band = 0.5 + 1e-8 * np.arange(-1000, 1001)
    knots = np.concatenate([[0.0] * 3, [0.25], band, [0.75], [1.0] * 3])
    middles = (knots[1:-2] + knots[2:-1]) / 2
    height = np.where(np.abs(middles - 0.5) < 9e-6, 1e-7 * (-1.0) ** np.arange(len(middles)), 0.0)
    rows = [np.column_stack([40 * middles, np.full(len(middles), y), height]) for y in (0.0, 20.0)]
    return Face.from_bspline(np.stack(rows, axis=1), (2, 1), (knots, np.array([0.0, 0.0, 1.0, 1.0])))


def test_no_more_points_than_help_where_the_normal_jumps_to_and_fro() -> None:
    face = _with_rough_band()
    across = face.normal(np.column_stack([0.5 + 1e-8 * np.linspace(-800, 800, 999), np.full(999, 0.5)]))
    assert np.ptp(across[:, 0]) > 0.5, "else the cutter's tip does not jump"
    _, along = follow(IsoChart(face, "u"), Cut(Tool.torus(12, 1), UP, 0.02), PASS, 1e-3)
    assert (along[0], along[-1]) == tuple(PASS[0, :2]) and (np.diff(along) > 0).all()
    assert np.diff(along).min() < 1e-6, "else the band is not found"
    assert len(along) < 1000


def test_bulges_between_far_places_are_followed() -> None:
    """Found: a bulge 1 mm long on a pass of 60 mm was cut off by straight motions, and its axis refused for a gouge."""
    x, y = np.meshgrid(np.linspace(0, 60, 241), [0.0, 5.0, 10.0, 15.0], indexing="ij")
    bulges = sum(np.exp(-(((x - middle) / 0.6) ** 2)) for middle in (11.3, 31.3, 51.3))
    face = Face.from_bspline(np.stack([x, y, 0.03 * bulges], axis=-1))
    chart, cut, chord = IsoChart(face, "u"), Cut(Tool.ball(6), UP, 0.02), 1e-3
    _, along = follow(chart, cut, np.array([[0.0, 1.0, 0.5]]), chord)
    dense = np.linspace(0, 1, 20_001)
    contact = face.evaluate(chart.uv(dense, np.full(len(dense), 0.5))).point
    nodes = face.evaluate(chart.uv(along, np.full(len(along), 0.5))).point
    lower = np.interp(contact[:, 0], nodes[:, 0], nodes[:, 2])
    assert np.abs(contact[:, 2] - lower).max() < 1.05 * chord
    assert len(along) < 200, "points lie close at the bulges alone"
