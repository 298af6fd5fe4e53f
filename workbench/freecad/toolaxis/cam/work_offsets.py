"""Work offsets of jobs: one for each orientation as long as controls have any, and what is told where they run out."""

import FreeCAD
from freecad.toolaxis.document.properties import Property, assign, ensure

translate = FreeCAD.Qt.translate

#: Work offsets in the order in which jobs take them: those of FreeCAD's list that LinuxCNC and others know.
OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
#: How the comment begins that a program has whose work offset serves several orientations.
_MARK = "(work offset "
_TOLD = (Property("String", "SharedOffset", "Tool Axis", "Other jobs that have the same work offset", True),)
#: Jobs that are named in a sentence.
_NAMED = 3


def offsets_for(document, wanted):
    """Work offsets for new jobs: those that a job had before, else the first that no other job of the document has.

    Parameters
    ----------
    document : App.Document
    wanted : sequence of (list of str or None)
        For each new job the offsets to keep.

    Returns
    -------
    list of list of str
        Where all are taken, the one that fewest jobs have.
    """
    taken = [name for job in _jobs(document) for name in job.Fixtures]
    taken += [name for kept in wanted for name in kept or ()]
    found = []
    for kept in wanted:
        if not kept:
            kept = [min(OFFSETS, key=taken.count)]
            taken += kept
        found.append(list(kept))
    return found


def tell_shared(document):
    """Let each of our jobs tell, in its properties and in its program, whether other jobs have its work offset too.

    Parameters
    ----------
    document : App.Document
    """
    jobs = _jobs(document)
    users = {}
    for job in jobs:
        for name in job.Fixtures:
            users.setdefault(name, []).append(job)
    for job in jobs:
        own = _own(job)
        if not own:
            continue
        shared = [name for name in job.Fixtures if len(users[name]) > 1]
        others = [one.Label for one in jobs if one is not job and set(shared).intersection(one.Fixtures)]
        ensure(job, _TOLD)
        assign(job, SharedOffset=_sentence(shared, others) if shared else "")
        _comment(own[0], shared)


def shared_of(jobs):
    """Those of some jobs whose work offset other jobs have too.

    Parameters
    ----------
    jobs : sequence of App.DocumentObject
    """
    return [job for job in jobs if getattr(job, "SharedOffset", "")]


def _sentence(shared, others):
    names = ", ".join(others[:_NAMED]) + (translate("ToolAxis", " and {} more").format(len(others) - _NAMED)
                                          if len(others) > _NAMED else "")
    return translate("ToolAxis", "{} is also the work offset of {}: set it for this orientation before the program "
                                 "runs").format(", ".join(shared), names)


def _comment(made, shared):
    """Begin an operation with what the operator has to mind; English, since controls know no other letters."""
    lines = [line for line in made.Gcode if not line.startswith(_MARK)]
    if shared:
        lines.insert(0, f"{_MARK}{' '.join(shared)} serves several orientations: set it for this one before running)")
    if list(made.Gcode) != lines:
        made.Gcode = lines


def _own(job):
    """The operations of a job that hold passes of ours."""
    return [made for made in job.Operations.Group if getattr(made, "OrientedFrom", None) is not None]


def _jobs(document):
    """FreeCAD's jobs of a document, in its order."""
    return [thing for thing in document.Objects
            if "Fixtures" in thing.PropertiesList and getattr(thing, "Operations", None) is not None]
