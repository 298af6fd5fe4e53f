"""CAM jobs from operations: FreeCAD's own jobs with stock, tools and our passes, ready for its post-processors.

Where jobs have work planes there is one job with a shared plane for each orientation.  Else there is one job for each
orientation, its model turned into the frame of the plane, so that +Z is the tool axis there.
"""

from contextlib import contextmanager
from importlib.util import find_spec

import FreeCAD
from freecad.toolaxis.cam.job_setup import Passes, add_passes, bare_job, plane_comments, safe_height, tool_of
from freecad.toolaxis.cam.stock import check_one_setup, origin_comments
from freecad.toolaxis.cam.work_offsets import offsets_for, tell_shared
from freecad.toolaxis.document.blade_links import turned_copies
from freecad.toolaxis.document.children import child
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.placement import placement_from
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.document.stale_label import plain_label
from freecad.toolaxis.document.staleness import why_stale
from freecad.toolaxis.document.transaction import one_step
from freecad.toolaxis.services.arguments import document_of, operation_of, progress_of

translate = FreeCAD.Qt.translate

#: Angle below which two axes are one orientation, rad.
_ONE = 1e-7
_KEPT = ("PostProcessor", "PostProcessorArgs", "PostProcessorOutputFile")


def make_jobs(document, operations, progress=None):
    """Make CAM jobs of operations, as one undo step; jobs that were made of the same ones before are replaced.

    Each job has a work offset of its own as long as there are any; from then on jobs tell, in their properties and in
    their programs, that others have the same one.

    Parameters
    ----------
    document : App.Document
    operations : App.DocumentObject or sequence of them
        Those without an axis are left out.
    progress : toolaxis.progress.Progress, optional
        Asked after each job.

    Returns
    -------
    list of App.DocumentObject
        One job for each orientation, in the order in which they come up first; a single one where jobs have work
        planes.

    Raises
    ------
    InvalidInput
        When an operation is stale, or there is none with passes; the document is then as it was.
    Cancelled
        When `progress` says so; the document is then as it was.
    """
    from toolaxis.errors import InvalidInput

    document = document_of(document)
    several = operations if isinstance(operations, list | tuple) else [operations]
    operations = [operation_of(one) for one in several]
    document.recompute()
    ready = [one for operation in operations if operation.Motions or operation.Stale for one in _ready(operation)]
    if not ready:
        raise InvalidInput("there is no operation with passes: select faces and run Plan Orientations first")
    check_one_setup(ready)
    progress = progress_of(progress)
    with one_step(document, translate("ToolAxis", "Make CAM jobs")), _active(document):
        kept, offsets = _take_away(document, list({one.operation.Name: one.operation for one in ready}.values()))
        groups = _by_axis(ready)
        wanted = offsets_for(document, [offsets.get(group[0].label) for group in groups])
        jobs = _on_planes(document, groups, wanted[0]) if _has_planes() else None
        jobs = jobs or _jobs_of_orientations(document, groups, wanted, progress)
        for job, one in zip(jobs, groups, strict=False):
            for name, value in kept.get(one[0].label, {}).items():
                setattr(job, name, value)
        tell_shared(document)
        document.recompute()
        _check_computed(jobs)
    return jobs


def _check_computed(jobs):
    """Refuse jobs whose passes FreeCAD left uncomputed: they would be posted as programs without motions."""
    from toolaxis.errors import InvalidInput

    for job in jobs:
        for made in job.Operations.Group:
            if len(made.Path.Commands) < len(made.Gcode):
                raise InvalidInput(f"FreeCAD did not compute the passes of '{made.Label}': look for what is marked in "
                                   "the tree, mend or delete it, and make the jobs again")


def jobs_of(operation):
    """The CAM jobs that hold passes of an operation.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    return [job for job, _ in _jobs_from(operation.Document, [operation_of(operation)])]


def sources_of(job):
    """The operations that the passes of a CAM job are from, in the order of the job.

    Parameters
    ----------
    job : App.DocumentObject
        Any object.

    Returns
    -------
    list of (App.DocumentObject, str)
        Each with what its passes are called: the operation, or its turned copy on another blade.  Empty for what is no
        job with passes of ours.
    """
    group = getattr(getattr(job, "Operations", None), "Group", ())
    return [(made.OrientedFrom, made.MadeFor) for made in group if getattr(made, "OrientedFrom", None) is not None]


def count_jobs(operations):
    """How many jobs `make_jobs` makes: one for each orientation, or a single one where jobs have work planes.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
    """
    here = FreeCAD.Placement()
    passes = [(one, child(one, "Path::Feature")) for one in operations if one.Motions]
    stands = [turn.multiply(path.Placement) for one, path in passes if path is not None
              for turn in (here, *(link.Placement for link in turned_copies(one)))]
    axes = [stand.Rotation.multVec(FreeCAD.Vector(0, 0, 1)) for stand in stands]
    apart = [axis for k, axis in enumerate(axes) if all((axis - one).Length > _ONE for one in axes[:k])]
    return min(len(apart), 1) if _has_planes() else len(apart)


def _ready(operation):
    """An operation checked and read, and its turned copies on other blades."""
    from toolaxis.errors import InvalidInput

    reasons = why_stale(operation)
    if reasons:
        name = plain_label(operation)
        raise InvalidInput(f"'{name}' is out of date ({'; '.join(reasons)}): recompute it before making jobs")
    if operation.AxisMoves:
        raise InvalidInput(f"the axis of '{operation.Label}' moves while it cuts, and jobs have fixed planes: export a "
                           "program instead, or choose fixed axes")
    inputs, standing = inputs_of(operation), OperationRecord.of(operation)
    stands = [(standing, operation.Label), *((standing.turned(link.Placement, 0), link.Label)
                                             for link in turned_copies(operation))]
    return [Passes(operation, inputs, inputs.assembled(), one.path, one.matrix, inputs.job().rapid, label)
            for one, label in stands]


def _by_axis(ready):
    """Operations with one axis together, in the order in which the axes come up."""
    import numpy as np

    groups = []
    for one in ready:
        same = next((group for group in groups
                     if np.linalg.norm(np.cross(group[0].matrix[:3, 2], one.matrix[:3, 2])) < _ONE
                     and group[0].matrix[:3, 2] @ one.matrix[:3, 2] > 0), None)
        if same is None:
            groups.append([one])
        else:
            same.append(one)
    return groups


def _has_planes():
    """Whether jobs of this FreeCAD hold work planes."""
    import Path.Main.Job  # noqa: F401  its package

    return find_spec("Path.Main.Workplane") is not None


def _on_planes(document, groups, offset):
    """One job with a work plane for each orientation; None where this FreeCAD cannot hold our passes so."""
    import Path.Main.Workplane as Workplanes

    everything = [one for group in groups for one in group]
    frame = FreeCAD.Placement()
    if everything[0].inputs.origin:
        frame.Base = placement_from(everything[0].matrix).Base
    job, controllers = bare_job(document, everything, frame)
    job.Fixtures = offset
    planes = []
    try:
        for number, group in enumerate(groups, 1):
            label, plane = translate("ToolAxis", "Orientation {}").format(number), placement_from(group[0].matrix)
            stands = frame.inverse().multiply(plane)
            planes.append(Workplanes.createWorkplane(job, label=label, placement=stands))
            height = safe_height(job, everything, plane, frame)
            for one in group:
                comments = origin_comments(one, plane)
                made = add_passes(job, controllers[tool_of(one)], one, (plane, height), comments)
                if not hasattr(made, "Workplane"):
                    raise ValueError("operations with given passes have no work plane")
                made.Workplane = planes[-1]
    except ValueError as reason:  # the job's machine does not turn, or the operation takes no plane
        FreeCAD.Console.PrintLog(f"Tool Axis: {reason}\n")
        _remove_job(job)
        for name in [one.Name for one in planes]:
            if document.getObject(name) is not None:
                document.removeObject(name)
        return None
    return [job]


def _jobs_of_orientations(document, groups, offsets, progress):
    """A job for each orientation."""
    jobs = []
    for group, offset in zip(groups, offsets, strict=True):
        progress.report(translate("ToolAxis", "Making CAM jobs"), len(jobs), len(groups))
        jobs.append(_job(document, group, offset))
    return jobs


def _job(document, group, offset):
    """One job for operations with one axis, its model turned so that the axis is +Z."""
    plane = placement_from(group[0].matrix)
    job, controllers = bare_job(document, group, plane)
    job.Fixtures = offset
    comments = [*origin_comments(group[0], plane), *plane_comments(plane)]
    height = safe_height(job, group, plane, plane)
    for one in group:
        add_passes(job, controllers[tool_of(one)], one, (plane, height), comments)
    return job


def _jobs_from(document, operations):
    """Jobs and their operations that were made of some of ours."""
    names = {one.Name for one in operations}
    found = []
    for job in document.Objects:
        group = getattr(getattr(job, "Operations", None), "Group", ())
        found += [(job, made) for made in group
                  if getattr(made, "OrientedFrom", None) is not None and made.OrientedFrom.Name in names]
    return found


def _take_away(document, operations):
    """Remove what was made of some operations before; what is kept of their jobs, by what the passes are for.

    The work offsets are kept apart, only for what came first in a job: another axis must not take them too.
    """
    found = _jobs_from(document, operations)
    kept = {made.MadeFor: {name: getattr(job, name) for name in _KEPT} for job, made in found}
    offsets = {made.MadeFor: list(job.Fixtures) for job, made in reversed(found) if made == job.Operations.Group[0]}
    gone = {made.Name for _, made in found}
    for job in {job.Name: job for job, _ in found}.values():
        own = job.Operations.Group
        if all(made.Name in gone for made in own):
            _remove_job(job)
        else:
            for made in [made for made in own if made.Name in gone]:
                document.removeObject(made.Name)
    return kept, offsets


def _remove_job(job):
    """Remove a job with all that it holds, as FreeCAD does when a user deletes it, and copies that only it used."""
    document = job.Document
    bases = [base for model in job.Model.Group for base in getattr(model, "Objects", ())]
    copies = [base.Name for base in bases if base.TypeId == "Part::Feature" and base.Name.startswith("Copy")]
    job.Proxy.onDelete(job)
    document.removeObject(job.Name)
    for name in copies:
        if document.getObject(name) is not None and not document.getObject(name).InList:
            document.removeObject(name)


@contextmanager
def _active(document):
    """Make a document the active one meanwhile: FreeCAD's CAM makes its objects there."""
    before = FreeCAD.ActiveDocument
    FreeCAD.setActiveDocument(document.Name)
    try:
        yield
    finally:
        if before is not None and before.Name in FreeCAD.listDocuments():
            FreeCAD.setActiveDocument(before.Name)
