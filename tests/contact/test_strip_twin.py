"""The compiled kernels against plain numpy, and Newton's exits against the march."""

import os
import subprocess
import sys

import numpy as np
import pytest
from width_numpy import CurveFamily, StripScene, distance_numpy, half_widths_numpy, place_tips

from toolaxis.contact.frame import axis_from_lean, contact_frame
from toolaxis.contact.strip import second_order
from toolaxis.contact.strip.half_widths import StripOptions
from toolaxis.contact.strip.second_order import second_order_many_axes
from toolaxis.contact.strip.width import (
    kernel_contacts,
    kernel_inputs,
    step_widths,
    strip_width,
    take_half_widths,
)
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
def test_the_oracle_gives_the_same_widths(name, feed):
    face = wavy(len(name), flip=name.startswith("torus"))
    tool, uv, axes = job(face, name, 3, feed)
    kinds = [(strip_width, True)] + ([(step_widths, False)] if isinstance(feed, str) else [])
    for function, sections in kinds:
        kernel = function(face, tool, uv, axes, 0.02, feed, 0.1)
        contacts, along = kernel_contacts(uv, feed, 0.02)
        inputs, options = kernel_inputs(face, tool, 0.02, 0.1), StripOptions(along, sections)
        twin, found = half_widths_numpy(*inputs, contacts, axes, options)
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
    cutter = second_order.cutter_parameters(tool, 0.02, 0.0)
    twin = np.empty((61, 21))
    second_order.screen_numpy(forms, axes, cutter, 0.02, twin)
    kernel = second_order_many_axes(face, tool, uv, axes, 0.02, "v")
    assert (kernel > 0).sum() > 100 and np.allclose(kernel, twin, rtol=1e-5 if name == "flat:9" else 1e-11, atol=1e-12)


SOURCE = """
import numpy as np
from toolaxis.contact.strip.width import step_widths, step_widths_many_axes, strip_width
from toolaxis.numeric import jit
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

rng = np.random.default_rng(4)
xy = np.stack(np.meshgrid(np.linspace(0, 90, 7), np.linspace(0, 90, 7), indexing="ij"), -1)
face, tool = Face.from_bspline(np.concatenate([xy, rng.normal(size=(7, 7, 1)) * 3], -1)), Tool.parse("torus:12x1")
uv = np.array([[1.3, 0.5], [0.3, 0.4], [0.5, 0.7]])
axes = face.normal(uv) + 0.3 * rng.normal(size=(3, 3))
widths = [strip_width(face, tool, uv, axes, 0.02), strip_width(face, tool, uv, axes, 0.02, (1.0, 0.4, 0.0)),
          step_widths(face, tool, uv, axes, 0.02), *step_widths_many_axes(face, tool, uv, axes[:2], 0.02)]
print(jit.available, *np.concatenate(widths).ravel().tolist())
"""


def test_without_numba_the_answers_are_the_same():
    answers = []
    for numba in "01":
        run = subprocess.run([sys.executable, "-c", SOURCE], env={**os.environ, "TOOLAXIS_NUMBA": numba},
                             capture_output=True, text=True, check=True)
        answers.append(run.stdout.split())
    assert [answer[0] for answer in answers] == ["False", "True"]
    plain, compiled = (np.array(answer[1:], dtype=float) for answer in answers)
    assert len(plain) == 30 and (plain > 0).all()
    assert np.abs(plain - compiled).max() < 1e-8


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
    contacts, along = kernel_contacts(uv, feed, 0.03)
    slow = take_half_widths(*kernel_inputs(face, tool, 0.03, 0.0), contacts, axes[None],
                            StripOptions(along, normal_section=False, newton=False))[0]
    wrong = (np.abs(fast - 100 * slow) > 1e-6).sum()
    assert fast.min() >= 0 and wrong <= 1  # the two look at windows of the pass that differ by a node


@pytest.mark.parametrize("name", [
    "torus:12x1", *(pytest.param(name, marks=pytest.mark.long) for name in ("flat:10", "tapered:6x1x5"))])
def test_the_march_sees_tips_jump_at_a_crease(name):
    """Two planes that meet at u = 0.5 under an angle, against thousands of positions of the cutter."""
    rng = np.random.default_rng(len(name))
    heights = np.array([0.0, 0.0, 40 * np.tan(0.03)])
    net = np.array([[[x, y, z] for y in (0.0, 60.0)] for x, z in zip((0.0, 40.0, 80.0), heights, strict=True)])
    face, tool = Face.from_bspline(net, (1, 1)), Tool.parse(name)
    uv = np.column_stack([rng.uniform(0.47, 0.53, 60), rng.uniform(0.4, 0.6, 60)])
    axes = face.normal(uv) + 0.25 * rng.normal(size=(60, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    (surface, cutter), (contacts, along) = kernel_inputs(face, tool, 0.02, 0.0), kernel_contacts(uv, "u", 0.02)
    found = take_half_widths(surface, cutter, contacts, axes[None],
                             StripOptions(along, normal_section=False, newton=False))[0]
    scene = StripScene(surface.data, False, cutter)
    for (u, v), axis, width in zip(uv, axes, found, strict=True):
        w = np.linspace(-2.5, 2.5, 20001) * tool.radius / 80 + u
        rows = CurveFamily(0, np.column_stack([w, np.full_like(w, v)]), np.zeros((len(w), 3)), np.zeros((len(w), 3)))
        tips = place_tips(scene, rows, np.zeros_like(w), np.broadcast_to(axis, (len(w), 3))).point
        for side, sign in enumerate((-1, 1)):
            s = v + sign * width[side] * np.array([0.5, 0.98, 1.02])
            points = face.evaluate(np.column_stack([np.full(3, u), s])).point + 0.02 * face.normal([[u, v]])
            gaps = [distance_numpy(cutter, axis, point - tips).min() for point in points]
            assert gaps[0] < 0 and gaps[1] < 0 < gaps[2]
