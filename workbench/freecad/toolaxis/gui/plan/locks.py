"""Which axes and feeds of a plan are locked, and the sub-surfaces that are kept for that."""

from freecad.toolaxis.document.inputs import KeptSubSurface
from freecad.toolaxis.services.write_results import owners_of


class AxisLocks:
    """Locks of a plan that is not in the document yet, by the operations' numbers.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs, optional
        What the plan was made with.
    plan : toolaxis.plan.plan.Plan, optional
    """

    def __init__(self, inputs=None, plan=None):
        self.axis, self.feed, self.drawn = set(), set(), set()
        self.owners = {}
        if plan is None:
            return
        for op, owner in zip(plan.operations, owners_of(inputs, plan), strict=True):
            self.owners[op.number] = owner
            piece = next((one for one in inputs.pieces if (one.thing.Name, one.name, one.suffix) == (
                owner[0].Name, owner[1], _suffix(op))), None)
            if piece is not None and op.done:
                for name, held in (("axis", piece.locked), ("feed", piece.feed), ("drawn", piece.drawn)):
                    if held:
                        getattr(self, name).add(op.number)

    def pieces(self, plan, every=False):
        """The sub-surfaces that are kept when the plan is computed again.

        Parameters
        ----------
        plan : toolaxis.plan.plan.Plan
            As it is now.
        every : bool
            Whether the borders of all faces are kept, also where nothing is locked.
        """
        from toolaxis.plan.document import region_of

        held = self.axis | self.feed | self.drawn
        copies = {} if plan.blades is None else plan.blades.copies
        faces = {op.face.number for op in plan.operations if every or op.number in held}
        found = []
        for op in plan.operations:
            if op.face.number not in faces or op.number in copies:
                continue
            thing, name, _ = self.owners[op.number]
            locked = op.number in self.axis and op.done
            region = region_of(op.face, plan.part) or ()
            found.append(KeptSubSurface(thing, name, tuple(tuple(map(tuple, loop)) for loop in region),
                                        tuple(map(float, op.orientation.axis)) if locked else None,
                                        op.orientation.feed if op.number in self.feed and op.done else "", locked,
                                        _suffix(op), op.number in self.drawn))
        return tuple(found)


def _suffix(op):
    return op.face.label.removeprefix(str(op.face.number))
