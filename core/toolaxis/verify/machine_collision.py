"""Whether bodies of the machine come too near on an operation and on the index move before it."""

from dataclasses import replace

from toolaxis.progress import Progress
from toolaxis.verify.axis_limits import machine_faults
from toolaxis.verify.component_clearance import Clearance
from toolaxis.verify.machine_motion import MachineModel, least_room
from toolaxis.verify.task import VerificationTask, motion_of, spot

#: What is judged, and what rounding of the cutter locations may cost there, mm.
KINDS, _ROUNDING = ("machine", "index move", "tool on index move"), 1e-3


def machine_rooms(task: VerificationTask, progress: Progress) -> dict[str, Clearance]:
    """How near table and spindle come to each other, part and tool: along the passes, and on the index move before.

    Parameters
    ----------
    task : VerificationTask
    progress : Progress

    Returns
    -------
    dict of str to Clearance
        By `KINDS`; empty where bodies, the part's place or rotary angles are not known.
    """
    machine = task.machine
    if machine is None or not machine.bodies or task.place is None or task.tool_length is None:
        return {}
    if len(task.rotary) != len(machine.rotary) or machine_faults(machine, task.tips, task.axes, None, None):
        return {}
    rig = MachineModel(machine, task.place, task.tool_length, task.profile, task.outlines,
                       (*task.targets, *task.skin, *task.touching, *task.surroundings))
    if not rig.judged:
        return {}
    needed = task.tolerance.holder_clearance + task.stock
    joints, arrival = rig.joints(task.tips, task.axes, task.rotary)
    room = least_room(rig, joints, needed, rig.pairs, progress)
    found = {"machine": replace(room, motion=int(arrival[room.motion])) if room.motion >= 0 else room}
    last = None
    if task.before is not None:
        tip, axis, rotary = task.before
        last = rig.joints(tip[None], axis[None], rotary)[0][0]
    ways = rig.between(last, joints[0])
    if ways is not None:
        found["index move"] = least_room(rig, ways, needed, rig.pairs, progress)
        found["tool on index move"] = least_room(rig, ways, task.tolerance.cutter_clearance + task.stock,
                                                 rig.tool_and_part, progress)
    return found


def meeting_reasons(task: VerificationTask, name: str, room: Clearance) -> list[str]:
    """What comes too near, in words.

    Parameters
    ----------
    task : VerificationTask
    name : str
        One of `KINDS`.
    room : Clearance
    """
    need = task.tolerance.cutter_clearance if name == "tool on index move" else task.tolerance.holder_clearance
    need += task.stock
    if room.distance >= need - _ROUNDING or task.machine is None:
        return []
    other = room.face if room.face.startswith("face ") else f"the {room.face}"
    met = f"comes within {room.distance:.2f} mm of {other}" if room.distance >= 0 else \
        f"collides with {other} by {-room.distance:.2f} mm"
    when = f"on the {motion_of(task, room.motion)}" if name == "machine" else "on the index move before it"
    return [f"the {room.component} {met} at {spot(room.point)} on {task.machine.name}, needed {need} mm, {when}"]
