"""The compiled kernels against their plain numpy twins."""

import numpy as np
import pytest

from toolaxis.contact.frame import axis_from_lean, contact_frame
from toolaxis.contact.strip import half_widths as halves
from toolaxis.contact.strip import second_order
from toolaxis.contact.strip import width as strip
from toolaxis.contact.strip.second_order import second_order_many_axes
from toolaxis.contact.strip.width import step_widths, step_widths_many_axes, strip_width
from toolaxis.contact.strip.width_numpy import half_widths_numpy
from toolaxis.numeric import jit as compiled
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOLS = ["torus:12x1", "torus:8x3", "ball:10", "flat:9", "tapered:8x1x6"]


def wavy(seed, flip=False):
    rng = np.random.default_rng(seed)
    xy = np.stack(np.meshgrid(np.linspace(0, 90, 7), np.linspace(0, 90, 7), indexing="ij"), -1)
    net = np.concatenate([xy + rng.normal(size=xy.shape) * 3, rng.normal(size=(7, 7, 1)) * 3], -1)
    return Face.from_bspline(net, weights=rng.uniform(0.8, 1.25, (7, 7)), flip=flip)


def job(face, name, seed, feed, count=24):
    """Contacts with an axis each."""
    rng = np.random.default_rng(seed)
    uv = rng.uniform(0.25, 0.75, (count, 2))
    frame = contact_frame(face, uv, feed)
    return Tool.parse(name), uv, axis_from_lean(frame, rng.uniform(0.1, 0.9, count), rng.uniform(0, 6.3, count))


@pytest.mark.parametrize("name", TOOLS)
@pytest.mark.parametrize("feed", ["u", "v", (1.0, 0.4, 0.0)])
def test_the_twin_gives_the_same_widths(name, feed):
    face = wavy(len(name), flip=name.startswith("torus"))
    tool, uv, axes = job(face, name, 3, feed)
    kinds = [(strip_width, True)] + ([(step_widths, False)] if isinstance(feed, str) else [])
    for function, sections in kinds:
        kernel = function(face, tool, uv, axes, 0.02, feed, 0.1)
        geometry, sizes = strip._check_inputs(face, tool, 0.02, 0.1)
        twin, found = half_widths_numpy(geometry, strip.contact_rows(uv, feed, sections), axes, sizes)
        assert found.mean() > 0.8
        twin = twin[:, ::-1] if sections else twin
        assert np.abs(kernel - twin)[found].max() < 1e-8 * (1 if sections else 0.01)


@pytest.mark.parametrize("name", TOOLS)
def test_the_screen_twin_is_the_screen(name):
    face, tool = wavy(2), Tool.parse(name)
    rng = np.random.default_rng(5)
    axes = rng.normal(size=(60, 3))
    axes = np.concatenate([axes / np.linalg.norm(axes, axis=1)[:, None], face.normal([[0.5, 0.5]])])
    uv = np.concatenate([rng.uniform(0, 1, (20, 2)), [[0.5, 0.5]]])
    forms = second_order.contact_forms(face, uv, "v", True)
    cutter = second_order.cutter_numbers(tool, 0.02, 0.0)
    twin = np.empty((61, 21))
    second_order.screen_numpy(forms, axes, cutter, 0.02, twin)
    kernel = second_order_many_axes(face, tool, uv, axes, 0.02, "v")
    assert (kernel > 0).sum() > 100 and np.allclose(kernel, twin, rtol=1e-5 if name == "flat:9" else 1e-11, atol=1e-12)


def test_without_numba_the_answers_are_the_same(monkeypatch):
    face = wavy(9)
    tool, uv, axes = job(face, "torus:12x1", 4, "u", 6)
    uv[0] = [1.3, 0.5]  # beyond the border, too
    wanted = (strip_width(face, tool, uv, axes, 0.02), step_widths(face, tool, uv, axes, 0.02),
              step_widths_many_axes(face, tool, uv, axes[:2], 0.02))
    monkeypatch.setattr(compiled, "available", False)
    found = (strip_width(face, tool, uv, axes, 0.02), step_widths(face, tool, uv, axes, 0.02),
             step_widths_many_axes(face, tool, uv, axes[:2], 0.02))
    for one, two in zip(wanted, found, strict=True):
        assert np.abs(one - two).max() < 1e-8


def rippled(rng):
    """Waves of 15 mm and up to 2 mm high, on which cutters gouge."""
    xy = np.stack(np.meshgrid(np.linspace(0, 100, 14), np.linspace(0, 100, 14), indexing="ij"), -1)
    heights = rng.normal(size=(14, 14, 1)) * rng.uniform(0.2, 2)
    return Face.from_bspline(np.concatenate([xy + rng.normal(size=xy.shape), heights], -1), flip=bool(rng.integers(2)))


@pytest.mark.parametrize("name", ["torus:12x1", "flat:10", "torus:6x0.3", "ball:8", "tapered:6x1x5"])
@pytest.mark.parametrize("feed", ["u", "v"])
def test_newton_and_march_agree_on_rippled_surfaces(name, feed):
    """Newton's exits on tables against steps along the cross curve with the least distance over the whole pass."""
    rng = np.random.default_rng(len(name) + ord(feed))
    face, tool = rippled(rng), Tool.parse(name)
    uv = rng.uniform(0.25, 0.75, (400, 2))
    axes = face.normal(uv) + 0.3 * rng.normal(size=(400, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    fast = step_widths(face, tool, uv, axes, 0.03, feed) * 100
    geometry, sizes, contacts = strip._step_job(face, tool, uv, feed, (0.03, 0.0))
    contacts[:, 6] += halves.MARCH
    slow = np.empty((400, 2))
    halves.section_widths(geometry, contacts, axes, sizes, slow)
    wrong = (np.abs(fast - 100 * slow) > 1e-6).sum()
    assert fast.min() >= 0 and wrong <= 1  # the two look at windows of the pass that differ by a node
