"""What the checks by other programs share: small plans, planted faults, meshes of parts, and the rows of the table."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.plan.plan import Plan
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
#: Scallop height of the plans, mm: coarse, so that planning and checking take seconds.
SCALLOP = 0.1
#: The planted faults: how far one pass is pushed into the part, mm, and by how much axes are turned, deg.
SHIFT, TURN = 0.1, 0.2


class Unavailable(Exception):
    """The other program is not there; the message says what is missing and how to get it."""


class Check(NamedTuple):
    """One row of the table.

    program, checks : str
    count : str, how many poses or orientations.
    difference : str, the largest one, with its unit.
    agrees : bool, whether it is within what the programs' own tolerances allow.
    allowed : str, those tolerances.
    found : dict of the planted faults to whether the other program found them.
    notes : tuple of str, sentences below the table.
    """

    program: str
    checks: str
    count: str
    difference: str
    agrees: bool
    allowed: str
    found: dict[str, bool]
    notes: tuple[str, ...] = ()


def require(*modules: str) -> None:
    """Raise `Unavailable` where one of the Python packages is missing.

    Parameters
    ----------
    *modules : str
        Names to import.
    """
    missing = [name for name in modules if find_spec(name) is None]
    if missing:
        raise Unavailable(f"{', '.join(missing)} not installed: pip install {' '.join(missing)}")


@cache
def small_plan(example: str, tool: Tool, strategy: str = "indexed") -> Plan:
    """The plan of one of the examples, made once in a process.

    Parameters
    ----------
    example : str
        Name of a STEP file in the folder of examples.
    tool : Tool
    strategy : str
    """
    return ta.plan(ta.load(EXAMPLES / f"{example}.step"), tool, SCALLOP, strategy=strategy, workers=1)


def path_of(plan: Plan) -> ToolPath:
    """The path of a plan's only operation.

    Parameters
    ----------
    plan : Plan
    """
    (operation,) = plan.operations
    assert operation.path is not None
    return operation.path


def with_path(plan: Plan, path: ToolPath) -> Plan:
    """The plan of one operation with another path.

    Parameters
    ----------
    plan : Plan
    path : ToolPath
    """
    return replace(plan, operations=(replace(plan.operations[0], path=path),))


def shift_pass(path: ToolPath, by: float = SHIFT) -> ToolPath:
    """The path with the cuts of its middle pass pushed down along the tool axis.

    Parameters
    ----------
    path : ToolPath
    by : float
        mm
    """
    middle = path.passes // 2
    rows = np.zeros(len(path.cl), dtype=bool)
    rows[path.breaks[middle]:path.breaks[middle + 1]] = True
    rows &= path.kind == Motion.CUT
    return replace(path, cl=path.cl - by * rows[:, None] * path.axis)


def turn_axes(path: ToolPath, degrees: float = TURN) -> ToolPath:
    """The path with every axis leaning so much more from the mean normal of the contacts; the tips stay.

    Parameters
    ----------
    path : ToolPath
    degrees : float
    """
    normal = path.normal[path.kind == Motion.CUT].mean(axis=0)
    aside = normal - (path.axis @ normal)[:, None] * path.axis
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    angle = np.radians(degrees)
    return replace(path, axis=np.cos(angle) * path.axis - np.sin(angle) * aside)


def rings_around(outline: Array, tip: Array, axis: Array, count: int) -> Array:
    """Points of a body of revolution: every point of its outline turned about the axis, (k * count, 3) mm.

    Parameters
    ----------
    outline : (k, 2) array
        (radius, height above the tip), mm.
    tip, axis : (3,) array
        mm, and a unit vector.
    count : int
        Points of a ring.
    """
    one = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    one /= np.linalg.norm(one)
    two = np.cross(axis, one)
    angles = 2 * np.pi * np.arange(count) / count
    out = np.cos(angles)[:, None] * one + np.sin(angles)[:, None] * two
    rings = outline[:, 0, None, None] * out + outline[:, 1, None, None] * axis
    return np.asarray(tip + rings.reshape(-1, 3))


def ring_count(radius: float, chord: float) -> int:
    """How many points a ring needs so that its chords stay within a distance of the circle.

    Parameters
    ----------
    radius, chord : float
        mm
    """
    return int(np.ceil(np.pi / np.arccos(1 - chord / radius)))


class PartMesh(NamedTuple):
    """The part as OpenCASCADE meshes it, closed.

    mesh : trimesh.Trimesh
    solid : manifold3d.Manifold
    sag : float, how far the middles of the largest triangles lie from the exact faces, mm.
    """

    mesh: Any
    solid: Any
    sag: float


@cache
def mesh_of(example: str, deflection: float = 5e-5) -> PartMesh:
    """Mesh of an example's STEP file, made without anything of this project.

    Parameters
    ----------
    example : str
    deflection : float
        What OpenCASCADE is asked for, mm; `PartMesh.sag` is what it comes to.
    """
    require("cadquery", "trimesh", "manifold3d", "rtree")
    import cadquery
    import manifold3d
    import trimesh

    shape = cadquery.importers.importStep(str(EXAMPLES / f"{example}.step")).val()
    corners, triangles = shape.tessellate(deflection, 0.1)
    mesh = trimesh.Trimesh([corner.toTuple() for corner in corners], triangles, process=False)
    mesh.merge_vertices(digits_vertex=7)
    assert mesh.is_watertight, f"the mesh of {example} is open"
    solid = manifold3d.Manifold(manifold3d.Mesh64(np.asarray(mesh.vertices, dtype=np.float64),
                                                  np.asarray(mesh.faces, dtype=np.uint64)))
    sag = max((_sag_of(face, deflection) for face in shape.Faces() if face.geomType() == "BSPLINE"), default=0.0)
    return PartMesh(mesh, solid, sag)


def _sag_of(face: Any, deflection: float, count: int = 300) -> float:
    """How far the middles of a face's largest triangles lie from the exact surface, mm, by OpenCASCADE."""
    from OCP.BRep import BRep_Tool
    from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf

    corners, triangles = face.tessellate(deflection, 0.1)
    rows = np.array([corner.toTuple() for corner in corners])[np.array(triangles)]
    size = np.linalg.norm(np.cross(rows[:, 1] - rows[:, 0], rows[:, 2] - rows[:, 0]), axis=1)
    middles = rows[np.argsort(-size)[:count]].mean(axis=1)
    surface = BRep_Tool.Surface_s(face.wrapped)
    return max(float(GeomAPI_ProjectPointOnSurf(_occ_point(point), surface).LowerDistance()) for point in middles)


def _occ_point(point: Array) -> Any:
    from OCP.gp import gp_Pnt

    return gp_Pnt(*map(float, point))


def pieces_of(outline: Array) -> list[Array]:
    """A shank or holder cut into convex frusta, each a (2, 2) array of (radius, height above the tip), mm.

    Parameters
    ----------
    outline : (k, 2) array
    """
    return [np.array(pair) for pair in pairwise(outline) if pair[1][1] > pair[0][1]]


def sampled(path: ToolPath, count: int, *named: int) -> Sequence[int]:
    """Some motions of a path, evenly spread, and those that are named; each by the point that it arrives at.

    Parameters
    ----------
    path : ToolPath
    count : int
        About how many.
    *named : int
    """
    every = np.linspace(1, len(path.cl) - 1, count).round().astype(int)
    return sorted({int(k) for k in every} | {k for k in named if k > 0})
