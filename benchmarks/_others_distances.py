"""Distances by mesh libraries: how deep the cutter goes into the part, and how far shank and holder stay from it.

The part is OpenCASCADE's mesh of the STEP file.  Cutter, shank and holder are meshes of revolution; between two points
of the path the tool sweeps the convex hull of both places, which is exact while the axis stands still; where it turns,
the motion is cut into steps of half a degree.  manifold3d intersects the swept cutter with the part and trimesh
measures how deep the corners of what they share lie below the part's surface; manifold3d measures the gap between swept
shank or holder and the part.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from benchmarks import _others as others
from benchmarks._others import SHIFT, Array, Check, PartMesh, path_of, shift_pass

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.plan.plan import Plan
from toolaxis.tools.profile import Profile
from toolaxis.tools.tool import Tool
from toolaxis.verify.component_clearance import Clearance, clearance
from toolaxis.verify.revolved_solids import frustum_solids

#: Chord tolerance of the meshes of cutter, shank and holder, mm.
CHORD = 0.001
#: Gaps are looked for so much farther than the judge's, mm.
FARTHER = 0.5
#: Turning motions are cut into steps of so much, rad.
STEP = np.radians(0.5)
#: What the judge's own figures may be off, mm; farther from the part it says itself how much more that is.
JUDGED = 0.001
#: The cutter of the boss; its holder comes close to the boss, which stands 28 mm above the face that is machined.
TOOL = Tool.torus(diameter=12, corner_radius=2, flute_length=18, stickout=34, shank=[(6, 0), (6, 34)],
                  holder=[(14, 0), (14, 30)])


class Measured(NamedTuple):
    """What the other libraries measure on a path: deepest gouge, mm, and the least gap of shank and holder, mm."""

    gouge: float
    gaps: dict[str, float]


def swept_bodies(outline: Array, path: ToolPath, motion: int) -> list[Any]:
    """The convex hulls of a body of revolution at both ends of each step of a motion, as solids of manifold3d.

    Parameters
    ----------
    outline : (k, 2) array
        (radius, height above the tip) of a convex body, mm.
    path : ToolPath
    motion : int
        The point that it arrives at.
    """
    import manifold3d

    count = others.ring_count(float(outline[:, 0].max()), CHORD)
    tips, axes = path.cl[motion - 1:motion + 1], path.axis[motion - 1:motion + 1]
    share = np.linspace(0, 1, 1 + max(1, int(np.ceil(np.linalg.norm(axes[1] - axes[0]) / STEP))))[:, None]
    places = tips[0] + share * (tips[1] - tips[0])
    turned = axes[0] + share * (axes[1] - axes[0])
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    rings = [others.rings_around(outline, *place, count) for place in zip(places, turned, strict=True)]
    return [manifold3d.Manifold.hull_points(np.concatenate(pair)) for pair in pairwise(rings)]


def depths(part: PartMesh, profile: Profile, path: ToolPath, motions: Sequence[int]) -> Array:
    """How deep the cutter goes below the part's surface on each motion, (n,) mm; 0 where it stays outside.

    Parameters
    ----------
    part : PartMesh
    profile : Profile
        Of the cutter.
    path : ToolPath
    motions : sequence of int
    """
    import trimesh

    outline = profile.polyline(CHORD)
    shared = [np.concatenate([(body ^ part.solid).to_mesh64().vert_properties[:, :3]
                              for body in swept_bodies(outline, path, k)]) for k in motions]
    corners = np.concatenate(shared)
    if len(corners) == 0:
        return np.zeros(len(motions))
    deep = trimesh.proximity.signed_distance(part.mesh, corners)
    ends = np.cumsum([len(rows) for rows in shared])[:-1]
    return np.array([rows.max(initial=0.0) for rows in np.split(deep, ends)])


def gap(part: PartMesh, outline: Array, path: ToolPath, motion: int, within: float) -> float:
    """The least distance of a shank or holder from the part on one motion, mm, no more than looked for.

    Parameters
    ----------
    part : PartMesh
    outline : (k, 2) array
    path : ToolPath
    motion : int
    within : float
        How far to look, mm.
    """
    bodies = [body for piece in others.pieces_of(outline) for body in swept_bodies(piece, path, motion)]
    return min(float(body.min_gap(part.solid, within)) for body in bodies)


def judged_gap(plan: Plan, name: str, motion: int) -> float:
    """What this project's judge says of one component on one motion, mm.

    Parameters
    ----------
    plan : Plan
    name : str
        "shank" or "holder".
    motion : int
    """
    path, ends = path_of(plan), slice(motion - 1, motion + 1)
    cl = (path.cl[ends], path.axis[ends], path.kind[ends])
    solids = frustum_solids(plan.operations[0].tool.outlines[name], name)
    return clearance(cl, (name, solids), plan.part.faces, enough=100.0).distance


def measure(part: PartMesh, tool: Tool, path: ToolPath, motions: Sequence[int], look: dict[str, tuple[int, float]],
            ) -> Measured:
    """The deepest gouge on motions, and the gaps of shank and holder on the motions that the judge names.

    Parameters
    ----------
    part : PartMesh
    tool : Tool
    path : ToolPath
    motions : sequence of int
    look : dict of str to (int, float)
        The motion and how far to look, mm, by component.
    """
    gaps = {name: gap(part, tool.outlines[name], path, *where) for name, where in look.items()}
    return Measured(float(depths(part, tool.profile, path, motions).max()), gaps)


def compare_distances(example: str = "boss", tool: Tool = TOOL, count: int = 150, strategy: str = "indexed") -> Check:
    """The row of the table.

    Parameters
    ----------
    example : str
    tool : Tool
    count : int
        Motions that are measured.
    strategy : str
    """
    others.require("cadquery", "trimesh", "manifold3d", "rtree")
    plan, part = others.small_plan(example, tool, strategy), others.mesh_of(example)
    path = path_of(plan)
    (ours,) = ta.verify(plan).operations
    rooms = {name: room for name, room in ours.clearance.items() if name != "cutter" and isinstance(room, Clearance)}
    look = {name: (room.motion, room.distance + FARTHER) for name, room in rooms.items()}
    worst = [place.motion for place in ours.worst_gouge[:1]]
    motions = others.sampled(path, count, *worst, *(motion for motion, _ in look.values()))
    theirs = measure(part, tool, path, motions, look)
    apart = {"gouge": theirs.gouge - ours.gouge_max}
    apart |= {name: theirs.gaps[name] - rooms[name].distance for name in look}
    pushed = deeper_pass(plan, part)
    apart["deeper pass"] = pushed - judge_shifted(plan)
    singly = single_differences(plan, part, motions[::6])
    largest = max([abs(value) for value in apart.values()] + singly)
    reach = float(np.linalg.norm(tool.outlines["holder"], axis=1).max())
    bow = reach * STEP**2 / 8 if np.ptp(path.axis, axis=0).max() > 1e-9 else 0.0
    allowed = part.sag + 2 * CHORD + bow + JUDGED
    agrees = max(singly, default=0.0) <= allowed and all(
        abs(value) <= allowed + (rooms[name].uncertainty if name in rooms else 0.0) for name, value in apart.items())
    title = "gouge; gaps of shank and holder" + ("" if bow == 0 else "; axis moves")
    said = f"gouge {theirs.gouge:.4f} (judge {ours.gouge_max:.4f}), " + ", ".join(
        f"{name} {theirs.gaps[name]:.4f} ({rooms[name].distance:.4f})" for name in look)
    said += f", with the deeper pass {pushed:.4f} ({pushed - apart['deeper pass']:.4f})"
    return Check("trimesh, manifold3d", title, f"{len(motions)} motions",
                 f"{largest:.4f} mm", agrees, f"{allowed:.4f} mm",
                 {f"pass {SHIFT:g} mm deeper": pushed > theirs.gouge + allowed,
                  **planted(plan, part, motions, look, (theirs, allowed))},
                 (f"distances on {example}, {strategy}: {said} mm; mesh of {len(part.mesh.faces)} triangles, up to "
                  f"{part.sag:.4f} mm from the exact faces",))


def single_differences(plan: Plan, part: PartMesh, motions: Sequence[int]) -> list[float]:
    """How far the judge and manifold3d differ in the holder's gap on single motions, mm.

    Parameters
    ----------
    plan : Plan
    part : PartMesh
    motions : sequence of int
    """
    path, outline = path_of(plan), plan.operations[0].tool.outlines["holder"]
    found = []
    for motion in motions:
        ours = judged_gap(plan, "holder", motion)
        if ours < 5.0:  # farther away the judge is content with a share of the distance
            found.append(abs(gap(part, outline, path, motion, ours + FARTHER) - ours))
    return found


def deeper_pass(plan: Plan, part: PartMesh) -> float:
    """The gouge where one pass is pushed into the part, mm.

    Parameters
    ----------
    plan : Plan
    part : PartMesh
    """
    path = path_of(plan)
    first, last = path.breaks[path.passes // 2:path.passes // 2 + 2]
    cuts = [k for k in range(first + 1, last) if path.kind[k] == Motion.CUT]
    return float(depths(part, plan.operations[0].tool.profile, shift_pass(path), cuts).max())


def planted(plan: Plan, part: PartMesh, motions: Sequence[int], look: dict[str, tuple[int, float]],
            sound: tuple[Measured, float]) -> dict[str, bool]:
    """Which other planted faults the libraries see: figures that leave those of the sound plan by more than allowed.

    Parameters
    ----------
    plan : Plan
    part : PartMesh
    motions : sequence of int
    look : dict of str to (int, float)
    sound : (Measured, float)
        Of the sound plan, and what is allowed, mm.
    """
    (theirs, allowed), path, tool = sound, path_of(plan), plan.operations[0].tool
    cutting = [k for k in motions if path.kind[k] == Motion.CUT]
    turned = depths(part, tool.profile, others.turn_axes(path), cutting).max()
    assert tool.holder is not None
    longer = replace(tool, stickout=float(tool.stickout or 0.0) - 0.5)
    wider = replace(tool, holder=np.add(tool.holder, [0.5, 0.0]))
    holders = {name: gap(part, other.outlines["holder"], path, *look["holder"])
               for name, other in (("holder 0.5 mm lower", longer), ("holder 0.5 mm wider", wider))}
    return {"axis turned by 0.2 deg": bool(turned > theirs.gouge + allowed),
            **{name: bool(value < theirs.gaps["holder"] - allowed) for name, value in holders.items()}}


def judge_shifted(plan: Plan) -> float:
    """The gouge that this project's judge finds on the plan with the shifted pass, mm.

    Parameters
    ----------
    plan : Plan
    """
    return ta.verify(others.with_path(plan, shift_pass(path_of(plan)))).operations[0].gouge_max
