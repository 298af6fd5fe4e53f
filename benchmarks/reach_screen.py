"""Screening of reach beside its proof: pairs of posture and cell a second, and how often the screen is wrong.

Run it as ``python -m benchmarks reach_screen``, or with STEP files of your own behind it.
"""

import os
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks._rack import given

import toolaxis as ta
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.job.inputs.tool_file import load_tool
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.prices import widths
from toolaxis.regions.reach_screen import screen_reach, seen_cells
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
PARTS = (*(ROOT / "examples" / f"{name}.step" for name in ("freeform", "bosses", "blisk")),
         SHARED / "mousecover.step", SHARED / "ctc02.stp")
NAMES = ("ball:0.5", "ball:1", "ball:2", "ball:3", "ball:4", "ball:6", "ball:8", "ball:10", "ball:12", "torus:6x0.5",
         "torus:8x1", "torus:10x1", "torus:12x1", "torus:12x2", "torus:16x2", "flat:10")
#: Faces of a part and axes of a face that are screened; axes and cells of these that are held against the proof.
FACES, AXES = 6, 50
PROVEN_AXES, PROVEN_CELLS = 5, 25
SCALLOP = 0.01


class Timed(NamedTuple):
    """What was asked and how long it took, s; wrong answers by what the proof says (blocked, free), screen's last."""

    screened: int
    screen: float
    priced: float
    proven: int
    proof: float
    table: np.ndarray


def rack() -> list[Tool]:
    """Sixteen cutters with their holders."""
    tools = []
    with tempfile.TemporaryDirectory() as folder:
        for name in NAMES:
            path = Path(folder) / "tool.toml"
            path.write_text(given(name).file or "", encoding="utf-8")
            tools.append(load_tool(str(path)))
    return tools


def screen_face(face: Face, tools: Sequence[Tool], scene: ReachScene, rng: np.random.Generator) -> Timed:
    """Screen a face for all tools and some axes, and hold some of that against the proof's bounds."""
    cells = FaceCells.of(face, min(tool.radius for tool in tools))
    axes = rng.permutation(screening_axes([cells]))[:AXES]
    begun = time.process_time()
    free = screen_reach(cells, tools, axes, scene)
    screened = time.process_time()
    widths(cells, tools, axes, SCALLOP)
    priced = time.process_time()
    table, proof = np.zeros((2, 2), dtype=int), 0.0
    rows = rng.choice(len(cells), min(PROVEN_CELLS, len(cells)), replace=False)
    for number, tool in enumerate(tools):
        kept = scene.tolerance.for_cutter(tool.radius)
        judge = Feasibility(face, tool, group_surroundings(face, kept, part=scene.part), kept)
        seen = seen_cells(cells, tool, axes, scene.tolerance)
        for a in range(min(PROVEN_AXES, len(axes))):
            some = rows[seen[a, rows]]
            start = time.process_time()
            truth = judge.reach(cells.uv[some], axes[a], itself=True)
            proof += time.process_time() - start
            np.add.at(table, (truth.astype(int), free[number, a, some].astype(int)), 1)
    return Timed(free.size, screened - begun, priced - screened, int(table.sum()), proof, table)


def measure(path: Path, tools: Sequence[Tool]) -> None:
    """Print the line of a part."""
    part = ta.load(path)
    rng = np.random.default_rng(7)
    faces = rng.permutation(np.array(part.sculptured, dtype=object))[:FACES]
    begun = time.process_time()
    scene = ReachScene.of(part)
    made = time.process_time() - begun
    screen_face(faces[0], tools[:2], scene, rng)  # compiles, and makes what stays
    rows = [screen_face(face, tools, scene, rng) for face in faces]
    screened, screen, priced, proven, proof = (sum(column) for column in list(zip(*rows, strict=True))[:5])
    table = sum(row.table for row in rows)
    blocked, free = table.sum(axis=1)
    print(f"{path.name:16} {len(part.faces):4} faces, scene {made:5.1f} s | screen {screened / screen:9,.0f} pairs/s, "
          f"widths {screened / priced:10,.0f} | proof {proven / proof:7,.0f} pairs it sees/s | of {blocked} blocked "
          f"{table[0, 1]} said free ({100 * table[0, 1] / max(blocked, 1):.2f} %), of {free} free {table[1, 0]} said "
          f"blocked ({100 * table[1, 0] / max(free, 1):.2f} %)", flush=True)


def run_with(words: Sequence[str]) -> int:
    """Measure parts of your own."""
    tools = rack()
    for word in words:
        measure(Path(word), tools)
    return 0


def main() -> None:
    """Measure examples, and parts made by others where they are."""
    tools = rack()
    for path in PARTS:
        if path.is_file():
            measure(path, tools)
        else:
            print(f"{path.name}: not measured, it is not at {path.parent}")


def short() -> None:
    """The first example alone."""
    measure(PARTS[0], rack())
