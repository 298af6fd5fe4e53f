"""Documents to and from the library's job: inputs, the computation apart from any document, and its results."""

from dataclasses import replace

from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.kinds import is_plan, plan_of
from freecad.toolaxis.document.machine_limits import limits_from
from freecad.toolaxis.document.preferences import threads
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.document.read_shapes import ShapesRead
from freecad.toolaxis.document.staleness import standing as what_stands
from freecad.toolaxis.document.staleness import why_stale
from freecad.toolaxis.document.strategies import asked_of, refuse_in_vain
from freecad.toolaxis.services.arguments import (
    check_faces_after,
    document_of,
    faces_of,
    fields_of,
    operation_of,
    progress_of,
)
from freecad.toolaxis.services.defaults import defaults
from freecad.toolaxis.services.earlier_plans import earlier_plans_task
from freecad.toolaxis.services.edit_sub_surfaces import merged
from freecad.toolaxis.services.edit_sub_surfaces import split as cut
from freecad.toolaxis.services.tools import tool_fields
from freecad.toolaxis.services.write_results import apply, keep_verdict


def task(inputs):
    """The computation for some inputs; shapes are read here and now, and nothing of the document is used later.

    Parameters
    ----------
    inputs : Inputs

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress` and returns a `toolaxis.plan.plan.Plan`; for any thread.

    Raises
    ------
    InvalidInput
        When nothing is selected, a face is not there (any more), or a value is out of range.
    """
    inputs.check_counts()
    inputs.check_tools()
    tools, job = inputs.tools(), inputs.job()
    source = ShapesRead.of(inputs)
    division = source.division(inputs)
    read_earlier = earlier_plans_task(inputs)

    def compute(progress):
        import toolaxis as ta

        part, bodies = source.read(progress)
        rates = {} if inputs.rack else {"feedrate": inputs.feedrate, "spindle": inputs.spindle}
        made = ta.plan(part, tools, inputs.scallop, machine=limits_from(inputs.limits, tools[0]),
                       faces=_faces_asked(inputs, source, part),
                       regions=inputs.regions, orientations=inputs.orientations, method=inputs.method,
                       compare=inputs.compare, division=division, objective=inputs.objective,
                       tolerance=job.tolerance, allowance=inputs.allowance, direction=inputs.direction,
                       passes=inputs.passes, obstacles=list(bodies) or None, datum=source.datum,
                       most_tools=inputs.most_tools, stock=job.stock, greatest_step_over=job.greatest_step_over,
                       allowance_on=dict(job.allowance_on), lead=job.lead, avoid=job.avoid, held=job.held,
                       origin=source.origin, stock_box=job.stock_box, after=read_earlier(progress),
                       progress=progress, **rates, **asked_of(inputs))
        refuse_in_vain(made)
        return made

    return compute


def _faces_asked(inputs, source, part):
    """The faces as the library takes them: nothing for a whole part, of which a rack machines blades or skins, and
    after an earlier setup, which has its own.
    """
    if inputs.after is not None:
        return None
    whole = source.complete(part)
    if inputs.rack and whole and not inputs.blades:
        return "skins"
    return None if inputs.blades and whole else source.numbers


def verification(operation):
    """The judgement of what stands in the document, as a computation apart from it.

    Parameters
    ----------
    operation : App.DocumentObject

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress` and returns a `toolaxis.verify.verdict.Verdict`; for any thread.

    Raises
    ------
    InvalidInput
        When there is nothing to verify.
    """
    from toolaxis.errors import InvalidInput

    inputs = inputs_of(operation)
    if not inputs.faces:
        raise InvalidInput(f"the part of '{operation.Label}' was deleted: select another face and plan it")
    standing, source, tool, count = OperationRecord.of(operation), ShapesRead.of(inputs), inputs.assembled(), threads()
    job = inputs.job()
    operation.Proxy.judging = what_stands(operation)

    def compute(progress):
        import toolaxis as ta

        part, bodies = source.prepared(job, progress)
        return ta.verify(standing.plan(part, bodies, tool, job), threads=count, progress=progress)

    return compute


def plan(document, faces, tool=None, scallop=None, *, progress=None, **given):
    """Plan faces of a document: compute, and put the operations into the tree, as one undo step.

    Parameters
    ----------
    document : App.Document
    faces : object, (object, "Face7"), (object, 7), "Block.Face7", or list of these
        An object alone stands for its sculptured faces.
    tool : str, toolaxis.Tool, or a CAM tool controller or tool bit, optional
    scallop : float or Quantity, optional
        mm
    progress : toolaxis.progress.Progress, optional
    **given
        Further fields of `JobInputs`, `rack`, `regions`, `orientations`, `method` and `strategy` among them; what is
        not given comes from the part.  With a `rack`, such as "general-rack", no `tool` is needed.  `after`, the plan
        of an earlier setup or one of its operations, has only what is left of its faces planned; `faces` is then the
        part.

    Returns
    -------
    list of App.DocumentObject
        The operations, one for each sub-surface.

    Raises
    ------
    ToolAxisError
        In one sentence; the document is then as it was.
    """
    document, progress = document_of(document), progress_of(progress)
    fields = fields_of(document, {"scallop": scallop, **given})
    fields = (tool_fields(tool) if tool is not None else {}) | fields
    chosen = faces_of(document, faces)
    if "after" in fields:
        check_faces_after(chosen, fields["after"])
    inputs = replace(defaults(document, chosen), **fields)
    return apply(document, inputs, task(inputs)(progress))


def recompute(operation, progress=None):
    """Plan an operation, or a whole plan, again with its own inputs, for the part as it is now, as one undo step.

    What is locked, and borders that were drawn by hand, are kept.

    Parameters
    ----------
    operation : App.DocumentObject
    progress : toolaxis.progress.Progress, optional

    Returns
    -------
    list of App.DocumentObject
        The operation itself first; more where its face now falls into several sub-surfaces; all of a whole plan.

    Raises
    ------
    ToolAxisError
        In one sentence; the document is then as it was.
    """
    from toolaxis.errors import InvalidInput

    operation = planned_with(operation_of(operation, whole=True))
    inputs = inputs_of(operation)
    if not inputs.faces:
        raise InvalidInput(f"the part of '{operation.Label}' was deleted: select another face and plan it")
    made = task(inputs)(progress_of(progress))
    return apply(operation.Document, inputs, made, operation)


def merge(operations, progress=None):
    """Put sub-surfaces of one face together and plan them again, as one undo step.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
        Two or more; what they make together has to hang together.
    progress : toolaxis.progress.Progress, optional

    Returns
    -------
    list of App.DocumentObject
        The operations of the plan.

    Raises
    ------
    ToolAxisError
        In one sentence; the document is then as it was.
    """
    owner, inputs = merged([operation_of(one) for one in operations])
    return apply(owner.Document, inputs, task(inputs)(progress_of(progress)), owner)


def split(operation, line=None, parameter="", at=None, progress=None):
    """Cut a sub-surface apart and plan its pieces, as one undo step.

    Parameters
    ----------
    operation : App.DocumentObject
    line : App.DocumentObject, optional
        A drawn line with edges; a closed one cuts a new sub-surface out of all of the face that it meets.
    parameter, at : str, float, optional
        Without a line: the parameter that is constant on the cut, and its value; else the middle of the longer one.
    progress : toolaxis.progress.Progress, optional

    Returns
    -------
    list of App.DocumentObject
        The operations of the plan.

    Raises
    ------
    ToolAxisError
        In one sentence; the document is then as it was.
    """
    owner, inputs = cut(operation_of(operation), line, parameter, at)
    return apply(owner.Document, inputs, task(inputs)(progress_of(progress)), owner)


def planned_with(operation):
    """What is planned again for an operation: itself, or its whole plan where blades or tools were planned together,
    or an earlier setup machines something of its face.

    Parameters
    ----------
    operation : App.DocumentObject
        An operation or a whole plan.
    """
    above = None if is_plan(operation) else plan_of(operation)
    together = above is not None and (above.BladesFound not in ("", "null") or bool(above.Rack) or
                                      above.After is not None)
    return above if together else operation


def verify(operation, progress=None):
    """Judge an operation as it stands in the document; the verdict and its maps are kept there.

    Parameters
    ----------
    operation : App.DocumentObject
    progress : toolaxis.progress.Progress, optional

    Returns
    -------
    toolaxis.verify.verdict.OperationVerdict

    Raises
    ------
    ToolAxisError
        In one sentence, where there is nothing to verify.
    """
    verdicts = verification(operation_of(operation))(progress_of(progress)).operations
    keep_verdict(operation, verdicts)
    return verdicts[0]


def is_stale(operation):
    """Whether the results of an operation do not hold any more; looks at the document as it is now.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    return bool(why_stale(operation_of(operation)))
