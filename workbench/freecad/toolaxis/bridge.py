"""Documents to and from the library's job: inputs, the computation apart from any document, and its results."""

from dataclasses import dataclass, replace

from .arguments import document_of, faces_of, fields_of, operation_of, progress_of, tool_of
from .cam import tool_from as tool_from
from .defaults import defaults as defaults
from .results import apply as apply
from .results import keep_verdict as keep_verdict


@dataclass(frozen=True)
class Inputs:
    """What a job in a document is given; mm, and degrees inside the short forms.

    Attributes
    ----------
    faces : tuple of (object, "Face7")
        What is machined.
    tool : str
        Short form of the cutter.
    shank, holder : tuple of (radius, z)
        Outlines, the shank's from the tip and the holder's from its own lower face; empty where not known.
    stickout : float
        Length from the tip to the holder.
    scallop, allowance : float
    limits : str
        Limits of the axis in their short form, in the document's space; empty for none.
    obstacles : tuple of objects
        Bodies to avoid.
    objective, direction : str
    feedrate, spindle : float
        mm/min, rev/min
    """

    faces: tuple = ()
    tool: str = "torus:12x1"
    shank: tuple = ()
    holder: tuple = ()
    stickout: float = 60.0
    scallop: float = 0.02
    allowance: float = 0.0
    limits: str = ""
    obstacles: tuple = ()
    objective: str = "length"
    direction: str = "zigzag"
    feedrate: float = 1000.0
    spindle: float = 10000.0

    def __post_init__(self):
        for name in ("shank", "holder"):
            rows = tuple((float(radius), float(z)) for radius, z in getattr(self, name) or ())
            object.__setattr__(self, name, rows)
        for name in ("faces", "obstacles"):
            object.__setattr__(self, name, tuple(getattr(self, name) or ()))

    @property
    def things(self):
        """The objects whose faces are machined, each once."""
        return tuple({(thing.Document.Name, thing.Name): thing for thing, _ in self.faces}.values())

    def assembled(self):
        """The whole tool.

        Raises
        ------
        InvalidInput
            When the sizes make none.
        """
        from toolaxis.tools.assembly import Tool

        body = {name: [list(row) for row in getattr(self, name)] for name in ("shank", "holder") if getattr(self, name)}
        return Tool.parse(self.tool, stickout=self.stickout, **body)

    def job(self):
        """The same as the library knows it.

        Raises
        ------
        InvalidInput
            When a value is out of range.
        """
        from toolaxis.plan.plan import Inputs as JobInputs

        return JobInputs(self.scallop, self.allowance, objective=self.objective, direction=self.direction,
                         limits=self.limits, feedrate=self.feedrate, spindle=self.spindle)


def inputs_of(operation):
    """What an operation was planned with, or is to be planned with again.

    Parameters
    ----------
    operation : App.DocumentObject

    Returns
    -------
    Inputs
        Without faces where the part was deleted.
    """
    faces = tuple((thing, name) for thing, names in operation.Faces for name in names if name)
    rows = {name: tuple((point.x, point.z) for point in getattr(operation, name.capitalize()))
            for name in ("shank", "holder")}
    return Inputs(faces, operation.Tool, rows["shank"], rows["holder"], operation.StickOut.Value,
                  operation.Scallop.Value, operation.Allowance.Value, operation.Limits, tuple(operation.Obstacles),
                  operation.Objective, operation.Direction, round(60 * operation.FeedRate.Value, 9),
                  operation.SpindleSpeed)


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
    from .reading import Source

    tool = inputs.assembled()
    inputs.job().check_tool(tool)
    source = Source.of(inputs)

    def compute(progress):
        import toolaxis as ta

        part, bodies = source.read(progress)
        return ta.plan(part, tool, inputs.scallop, machine=inputs.limits or None, faces=source.numbers,
                       objective=inputs.objective, allowance=inputs.allowance, direction=inputs.direction,
                       obstacles=list(bodies) or None, feedrate=inputs.feedrate, spindle=inputs.spindle,
                       datum=source.datum, progress=progress)

    return compute


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
        When there is nothing to judge.
    """
    from toolaxis.errors import InvalidInput

    from .reading import Source
    from .staleness import standing as what_stands
    from .standing import Standing

    inputs = inputs_of(operation)
    if not inputs.faces:
        raise InvalidInput(f"the part of '{operation.Label}' was deleted: select another face and plan it")
    standing, source, tool = Standing.of(operation), Source.of(inputs), inputs.assembled()
    operation.Proxy.judging = what_stands(operation)

    def compute(progress):
        import toolaxis as ta

        part, bodies = source.read(progress)
        return ta.verify(standing.plan(part, bodies, tool, inputs.job()), progress=progress)

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
        Further fields of `Inputs`; what is not given comes from the part.

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
    inputs = replace(defaults(document, faces_of(document, faces)), **fields)
    return apply(document, inputs, task(inputs)(progress))


def tool_fields(tool):
    """The fields of `Inputs` that a tool fills.

    Parameters
    ----------
    tool : str, toolaxis.Tool, or a CAM tool controller or tool bit
    """
    if isinstance(tool_of(tool), str):
        from toolaxis.job.toolfile import load_tool

        tool = load_tool(tool)
    elif not hasattr(tool, "corner_radius"):
        tool = tool_from(tool)
    found = {"tool": tool.name}
    if tool.stickout is not None:
        found["stickout"] = tool.stickout
    for name in ("shank", "holder"):
        if getattr(tool, name) is not None:
            found[name] = tuple(map(tuple, getattr(tool, name).tolist()))
    return found


def recompute(operation, progress=None):
    """Plan an operation again with its own inputs, for the part as it is now, as one undo step.

    Parameters
    ----------
    operation : App.DocumentObject
    progress : toolaxis.progress.Progress, optional

    Returns
    -------
    list of App.DocumentObject
        The operation itself first; more where its face now falls into several sub-surfaces.

    Raises
    ------
    ToolAxisError
        In one sentence; the document is then as it was.
    """
    from toolaxis.errors import InvalidInput

    inputs = inputs_of(operation_of(operation))
    if not inputs.faces:
        raise InvalidInput(f"the part of '{operation.Label}' was deleted: select another face and plan it")
    made = task(inputs)(progress_of(progress))
    return apply(operation.Document, inputs, made, operation)


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
        In one sentence, where there is nothing to judge.
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
    from .staleness import why_stale

    return bool(why_stale(operation_of(operation)))
