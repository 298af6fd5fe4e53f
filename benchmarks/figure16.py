"""Count and estimate against passes really made over the angle in a projection plane, as in [zhu2016] Fig. 16.

On each face 39 axes, evenly spaced over the gouge-free part of the face's own projection plane with every normal three
degrees or more from the axis; the feed direction is the better one of each axis.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from benchmarks._papers import GOUGE

import toolaxis as ta
from toolaxis.path.estimate import Estimator
from toolaxis.path.iso_parametric import layout
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_count import measure
from toolaxis.search.projection_planes import axis_at, initial_plane

ROOT = Path(__file__).resolve().parent.parent
AXES, NEAR_AXES, LEAST_DEG, SCALLOP = 39, 8, 3.0, 0.02
TOOL = ta.Tool.torus(12, 1)
FACES = ("freeform", "saddle", "trimmed", "hyperbolic_paraboloid", "biquintic", "seed 1", "seed 2", "small seed 1",
         "small seed 2")


def seeded(seed: int, length: float = 120.0, height: float = 7.0) -> ta.Face:
    """A gently curved patch of 6 x 5 control points, three quarters as wide as it is long, mm."""
    rng, share = np.random.default_rng(seed), length / 120
    x, y = np.meshgrid(np.linspace(0, 120, 6), np.linspace(0, 90, 5), indexing="ij")
    c, p = rng.uniform(-1, 1, 3), rng.uniform(0, 2 * np.pi, 2)
    z = height * (c[0] * np.sin(x / 38 + p[0]) + c[1] * np.cos(y / 30 + p[1]) + c[2] * x * y / 10800)
    return ta.Face.from_bspline(np.stack([share * x, share * y, z], axis=-1))


def face_named(name: str) -> ta.Face:
    """The sculptured face of an example part, or a seeded one: 120 x 90 mm, small ones 80 x 60 mm."""
    if name.startswith("small seed "):
        return seeded(int(name.split()[2]), 80.0, 5.0)
    if name.startswith("seed "):
        return seeded(int(name.split()[1]))
    return max(ta.load(ROOT / "examples" / f"{name}.step").sculptured, key=lambda f: f.area)


def free_axes(face: ta.Face, ready: Estimator) -> tuple[np.ndarray, np.ndarray]:
    """Gouge-free axes of the face's projection plane and the least angle of each to a normal, deg."""
    uv = np.concatenate([face.grid(24, 24), *face.outline])
    normal, curvature = face.normal(uv), face.curvature(uv)
    plane = initial_plane(normal, curvature.d2)
    axes = axis_at(plane, np.radians(np.arange(0.0, 180.01, 0.25)))
    cosine = axes @ normal.T
    seen = (cosine.min(axis=1) > np.sin(np.radians(5))) & np.isfinite(ready.many(axes, exact=False).passes).all(axis=1)
    axes, least = axes[seen], np.degrees(np.arccos(np.clip(cosine[seen].max(axis=1), -1, 1)))
    probe = np.concatenate([face.grid(9, 9), *(loop[:: max(1, len(loop) // 16)] for loop in face.outline)])
    free = np.array([ta.gouge(face, TOOL, probe, a).max() <= GOUGE for a in axes])
    return axes[free], least[free]


def spread(axes: np.ndarray, count: int) -> np.ndarray:
    """So many of the axes, evenly spaced among them."""
    return axes[np.round(np.linspace(0, len(axes) - 1, min(count, len(axes)))).astype(int)]


def clock(work: Callable[[], object]) -> tuple[float, object]:
    """Processor time of a call, s, and its result."""
    start = time.thread_time()
    result = work()
    return time.thread_time() - start, result


def compared(face: ta.Face, ready: Estimator, axes: np.ndarray) -> np.ndarray:
    """Rows of made, count, estimate, literal estimate, other feed's count and estimate, and the three times."""
    ready.many(axes[:1])
    seconds, found = clock(lambda: ready.many(axes))
    rows = []
    for axis, guess in zip(axes, found.passes, strict=True):
        both = [clock(lambda feed=feed: measure(IsoChart(face, feed), Cut(TOOL, axis, SCALLOP)).passes)  # noqa: B023
                for feed in "uv"]
        best = int(np.argmin([n for _, n in both]))
        feed = "uv"[best]
        took, made = clock(lambda: layout(face, TOOL, axis, SCALLOP, feed))  # noqa: B023
        rows.append([made.used, both[best][1], guess[best], ready.literal([axis], feed)[0], both[1 - best][1],
                     guess[1 - best], took, both[best][0], seconds / len(axes) / 2])
    return np.array(rows)


def worst(guess: np.ndarray, true: np.ndarray) -> str:
    """Greatest relative error, percent."""
    return f"{100 * np.abs(guess / true - 1).max():6.2f}" if len(true) else "     -"


def row(name: str, t: np.ndarray, n: np.ndarray) -> str:
    """A line of the table, from the axes that are far from all normals and those that are near."""
    made, made_s, guess_s = t[:, 0], t[:, 6].mean(), t[:, 8].mean()
    return (f"{name:22s} {len(t):4d}  {made.min():5.1f}-{made.max():6.1f}   {worst(t[:, 1], made)}    "
            f"{worst(t[:, 2], made)}   {worst(t[:, 3], made)} |     {worst(t[:, 5], t[:, 4])} |         {len(n):5d} "
            f"{worst(n[:, 1], n[:, 0])}    {worst(n[:, 2], n[:, 0])} | {made_s:7.3f}  {1e3 * t[:, 7].mean():8.2f}  "
            f"{1e3 * guess_s:11.3f}  {made_s / guess_s:5.0f}")


def short() -> None:
    """Print the table of three faces."""
    main(("freeform", "trimmed", "small seed 1"))


def main(faces: tuple[str, ...] = FACES) -> None:
    """Print the table."""
    chosen = sys.argv[1:] if Path(sys.argv[0]).name == Path(__file__).name else []
    print(f"{TOOL.name}, scallop {SCALLOP} mm; errors against passes made, less the unused share of the last, worst %")
    print(f"{'face':22s} axes  made passes    count  estimate  literal | other feed | < 3 deg: axes  count  estimate |"
          "  made s  count ms  estimate ms  ratio")
    every = []
    for name in chosen or faces:
        face = face_named(name)
        ready = Estimator.of(face, TOOL, SCALLOP)
        axes, least = free_axes(face, ready)
        far = spread(axes[least >= LEAST_DEG], AXES)
        if not len(far):
            print(f"{name:22s}    0  no gouge-free axis with every normal {LEAST_DEG} deg or more away")
            continue
        t = compared(face, ready, far)
        near = axes[(least < LEAST_DEG) & (least >= 0.5)]
        n = compared(face, ready, spread(near, NEAR_AXES)) if len(near) else np.empty((0, 9))
        every.append(t)
        print(row(name, t, n), flush=True)
    if every:
        t = np.concatenate(every)
        print(f"{'all':22s} {len(t):4d}                  {worst(t[:, 1], t[:, 0])}    {worst(t[:, 2], t[:, 0])}"
              f"   {worst(t[:, 3], t[:, 0])} |     {worst(t[:, 5], t[:, 4])} |"
              f"                                | ratio at least {(t[:, 6] / t[:, 8]).min():.0f}, "
              f"mean {t[:, 6].mean() / t[:, 8].mean():.0f}")


if __name__ == "__main__":
    main()
