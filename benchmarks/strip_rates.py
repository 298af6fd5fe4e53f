"""Rates of strip width: second-order screen, exact half widths, the numpy twins, and the machine's own rates.

All in one run and on one thread; `rows` hands the first table to other reports.
"""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from benchmarks import _section
from benchmarks._count import operations
from benchmarks._peak import peaks

from toolaxis.contact.strip import second_order
from toolaxis.contact.strip.cutter_parameters import cutter_parameters
from toolaxis.contact.strip.half_widths import StripOptions, half_widths, new_workspace
from toolaxis.contact.strip.second_order import contact_forms, screen_numpy, second_order_many_axes
from toolaxis.contact.strip.width import (
    kernel_contacts,
    kernel_inputs,
    step_widths,
    step_widths_many_axes,
    strip_width,
)
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

SCALLOP = 0.02


def patch() -> Face:
    """A freeform patch of 80 mm x 80 mm, bicubic, with 3 x 3 spans."""
    rng = np.random.default_rng(1)
    xy = np.stack(np.meshgrid(np.linspace(0, 80, 6), np.linspace(0, 80, 6), indexing="ij"), -1)
    return Face.from_bspline(np.concatenate([xy, 3 * rng.normal(size=(6, 6, 1))], -1))


def cone(count: int, low: float, high: float) -> np.ndarray:
    """Axes between two angles from +z, rad."""
    rng = np.random.default_rng(2)
    lean, way = rng.uniform(low, high, count), rng.uniform(0, 2 * np.pi, count)
    return np.stack([np.sin(lean) * np.cos(way), np.sin(lean) * np.sin(way), np.cos(lean)], -1)


def seconds(call: Callable[[], object], repeats: int = 3) -> float:
    """Least processor time of some runs after one to warm up."""
    call()
    best = np.inf
    for _ in range(repeats):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
    return best


def rows() -> list[tuple[str, str, float, float]]:
    """Work, tool, half widths per second, and microseconds for one."""
    face, found = patch(), []
    uv, axes, axis = np.random.default_rng(3).uniform(0.1, 0.9, (5000, 2)), cone(200, 0.35, 0.7), cone(1, 0.35, 0.36)
    for name in ("torus:12x1", "ball:12", "flat:12"):
        tool = Tool.parse(name)
        few = uv[:100]
        cutter, out = cutter_parameters(tool, SCALLOP, 0.0), np.empty((len(axes), len(few)))
        forms = contact_forms(face, few, "u", True)
        calls: list[tuple[str, int, Callable[[], object]]] = [
            ("second-order screen, 200 axes", 2 * out.size,
             lambda t=tool, p=few: second_order_many_axes(face, t, p, axes, SCALLOP)),
            ("  its numpy twin", 2 * out.size, lambda c=cutter, f=forms, o=out: screen_numpy(f, axes, c, SCALLOP, o)),
            ("exact, step parameter, 200 axes", 2 * out.size,
             lambda t=tool, p=few: step_widths_many_axes(face, t, p, axes, SCALLOP)),
            ("exact, step parameter, one axis", 2 * len(uv), lambda t=tool: step_widths(face, t, uv, axis, SCALLOP)),
            ("exact, mm in the normal section", 2 * len(uv), lambda t=tool: strip_width(face, t, uv, axis, SCALLOP))]
        for work, count, call in calls:
            spent = seconds(call)
            found.append((work, name, count / spent, 1e6 * spent / count))
    return found


def jobs() -> dict[str, tuple[Callable[..., None], tuple[Any, ...], np.ndarray]]:
    """Kernels with what they take and where they write, 200 axes at 5 contacts; their operations are counted too."""
    face, tool, axes = patch(), Tool.parse("torus:12x1"), cone(200, 0.35, 0.7)
    uv, cutter = np.random.default_rng(3).uniform(0.1, 0.9, (5, 2)), cutter_parameters(tool, SCALLOP, 0.0)
    contacts, along = kernel_contacts(uv, "u", SCALLOP)
    points, nodes, _ = _section.sections(face, uv, cutter, SCALLOP)
    pairs = np.empty((len(axes), len(uv), 2))
    return {
        "screen": (second_order._screen, (contact_forms(face, uv, "u", True), axes, cutter, SCALLOP),
                   np.empty((len(axes), len(uv)))),
        "exact": (half_widths, (*kernel_inputs(face, tool, SCALLOP, 0.0), contacts, axes[:, None].copy(),
                                StripOptions(along, normal_section=False), new_workspace(len(axes))), pairs),
        "64 points": (_section.widths, (points, nodes, _section.frames(axes), (cutter, SCALLOP)), pairs.copy())}


def yardstick() -> None:
    """One axis and contact by 64 points of a section and three Newton steps, numpy beside numba."""
    kernel, arguments, out = jobs()["64 points"]
    twin, face = out.copy(), patch()
    fast = seconds(lambda: kernel(*arguments, out), 20) / (out.size // 2)
    slow = seconds(lambda: _section.widths_numpy(*arguments, twin)) / (out.size // 2)
    uv, tool = np.random.default_rng(3).uniform(0.1, 0.9, (5, 2)), Tool.parse("torus:12x1")
    pace = np.linalg.norm(face.evaluate(uv).sv, axis=1)[:, None]
    exact = step_widths_many_axes(face, tool, uv, cone(200, 0.35, 0.7), SCALLOP) * pace
    ours = seconds(lambda: step_widths_many_axes(face, tool, uv, cone(200, 0.35, 0.7), SCALLOP), 20) / (out.size // 2)
    print(f"\none axis and contact, 64 section points and 3 Newton steps: numpy {1e6 * slow:.2f} us, numba "
          f"{1e6 * fast:.3f} us, {slow / fast:.1f} times;\nthe yardstick is 7.9 and 0.575 us, the aim 10 times")
    print(f"it differs by {np.abs(out - twin).max():.0e} mm from numpy, and from the exact half widths by "
          f"{np.median(np.abs(out - exact)):.4f} mm in the middle, {np.abs(out - exact).max():.3f} at most;")
    print(f"both exact half widths of one axis and contact take {1e6 * ours:.2f} us")


def shares() -> None:
    """Operations of the kernels over the time they take, beside what the machine can do."""
    try:
        measured, found = peaks(), operations()
    except RuntimeError as reason:
        print(f"\nshare of the machine's own rates not measured: {reason}")
        return
    print("\nthe machine, one thread, billions/s by a C program")
    for name, (lanes, fma, roots, over) in measured.items():
        print(f"  {name}, {lanes} at a time: multiply-adds {fma / 2e9:.1f}, roots {roots / 1e9:.2f}, "
              f"divisions {over / 1e9:.2f}")
    print(f"{'operations of one half width':30}{'+ -':>8}{'*':>8}{'roots':>8}{'/':>8}{'us':>8}{'Gflop/s':>9}"
          f"{'% of peak':>10}{'% scalar':>10}{'% roots and /':>15}{'% scalar':>10}")
    for name, (kernel, arguments, out) in jobs().items():
        room = out.copy()
        kernel(*arguments, room)
        spent = seconds(lambda k=kernel, a=arguments, r=room: k(*a, r), 20) / out.size
        assert np.allclose(room.ravel(), found[name]["answer"], rtol=1e-6, atol=1e-9), name
        sums, products, roots, over = (count / out.size for count in found[name]["tally"])
        flops = (sums + products) / spent
        slow = [roots / rates[2] + over / rates[3] for rates in measured.values()]
        print(f"{name:30}{sums:8.0f}{products:8.0f}{roots:8.1f}{over:8.1f}{1e6 * spent:8.3f}{flops / 1e9:9.2f}"
              f"{100 * flops / measured['vector'][1]:10.1f}{100 * flops / measured['scalar'][1]:10.1f}"
              f"{100 * slow[0] / spent:15.1f}{100 * slow[1] / spent:10.1f}")
    print("counted while the kernels' source runs; '% roots and /' is the time that roots and divisions alone take at")
    print("the machine's rate.  The aim is 35 % of the peak of vector multiply-adds, or 90 % of roots and divisions")


def main() -> None:
    """Print the table."""
    print(f"{'strip width, h = 0.02, one thread':36}{'tool':12}{'half widths/s':>15}{'us each':>10}")
    for work, name, rate, each in rows():
        print(f"{work:36}{name:12}{rate:15,.0f}{each:10.3f}")
    yardstick()
    shares()


if __name__ == "__main__":
    main()
