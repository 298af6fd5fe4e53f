"""Operations played in their order: paths with their times, the way of tool or machine, and what meets on it.

Nothing here needs a window.  What is read of a document is read first; the rest runs in any thread.
"""

from dataclasses import dataclass, replace

import numpy as np
from freecad.toolaxis.document.blade_links import turned_copies
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.machine import angles_kept, nearest
from freecad.toolaxis.document.machine_angles import ways_to_hold
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.path_collisions import FacesRead, PathCollision, bumps_among
from freecad.toolaxis.services.tour import MachineTour, ToolTour

#: Looks along a path whose axis moves on a machine, and the shares down to which another one is divided to find where
#: a body of the machine meets something: each look where something meets takes a fifth of a second.
_LOOKS, _PARTS = 200, 12


@dataclass(frozen=True)
class PlayedOperation:
    """An operation as it is played.

    Attributes
    ----------
    label : str
    path : toolaxis.cldata.toolpath.ToolPath
        In the document's space.
    tool : toolaxis.tools.tool.Tool
    inputs : toolaxis.plan.plan.PlanInputs
        With the rates.
    axis : (3,) array
        The tool axis, its mean where it moves.
    moves : bool
        Whether the axis moves while it cuts.
    rotary : tuple of float
        Rotary angles at which it was planned, rad; empty where that is not known.
    time : toolaxis.plan.timing.MachiningTime or None
        What the machine takes.
    gouges : tuple of (int, float)
        Motions that Verify found to gouge, and how deep, mm.
    """

    label: str
    path: object
    tool: object
    inputs: object
    axis: object
    moves: bool = False
    rotary: tuple = ()
    time: object = None
    gouges: tuple = ()


def played_from(operations, labels=None):
    """Operations of a document with their turned copies, in their order.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
        Those without passes are left out.
    labels : sequence of str, optional
        Only those that are called so, in this order.

    Returns
    -------
    list of PlayedOperation

    Raises
    ------
    InvalidInput
        When none has passes, or one has no part any more.
    """
    from toolaxis.errors import InvalidInput

    found = []
    for operation in operations:
        if not operation.Motions:
            continue
        inputs, standing = inputs_of(operation), OperationRecord.of(operation)
        rates, moves = inputs.job(), bool(operation.AxisMoves)
        first = PlayedOperation(operation.Label, standing.path, inputs.assembled(), rates, standing.matrix[:3, 2],
                                moves, () if moves else angles_kept(operation), None, _gouges_of(operation))
        found.append(first)
        for link in turned_copies(operation):
            copy = standing.turned(link.Placement, 0)
            found.append(replace(first, label=link.Label, path=copy.path, axis=copy.matrix[:3, 2], rotary=()))
    if labels is not None:
        known = {one.label: one for one in reversed(found)}
        found = [known[label] for label in labels if label in known]
    if not found:
        raise InvalidInput("there is no operation with passes: select faces and run Plan Orientations first")
    return found


def _gouges_of(operation):
    """Motions that gouge deeper than is accepted, as Verify found them; none where its verdict does not hold."""
    if operation.Verdict != "failed":
        return ()
    return tuple((motion, depth) for motion, depth in zip(
        getattr(operation, "WorstGougeMotions", ()), operation.WorstGougeDepths, strict=False)
        if motion >= 0 and depth > operation.GougeAllowed.Value)


def played_of(plan, titles):
    """Operations of a plan that is in no document yet, in their order.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
        With an operation that has passes.
    titles : dict of int to str
        What they are called, by their numbers.
    """
    return [PlayedOperation(titles.get(op.number, op.name), op.path, op.tool, plan.inputs.at_rates_of(op.tool),
                            op.path.axis[0] if op.orientation.axis is None else op.orientation.axis,
                            op.orientation.lead is not None, tuple(op.rotary), op.time)
            for op in plan.operations if op.done]


@dataclass(frozen=True, eq=False)
class PlayedTour:
    """Operations laid out to be played.

    Attributes
    ----------
    operations : tuple of PlayedOperation
    playback : toolaxis.plan.playback.Playback
    tour : freecad.toolaxis.services.tour.MachineTour or ToolTour
    mounted : toolaxis.machine.setup.Mounting or None
        None for the tool alone.
    why : str
        Why no machine is shown although one was asked for; empty otherwise.
    """

    operations: tuple
    playback: object
    tour: object
    mounted: object = None
    why: str = ""

    def holding(self, row):
        """The machine with the tool of an operation in its spindle.

        Parameters
        ----------
        row : int
        """
        return replace(self.mounted, tool_length=self.operations[row].tool.gauge_length)

    def stand(self, place):
        """What goes on at a place, and where everything stands.

        Parameters
        ----------
        place : float
            0 to 1.

        Returns
        -------
        moment : toolaxis.plan.playback.Moment
        row : int
            The operation whose tool is in the spindle.
        where : (3 + m,) array, or ((3,) array, (3,) array)
            Joint coordinates of the machine, or tip and axis of the tool alone.
        """
        one = self.playback.at(place)
        if self.mounted is None:
            where = (self.tour.between(one.operation, one.share) if one.between
                     else self.tour.along(one.operation, one.motion, one.share))
            return one, one.operation + int(one.between and one.share > 0.5), where
        if not one.between:
            return one, one.operation, self.tour.along(one.operation, one.motion, one.share)
        way = one.operation + min(one.share, 1 - 1e-12)
        return one, self.tour.station(way), self.tour.at(way)


def lay_out(operations, mounted=None):
    """Operations as they are played on a machine, or by the tool alone; runs in any thread.

    Parameters
    ----------
    operations : sequence of PlayedOperation
    mounted : toolaxis.machine.setup.Mounting, optional
        With the part's place on its table.

    Returns
    -------
    PlayedTour
        Of the tool alone, with the reason, where the machine cannot hold an axis.
    """
    from toolaxis.errors import InvalidInput

    if mounted is not None:
        try:
            return lay_out_at(operations, mounted, _angles_along(operations, mounted))
        except InvalidInput as reason:
            return replace(lay_out(operations), why=str(reason))
    return PlayedTour(tuple(operations), _play_times(operations), ToolTour.through([one.path for one in operations]))


def lay_out_at(operations, mounted, rotary):
    """Operations as they are played on a machine at given rotary angles; runs in any thread.

    Parameters
    ----------
    operations : sequence of PlayedOperation
    mounted : toolaxis.machine.setup.Mounting
    rotary : sequence of (m,) or (n, m) array
        For each operation, or at each of its points, rad.
    """
    stations = [(one.path.cl, angles) for one, angles in zip(operations, rotary, strict=True)]
    tour = MachineTour.through(mounted, stations, [one.tool.gauge_length for one in operations])
    return PlayedTour(tuple(operations), _play_times(operations, (mounted, rotary)), tour, mounted)


def _angles_along(operations, mounted):
    """Rotary angles of each operation, at each point where the axis moves.

    Those that it was planned at, else the nearest to the operation before that nothing speaks against.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.feed.continuous_ik import following

    stand, rows = np.zeros(len(mounted.machine.rotary)), []
    for one in operations:
        length = one.tool.gauge_length
        if one.moves:
            found = following(mounted.machine, one.path, mounted.table_from_part, float(length or 0.0), near=stand)
            ends = np.flatnonzero(np.append(np.diff(found.arrival) != 0, True))
            rows.append(found.rotary[ends])
            stand = found.rotary[-1]
            continue
        ways = ways_to_hold(replace(mounted, tool_length=length), one.axis, one.path.cl)
        if not ways:
            raise InvalidInput(f"{mounted.machine.name} has no position for the axis of '{one.label}'")
        good = [way for way in ways if not way.reason] or ways
        way = (ways[nearest(ways, one.rotary)] if len(one.rotary) == len(stand)
               else min(good, key=lambda way: float(np.abs(way.rotary - stand).max(initial=0.0))))
        rows.append(way.rotary)
        stand = way.rotary
    return rows


def _play_times(operations, on_machine=None):
    """The playback of operations; on a machine with the time of its index moves where it states its drives."""
    from toolaxis.job.planning.timing import seconds_to_index
    from toolaxis.plan.playback import Playback, TimedPath, seconds_between

    paths = [TimedPath.at_rates(one.path, one.inputs.feedrate, one.inputs.rapid, one.time) for one in operations]
    known, between = on_machine is not None and not on_machine[0].machine.unstated, []
    for k in range(1, len(operations)):
        before, after = operations[k - 1:k + 1]
        index = None
        if known:
            mounted, rotary = on_machine
            held = replace(mounted, tool_length=after.tool.gauge_length)
            index = seconds_to_index(held, (before.path.cl[-1], np.atleast_2d(rotary[k - 1])[-1]),
                                     (after.path.cl[0], np.atleast_2d(rotary[k])[0]))
        between.append(seconds_between((before.axis, after.axis), after.tool != before.tool, index))
    return Playback(tuple(paths), tuple(between))


@dataclass(frozen=True)
class PlayedCollisions:
    """What meets while operations are played.

    Attributes
    ----------
    on_passes : tuple of tuple of PathCollision
        For each operation.
    between : tuple of freecad.toolaxis.services.collisions.Collision or None
        `collisions.STEPS` for each index move and one at the end; empty where no machine makes them.
    unchecked : tuple of str
        What was not looked at: "shank", "holder", "machine", "index moves".
    """

    on_passes: tuple
    between: tuple = ()
    unchecked: tuple = ()

    def at(self, moment):
        """What meets at a moment; None where nothing does.

        Parameters
        ----------
        moment : toolaxis.plan.playback.Moment
        """
        if not moment.between:
            some = self.on_passes[moment.operation]
            return next((one for one in some if one.first <= moment.motion <= one.last), None)
        low = (moment.operation + moment.share) * collisions.STEPS
        some = self.between[int(low):int(low) + 2]
        return next((one for one in some if one is not None), None)

    def places(self, playback):
        """All places where something meets, (place, row, what) in their order; a row counts from 0.

        Parameters
        ----------
        playback : toolaxis.plan.playback.Playback
        """
        found = []
        for row, some in enumerate(self.on_passes):
            found += [(playback.place_of(row, (one.first + one.last + 1) // 2), row, one) for one in some]
        last = None
        for k, one in enumerate(self.between[:-1]):
            if one is not None and (last is None or one.text != last.text):
                found.append((playback.place_between(k // collisions.STEPS, k % collisions.STEPS / collisions.STEPS),
                              k // collisions.STEPS, one))
            last = one
        return sorted(found, key=lambda row: row[0])


def look_out(laid, copies, progress, known=None):
    """What tool and machine meet of copies of objects while operations are played; runs in any thread.

    Parameters
    ----------
    laid : PlayedTour
    copies : sequence of freecad.toolaxis.services.collisions.ShapeCopy
    progress : toolaxis.progress.Progress
    known : freecad.toolaxis.services.collisions.CollisionModel, optional
        The copies on the machine with the tools of the operations, where they were read already.

    Returns
    -------
    PlayedCollisions
        With the gouges that Verify found.
    """
    if known is None and laid.mounted is not None and laid.mounted.judges_travel:
        known = collisions.around(laid.mounted, [one.tool for one in laid.operations], copies, progress)
    read = FacesRead.of(copies, progress) if known is None else FacesRead.again(known)
    found = []
    for row, one in enumerate(laid.operations):
        progress.report("checking for collisions", row, len(laid.operations))
        some = [*bumps_among(one.tool, one.path, read, progress).found, *_gouging(one)]
        if known is not None:
            some += _machine_bumps(known, laid, row, progress)
        found.append(tuple(sorted(some, key=lambda one: one.first)))
    between = ()
    if known is not None and len(laid.operations) > 1:
        between = tuple(collisions.along(known, laid.tour, list(range(len(laid.operations))), progress))
    return PlayedCollisions(tuple(found), between, _unchecked(laid, known is not None))


def _unchecked(laid, on_machine):
    """What is not known of tools and machine, and so is not looked at."""
    found = [name for name in ("shank", "holder") if not all(name in one.tool.outlines for one in laid.operations)]
    if laid.mounted is not None and not (on_machine and laid.mounted.judges_bodies):
        found.append("machine")
    if not on_machine and len(laid.operations) > 1:
        found.append("index moves")
    return tuple(found)


def _gouging(one):
    return [PathCollision(motion, motion, f"the cutter gouges the face by {depth:.4f} mm", "cutter")
            for motion, depth in one.gouges if motion < len(one.path.cl)]


def _machine_bumps(known, laid, row, progress):
    """Motions on which a body of the machine meets the part, what stands beside it, or another body."""
    from toolaxis.progress import activate_progress

    count = len(laid.operations[row].path.cl)
    with activate_progress(progress):
        if laid.operations[row].moves:
            some = np.unique(np.linspace(0, count - 1, min(count, _LOOKS)).astype(int)).tolist()
            looks = [(k, k, known.machine_at(row, laid.tour.legs[row][k])) for k in some]
            step = max(1, count // _LOOKS)
            looks = [(first, min(last + step, count - 1), one) for first, last, one in looks]
        else:
            looks = _divide_motions(known, laid, row)
    made = []
    for first, last, one in looks:
        if one is None:
            continue
        before = made[-1] if made else None
        if before is not None and before.last >= first - 1 and (before.member, before.thing, before.body) == (
                one.member, one.thing, one.body):
            made[-1] = replace(before, last=last)
        else:
            made.append(PathCollision(first, last, one.text, one.member, one.thing, one.body))
    return made


def _divide_motions(known, laid, row):
    """Ranges of motions on which a body of the machine meets something; proven clear in between."""
    tips, rotary = laid.operations[row].path.cl, laid.tour.legs[row][0, 3:]
    least, left, found = max(1, (len(tips) - 1) // _PARTS), [(0, len(tips) - 1)], []
    while left:
        first, last = left.pop()
        one = known.machine_on_passes(row, rotary, tips[first:last + 1])
        if one is not None and last - first <= least:
            found.append((first + 1 if last > first else first, last, one))
        elif one is not None:
            middle = (first + last) // 2
            left += [(middle, last), (first, middle)]
    return found
