"""A plan as a scene of meshes and lines: part, sub-surfaces, passes; coloured by sub-surface or by the judge's maps."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import trimesh
from matplotlib.colors import LinearSegmentedColormap, to_rgb
from numpy.typing import NDArray
from trimesh.path import Path3D
from trimesh.path.entities import Line
from trimesh.visual import ColorVisuals

from toolaxis.machine.work_coordinates import WorkCoordinates
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.map_colouring import colours_of
from toolaxis.report.figures.plots import BLUE, GREY, VERMILION, cutting_lines
from toolaxis.report.figures.tessellation import triangles
from toolaxis.report.html.charts import SCALE, SLACK
from toolaxis.shape.face import Face
from toolaxis.verify.axis_view import RestMaterialView

Array = NDArray[np.float64]

#: What sub-surfaces can be coloured by.
COLOURINGS = ("sub-surface", "scallop", "gouge")
#: Value where the cutter never came, or the judge has no ray, mm.
UNREACHED = -1.0
#: Share of the part's diagonal that triangles may be off their faces.
_COARSE = 1 / 4000
#: Triangles of a coloured map: sides of about a cell, but no more of them than this in all.
_MOST = 1_000_000
_PART = (0.86, 0.86, 0.86)


def plan_scene(plan: Plan, colour: str = "sub-surface",
               views: Mapping[str, RestMaterialView] | None = None) -> trimesh.Scene:
    """A plan as a trimesh scene in mm, in the part's frame.

    Parameters
    ----------
    plan : Plan
    colour : str
        One of `COLOURINGS`.
    views : mapping of str to View, optional
        The judge's maps by operation; what has none is grey in those colours.

    Returns
    -------
    trimesh.Scene
        "part": faces that no operation machines.  "op01-face3-surface": a sub-surface, of a map with the value at each
        vertex, mm, as the attribute "_SCALLOP" or "_GOUGE", `UNREACHED` where there is none.  "op01-face3": the passes
        as lines in work coordinates, placed at the work coordinate system.
    """
    made = trimesh.Scene(base_frame="plan")
    size = plan.part.diagonal
    machined = {number for op in plan.operations for number in op.face.numbers}
    rest = [_mesh(face, _COARSE * size) for face in plan.part.faces if not machined.intersection(face.numbers)]
    if rest:
        whole: Any = trimesh.util.concatenate(rest)
        _paint(whole, _PART)
        made.add_geometry(whole, node_name="part", geom_name="part")
    colours = colours_of(plan)
    judged = {name for name in views or {} if name in {op.name for op in plan.operations}}
    for op in plan.operations:
        mesh = _mesh(op.face, _COARSE * size)
        if colour == "sub-surface":
            _paint(mesh, colours[op.number])
        else:
            view = (views or {}).get(op.name)
            mesh = _colour_by_map(mesh, plan, op, view, (colour, _MOST // max(len(judged), 1)))
        name = f"{op.name}-surface"
        made.add_geometry(mesh, node_name=name, geom_name=name)
        if op.path is not None and op.frame is not None:
            made.add_geometry(_lines(cutting_lines(op.path), op.frame), node_name=op.name, geom_name=op.name,
                              transform=op.frame.part_from_work)
    return made


def _mesh(face: Face, bound: float) -> trimesh.Trimesh:
    found = triangles(face, bound)
    return trimesh.Trimesh(found.points, found.corners, vertex_normals=None, process=False)


def _paint(mesh: trimesh.Trimesh, colour: tuple[float, float, float]) -> None:
    rows = np.tile(np.round(255 * np.array([*colour, 1.0])).astype(np.uint8), (len(mesh.vertices), 1))
    mesh.visual = ColorVisuals(mesh, vertex_colors=rows)


def _lines(lines: list[Array], frame: WorkCoordinates) -> Path3D:
    ends = np.cumsum([0, *map(len, lines)])
    entities = [Line(np.arange(a, b), color=[round(255 * part) for part in (*to_rgb(BLUE), 1.0)])
                for a, b in pairwise(ends)]
    return Path3D(entities, frame.from_part(np.concatenate(lines)), process=False)


def _colour_by_map(mesh: trimesh.Trimesh, plan: Plan, op: Operation, view: RestMaterialView | None,
                   asked: tuple[str, int]) -> trimesh.Trimesh:
    """A sub-surface in triangles as fine as the map, coloured by it."""
    colour, most = asked
    if view is None or op.frame is None:
        values = np.full(len(mesh.vertices), UNREACHED)
    else:
        side = max(view.cell, float(np.sqrt(2 * op.face.area / most)))
        points, corners = trimesh.remesh.subdivide_to_size(mesh.vertices, mesh.faces, 2 * side, max_iter=20)
        mesh = trimesh.Trimesh(points, corners, process=False)
        mesh.merge_vertices()
        values = _values(mesh.vertices, op.frame, view, view.scallop if colour == "scallop" else view.gouge)
    limit = plan.inputs.scallop if colour == "scallop" else plan.inputs.tolerance.gouge
    mesh.visual = ColorVisuals(mesh, vertex_colors=_shades(values, limit))
    mesh.vertex_attributes[f"_{colour.upper()}"] = values.astype(np.float32)
    return mesh


def _values(points: Array, frame: WorkCoordinates, view: RestMaterialView, cells: NDArray[np.float32]) -> Array:
    """What a map has at points: the value of the cell, or of the nearest one beside that has one."""
    from scipy.spatial import cKDTree

    flat = frame.from_part(points)[:, :2]
    known = np.argwhere(~np.isnan(cells))
    if not len(known):
        return np.full(len(points), UNREACHED)
    middles = view.corner + view.cell * (known[:, ::-1] + 0.5)
    distance, near = cKDTree(middles).query(flat)
    found = cells[known[near, 0], known[near, 1]].astype(float)
    return np.where(np.isfinite(found) & (distance <= 3 * view.cell), found, UNREACHED)


def _shades(values: Array, limit: float) -> NDArray[np.uint8]:
    """The colours of the page's maps: a scale up to the limit, one colour above it, grey where there is no value."""
    scale = LinearSegmentedColormap.from_list("map", SCALE)
    rows = scale(np.clip(values / (SLACK * limit), 0.0, 1.0))
    rows[values > SLACK * limit] = (*to_rgb(VERMILION), 1.0)
    rows[values < 0] = (*to_rgb(GREY), 1.0)
    return np.round(255 * rows).astype(np.uint8)
