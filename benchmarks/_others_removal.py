"""Material removal by cutrail: stock is cut along the plan's path, and what is left is held against the part.

cutrail keeps the stock as a mesh and takes the swept cutter off it; benchmarks/cutrail is the little program around it,
built by cargo.  It also says where shank or holder enter what is left at that moment.  trimesh measures how far the
corners of the mesh that is left lie above or below the part, which is OpenCASCADE's mesh of the STEP file.  The stock
is the same mesh with all but its bottom raised, as roughing might leave it.
"""

import re
import shutil
import subprocess
import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks import _others as others
from benchmarks._others import Array, Check, PartMesh, Unavailable, path_of

import toolaxis as ta
from toolaxis.cldata.toolpath import ToolPath
from toolaxis.tools.tool import Tool
from toolaxis.verify.component_clearance import Clearance

SOURCE = Path(__file__).parent / "cutrail"
TARGET = Path(__file__).resolve().parents[1] / "out" / "cutrail"
#: Chord tolerance of the swept cutter, and how far the stock stands above the part along Z, mm.
CHORD, ABOVE = 0.002, 0.5
#: Corners so close to the part's sides are left out, mm: the part's nearest point is on an edge there, not below them.
BESIDE = 0.2
#: Faults of the holder are planted where it comes as near as this to the part, mm: cutrail sees collisions, not gaps.
NEAR = 1.5
#: A short tool, so that its holder comes close to the part.
TOOL = Tool.torus(diameter=12, corner_radius=2, flute_length=10, stickout=15, shank=[(6, 0), (6, 15)],
                  holder=[(20, 0), (20, 30)])


class Left(NamedTuple):
    """What cutrail leaves.

    gouge, excess : float, how far corners of the stock that is left lie below the part's surface and above it, mm.
    collisions : tuple of int, the motions on which shank or holder enter the stock.
    corners : int, of the mesh that is left.
    """

    gouge: float
    excess: float
    collisions: tuple[int, ...]
    corners: int


@cache
def built_cutrail() -> Path:
    """The program around cutrail, built by cargo.

    Raises
    ------
    Unavailable
        Where there is no cargo, or it does not build.
    """
    cargo = shutil.which("cargo")
    if not cargo:
        raise Unavailable("there is no cargo here to build cutrail with (rustup.rs)")
    made = subprocess.run([cargo, "build", "--release", "--quiet", "--jobs", "1", "--target-dir", str(TARGET)],
                          cwd=SOURCE, capture_output=True, text=True, check=False)
    if made.returncode:
        raise Unavailable(f"cutrail does not build: {made.stderr.strip()[-300:]}")
    return TARGET / "release" / "cut-along-poses"


def cut_stock(part: PartMesh, tool: Tool, path: ToolPath) -> Left:
    """What is left of the stock.

    Parameters
    ----------
    part : PartMesh
        A block with a flat bottom and upright sides.
    tool : Tool
        With one cylinder as shank and one as holder.
    path : ToolPath
    """
    import trimesh

    low, high = part.mesh.bounds
    raised = part.mesh.vertices + np.outer(part.mesh.vertices[:, 2] > low[2] + 1e-6, [0.0, 0.0, ABOVE])
    stock = [f"v {_row(row)}" for row in raised] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in part.mesh.faces]
    shank, holder = tool.outlines["shank"], tool.outlines["holder"]
    lines = [f"tolerance {CHORD}", f"cutter {2 * tool.radius} {tool.corner_radius} {tool.profile.top}",
             f"shank {2 * shank[0, 0]} {holder[0, 1] - shank[0, 1]}",
             f"holder {2 * holder[0, 0]} {np.ptp(holder[:, 1])}"]
    lines += [f"pose {_row(tip)} {_row(axis)}" for tip, axis in zip(path.cl, path.axis, strict=True)]
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / name for name in ("stock.obj", "poses.txt", "left.obj")]
        files[0].write_text("\n".join(stock))
        files[1].write_text("\n".join(lines))
        ran = subprocess.run([str(built_cutrail()), *map(str, files)], capture_output=True, text=True, check=True)
        corners = np.array([line.split()[1:4] for line in files[2].read_text().splitlines() if line.startswith("v ")],
                           dtype=float)
    inside = ((corners > low + BESIDE) & (corners < high - BESIDE))[:, :2].all(axis=1)
    deep = trimesh.proximity.signed_distance(part.mesh, corners[inside])
    hits = tuple(int(number) for number in re.findall(r"^collision (\d+)", ran.stdout, re.M))
    return Left(max(float(deep.max()), 0.0), max(float(-deep.min()), 0.0), hits, int(inside.sum()))


def _row(values: Array) -> str:
    return " ".join(f"{float(value):.9f}" for value in values)


def some_passes(path: ToolPath, first: int, last: int) -> ToolPath:
    """The passes from one number to another, the first one being 0.

    Parameters
    ----------
    path : ToolPath
    first, last : int
    """
    rows = slice(path.breaks[first], path.breaks[last + 1])
    return ToolPath(path.cc[rows], path.cl[rows], path.axis[rows], path.normal[rows], path.kind[rows],
                    path.breaks[first:last + 2] - path.breaks[first])


def compare_removal(example: str = "dish", tool: Tool = TOOL, strategy: str = "indexed") -> Check:
    """The row of the table.

    Parameters
    ----------
    example : str
    tool : Tool
    strategy : str
    """
    others.require("cadquery", "trimesh", "manifold3d", "rtree")
    built_cutrail()
    plan, part = others.small_plan(example, tool, strategy), others.mesh_of(example)
    path = path_of(plan)
    (ours,) = ta.verify(plan).operations
    theirs = cut_stock(part, tool, path)
    allowed = part.sag + 2 * CHORD + 0.001
    largest = max(abs(theirs.gouge - ours.gouge_max), abs(theirs.excess - ours.scallop_max))
    room = ours.clearance["holder"]
    assert isinstance(room, Clearance)
    found = planted_cuts(part, tool, path, theirs.gouge + allowed)
    if room.distance < NEAR:
        found |= planted_holders(part, tool, path, room.motion)
    title = "removal: gouge, rest, shank and holder" + ("" if strategy == "indexed" else "; axis moves")
    note = (f"removal on {example}, {strategy}: gouge {theirs.gouge:.4f} (judge {ours.gouge_max:.4f}), rest "
            f"{theirs.excess:.4f} ({ours.scallop_max:.4f}) mm at {theirs.corners} corners, {len(theirs.collisions)} "
            f"collisions; holder {room.distance:.3f} mm from the part")
    return Check("cutrail 0.1.1, trimesh", title, f"{len(path.cl)} poses",
                 f"{largest:.4f} mm", largest <= allowed and not theirs.collisions, f"{allowed:.4f} mm", found, (note,))


def planted_cuts(part: PartMesh, tool: Tool, path: ToolPath, most: float) -> dict[str, bool]:
    """Which planted faults of the path cutrail sees, each on three passes.

    Parameters
    ----------
    part : PartMesh
    tool : Tool
    path : ToolPath
    most : float
        A gouge that the sound path does not exceed, mm.
    """
    middle = path.passes // 2
    paths = {"pass 0.1 mm deeper": others.shift_pass(path), "axis turned by 0.2 deg": others.turn_axes(path)}
    return {name: cut_stock(part, tool, some_passes(spoilt, middle - 1, middle + 1)).gouge > most
            for name, spoilt in paths.items()}


def planted_holders(part: PartMesh, tool: Tool, path: ToolPath, motion: int) -> dict[str, bool]:
    """Which planted faults of the holder cutrail sees, on the pass where it comes closest.

    Parameters
    ----------
    part : PartMesh
    tool : Tool
    path : ToolPath
    motion : int
        On which that is.
    """
    near = int(np.searchsorted(path.breaks, motion, side="right")) - 1
    around = some_passes(path, near, near)
    tools = {"holder 2 mm longer": replace(tool, stickout=float(tool.stickout or 0.0) - 2.0),
             "holder 2 mm wider": replace(tool, holder=np.add(tool.holder, [2.0, 0.0]))}
    return {name: bool(cut_stock(part, other, around).collisions) for name, other in tools.items()}
