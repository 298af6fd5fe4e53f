"""Plans for other programs: STEP for CAD, a scene of meshes for trimesh, and that as glTF."""

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from toolaxis.errors import InvalidInput, MissingBackend
from toolaxis.job.files.contacts_from_cl import with_contacts
from toolaxis.job.files.plan_folder import read_plan, sha256_of, stage_folder
from toolaxis.job.files.verdict_maps import read_views
from toolaxis.plan.plan import Plan

if TYPE_CHECKING:
    import trimesh

    from toolaxis.verify.axis_view import RestMaterialView
    from toolaxis.verify.verdict import Verdict

STEP, GLTF = (".step", ".stp"), (".glb",)
COLOURINGS = ("sub-surface", "scallop", "gouge")
#: glTF is in metres with y up.
_GLTF_FROM_PART = 1e-3 * np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1000]])


def export(plan: Plan | str | PathLike[str], file: str | PathLike[str], *, colour: str = "sub-surface",
           verdict: "Verdict | None" = None) -> Path:
    """Write a plan for other programs; the ending of the file's name says for which.

    A STEP file (.step, .stp) is an assembly: the part, every sub-surface as a coloured face, and the passes of every
    operation as curves in its work coordinates, under its name and placed at its work coordinate system.  A glTF file
    (.glb) has the same as meshes and lines, in metres with y up as glTF asks, its sub-surfaces coloured as wanted.

    Parameters
    ----------
    plan : Plan or path
        A plan, or a folder that `toolaxis plan` wrote.
    file : path
    colour : str
        "sub-surface", or a map of the judge: "scallop" or "gouge", glTF only.
    verdict : Verdict, optional
        What `toolaxis.verify` said of the plan, for its maps; those of a folder stand in it.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidInput
        When the ending or the colour is not known, there are no maps, or the file cannot be written.
    MissingBackend
        When no CAD kernel, or no trimesh, is installed.
    """
    target = Path(file)
    ending = target.suffix.lower()
    if ending not in STEP + GLTF:
        raise InvalidInput(f"the file {target} ends in {ending or 'nothing'!r}: use .step or .glb")
    if target.is_dir():
        raise InvalidInput(f"the file {target} is a folder: give a file name")
    if colour != COLOURINGS[0] and ending not in GLTF:
        raise InvalidInput(f"colour {colour!r} is for glTF only, a STEP file has a colour for each face: write .glb")
    name = "plan"
    if not isinstance(plan, Plan):
        folder = Path(plan)
        plan, name, views = with_contacts(read_plan(folder)), folder.resolve().name, read_views(folder)
    else:
        views = _views(plan, verdict)
    with stage_folder(target.absolute().parent) as stage:
        made = stage.folder / target.name
        if ending in STEP:
            _write_step(plan, made, name)
        else:
            made.write_bytes(_gltf(plan, colour, views, name))
        stage.publish()
    return target


def to_trimesh(plan: Plan, *, colour: str = "sub-surface", verdict: "Verdict | None" = None) -> "trimesh.Scene":
    """A plan as a trimesh scene in mm: part, sub-surfaces as coloured meshes, and passes as lines.

    Parameters
    ----------
    plan : Plan
    colour : str
        "sub-surface", or a map of the judge: "scallop" or "gouge".
    verdict : Verdict, optional
        What `toolaxis.verify` said of the plan, for its maps.

    Returns
    -------
    trimesh.Scene
        Its nodes are "part", "op01-face3-surface" (of a map with the value at each vertex, mm, as the vertex attribute
        "_SCALLOP" or "_GOUGE", -1 where the cutter never came), and "op01-face3": passes in work coordinates.

    Raises
    ------
    InvalidInput
        When the colour is not known, or needs a verdict.
    MissingBackend
        When trimesh is not installed.
    """
    return _scene(plan, colour, _views(plan, verdict))


def _views(plan: Plan, verdict: "Verdict | None") -> "dict[str, RestMaterialView]":
    from toolaxis.verify.axis_view import view_along

    frames = {op.name: op.frame for op in plan.operations if op.frame is not None}
    return {found.name: view_along(found.maps[:len(found.faces)], frame.x, frame.y, frame.origin)
            for found in (() if verdict is None else verdict.operations)
            if (frame := frames.get(found.name)) is not None}


def _scene(plan: Plan, colour: str, views: "dict[str, RestMaterialView]") -> Any:
    if colour not in COLOURINGS:
        raise InvalidInput(f"colour is {colour!r}: use {', '.join(COLOURINGS[:-1])} or {COLOURINGS[-1]}")
    if colour != COLOURINGS[0] and not views:
        raise InvalidInput(f"colour {colour!r} needs the maps of Verify: verify the plan first")
    try:
        from toolaxis.report.figures.mesh_scene import plan_scene
    except ImportError as reason:
        raise MissingBackend(f"meshes need {reason.name}: pip install 'toolaxis[mesh]'") from reason
    return plan_scene(plan, colour, views)


def _gltf(plan: Plan, colour: str, views: "dict[str, RestMaterialView]", name: str) -> bytes:
    scene = _scene(plan, colour, views)
    made = type(scene)(base_frame="world")
    made.graph.update(frame_from="world", frame_to=name, matrix=_GLTF_FROM_PART)
    for node in sorted(scene.graph.nodes_geometry):
        placed, geometry = scene.graph[node]
        made.add_geometry(scene.geometry[geometry], node_name=node, geom_name=geometry, parent_node_name=name,
                          transform=placed)
    found = made.export(file_type="glb")
    assert isinstance(found, bytes)
    return found


def _write_step(plan: Plan, path: Path, name: str) -> None:
    from toolaxis.report.figures.map_colouring import colours_of

    try:
        from toolaxis.cad.ocp.write_step import write_step
    except ImportError as reason:
        raise MissingBackend(f"STEP files need {reason.name}: pip install 'toolaxis[cadquery]'") from reason
    write_step(plan, path, colours_of(plan), name, _part_shape(plan))


def _part_shape(plan: Plan) -> Any:
    """The part as the kernel reads it, where its file is still the one that was planned with; else None."""
    from toolaxis.cad.step.precheck import read_text
    from toolaxis.cad.step.read import readable
    from toolaxis.cad.step.worker import read_shape

    part = plan.part.original or plan.part
    source = Path(part.source) if part.source and part.sha256 else None
    if source is None or not source.is_file() or sha256_of(source) != part.sha256:
        return None
    with readable(source, read_text(source, accept_lost_faces=True)) as file:
        return read_shape(str(file))[0]
