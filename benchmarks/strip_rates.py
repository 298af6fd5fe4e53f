"""Rates of strip width: second-order screen, exact half widths, and the numpy twin, in one run and on one thread.

Run it as ``python benchmarks/strip_rates.py``; `rows` hands the same figures to other reports.
"""

import time
from collections.abc import Callable

import numpy as np

from toolaxis.contact.second_order import contact_forms, screen_numpy, second_order_many_axes
from toolaxis.contact.sizes import cutter_numbers
from toolaxis.contact.strip import _checked, contact_rows, step_widths, step_widths_many_axes, strip_width
from toolaxis.contact.strip_numpy import half_widths_numpy
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

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
        cutter, out = cutter_numbers(tool, SCALLOP, 0.0), np.empty((len(axes), len(few)))
        geometry, sizes = _checked(face, tool, SCALLOP, 0.0)
        contacts, same = contact_rows(few, "u", False), np.repeat(axis, len(few), axis=0)
        forms = contact_forms(face, few, "u", True)
        calls: list[tuple[str, int, Callable[[], object]]] = [
            ("second-order screen, 200 axes", 2 * out.size,
             lambda t=tool, p=few: second_order_many_axes(face, t, p, axes, SCALLOP)),
            ("  its numpy twin", 2 * out.size, lambda c=cutter, f=forms, o=out: screen_numpy(f, axes, c, SCALLOP, o)),
            ("exact, step parameter, 200 axes", 2 * out.size,
             lambda t=tool, p=few: step_widths_many_axes(face, t, p, axes, SCALLOP)),
            ("exact, step parameter, one axis", 2 * len(uv), lambda t=tool: step_widths(face, t, uv, axis, SCALLOP)),
            ("  its numpy twin", 2 * len(few),
             lambda g=geometry, c=contacts, a=same, s=sizes: half_widths_numpy(g, c, a, s)),
            ("exact, mm in the normal section", 2 * len(uv), lambda t=tool: strip_width(face, t, uv, axis, SCALLOP))]
        for work, count, call in calls:
            spent = seconds(call)
            found.append((work, name, count / spent, 1e6 * spent / count))
    return found


def main() -> None:
    """Print the table."""
    print(f"{'strip width, h = 0.02, one thread':36}{'tool':12}{'half widths/s':>15}{'us each':>10}")
    for work, name, rate, each in rows():
        print(f"{work:36}{name:12}{rate:15,.0f}{each:10.3f}")
    print("yardstick: one axis and contact by 64 section points and 3 Newton steps: numpy 7.9 us, numba 0.575 us")


if __name__ == "__main__":
    main()
