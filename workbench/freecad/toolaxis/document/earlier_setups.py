"""The setup before a plan's own: what can be one, what came of it, and whether that has changed since."""

from hashlib import sha256

from freecad.toolaxis.document.kinds import is_operation, is_plan, operations_in, plan_of
from freecad.toolaxis.document.stale_label import plain_label

from toolaxis.strategies.registry import strategies

#: Letters of a fingerprint: plans that differ have different ones.
_LETTERS = 16
#: What is told of a plan whose earlier setup is gone.
DELETED = "the earlier setup was deleted"


def is_setup(thing):
    """Whether another setup can follow an object: a whole plan, or an operation that stands alone.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return is_plan(thing) or (is_operation(thing) and plan_of(thing) is None)


def operations_of(setup):
    """The operations of a setup, in their order.

    Parameters
    ----------
    setup : App.DocumentObject
    """
    return operations_in(setup) if is_plan(setup) else [setup]


def faces_of_setup(setup):
    """The faces that a setup was asked for; none where its part was deleted.

    Parameters
    ----------
    setup : App.DocumentObject

    Returns
    -------
    tuple of (object, "Face7")
    """
    return tuple((part, name) for part, names in setup.Faces for name in names if name)


def setups_up_to(setup):
    """A setup and all that come before it, the first one first; each once, should they form a ring.

    Parameters
    ----------
    setup : App.DocumentObject or None
    """
    found = []
    while setup is not None and setup not in found:
        found.insert(0, setup)
        setup = setup.After if is_plan(setup) else None
    return found


def later_setups(document):
    """The plans of a document that follow an earlier setup, those with the fewest setups before them first.

    Parameters
    ----------
    document : App.Document
    """
    found = [thing for thing in document.Objects if is_plan(thing) and thing.After is not None]
    return sorted(found, key=lambda plan: len(setups_up_to(plan)))


def setups_to_follow(document, part=None, plan=None):
    """The setups of a document that a plan can follow.

    Parameters
    ----------
    document : App.Document
    part : App.DocumentObject, optional
        What the plan machines; any unless given.
    plan : App.DocumentObject, optional
        The plan itself, where it is there already: it follows neither itself nor what follows it.
    """
    found = []
    for thing in filter(is_setup, document.Objects):
        parts = {owner.Name for owner, _ in faces_of_setup(thing)}
        is_of_part = len(parts) == 1 and (part is None or part.Name in parts)
        if is_of_part and plan not in setups_up_to(thing):
            found.append(thing)
    return found


def fingerprint_of(setup):
    """A text that changes with what a setup machines and with what it was planned for; empty without a setup.

    Parameters
    ----------
    setup : App.DocumentObject or None
    """
    if setup is None:
        return ""
    words = [setup.PlannedWith]
    for one in operations_of(setup):
        words += [one.PlannedWith, one.Details, str(bool(one.Motions))]
    return sha256("\n".join(words).encode()).hexdigest()[:_LETTERS]


def changes_since(planned, setup, document):
    """What has become of the earlier setup since a plan that follows it was made, sentences.

    Parameters
    ----------
    planned : [name, fingerprint] or None
        Of the earlier setup at the time of planning; None where there was none.
    setup : App.DocumentObject or None
        The earlier setup as it is chosen now.
    document : App.Document
    """
    name = None if planned is None else planned[0]
    if setup is None and name is not None and document.getObject(name) is None:
        return [DELETED]
    if name != (None if setup is None else setup.Name):
        return ["another earlier setup was chosen"]
    if setup is None:
        return []
    if setup.Stale:
        return [f"the earlier setup {plain_label(setup)} is out of date"]
    if planned[1] != fingerprint_of(setup):
        return [f"the earlier setup {plain_label(setup)} was planned again"]
    return []


def check_earlier_setup(inputs):
    """Check that what is asked for goes with the earlier setup, if there is one.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Raises
    ------
    InvalidInput
        In one sentence with the remedy.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.job.planning.earlier_setups import check_after

    if inputs.after is None:
        return
    label = plain_label(inputs.after)
    if len(inputs.things) > 1:
        raise InvalidInput(f"the earlier setup '{label}' machines several parts: choose one that machines one part")
    if inputs.pieces:
        raise InvalidInput("sub-surfaces that are locked or drawn by hand do not go with an earlier setup: unlock "
                           "them, or choose no earlier setup")
    strategy = strategies().get(inputs.strategy)
    if strategy is not None:
        check_after(strategy)
