"""The verdict: per operation what was measured, against what is allowed, and in sentences why it fails."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.verify.axis_limits import machine_faults
from toolaxis.verify.component_clearance import FAR, Clearance, clearance
from toolaxis.verify.contact_leans import UNCERTAINTY, ContactLean, least_lean
from toolaxis.verify.declared import STRIP, DeclaredZones
from toolaxis.verify.depths import Depths
from toolaxis.verify.held_side import distance_to_held_side
from toolaxis.verify.lead_arcs import LeadCount, check_leads
from toolaxis.verify.machine_collision import KINDS, machine_rooms, meeting_reasons
from toolaxis.verify.maps import MapPoint, MapZone, SurfaceMap, place_at, surface_map
from toolaxis.verify.material_removal import Removal, RestMaterial
from toolaxis.verify.near_faces import SweptBoxes
from toolaxis.verify.pass_distances import FACTOR as STEP_OVER_FACTOR
from toolaxis.verify.pass_distances import MeasuredFace, PassDistance, greatest_distance
from toolaxis.verify.rays import gouge_spacing
from toolaxis.verify.revolved_solids import cutter_solid, frustum_solids
from toolaxis.verify.seams import SMALLEST
from toolaxis.verify.task import VerificationTask, motion_of, spot
from toolaxis.verify.turned_copies import OperationMeasurement

Array = NDArray[np.float64]

#: An operation passes when this share of the area, declared zones aside, is left no higher than this multiple of the
#: scallop limit.
SHARE, FACTOR = 0.999, 1.02

#: Axes are the same up to this, rad: CL files have nine digits.
SAME_AXIS = 1e-6

#: Where a tool that stands on a face would be deeper than this share of the machining tolerance, or have no more than
#: so much more than its clearance, mm, no pass is missed.
_DEEP, _MORE = 0.5, 0.05

NOT_CHECKED = "not checked"
#: The cutter where links carry it, which must not cut.
AT_RAPID = "cutter at rapid traverse"


@dataclass(frozen=True, eq=False)
class OperationVerdict:
    """What was measured on one operation.

    Attributes
    ----------
    name : str
    faces : tuple of str
        Labels of the faces machined.
    scallop_limit, allowance : float
        mm
    scallop_max : float
        Greatest height left where the cutter came, declared zones aside, mm; inf where it came nowhere.
    share_within : float
        Share of the area, declared zones aside, left no higher than `FACTOR` times the limit, 0 to 1.
    declared : float
        Area of the zones that the plan declares as left as rest material, with the strip around them, mm^2: no height
        is asked for there.
    gouge_max, gouge_allowed : float
        mm; the greatest is no more than the depth to which gouges are followed.
    clearance : dict of str to Clearance or "not checked"
        For "cutter", "shank" and "holder"; for "machine", where its bodies were judged, between table and spindle.
    worst_scallop, worst_gouge : tuple of MapPoint
        The worst first; the gouge's only where it exceeds the judge's uncertainty, and with the deepest place in a
        face behind a convex edge.
    link_cut : MapPoint or None
        Where a link goes deepest into what the cutting motions leave; None where none does.
    zones : tuple of MapZone
        Connected zones left above the limit, declared ones aside, the largest first.
    area : float
        mm^2
    rays : int
    spacing : float
        Greatest distance of neighbouring rays, mm.
    uncertainty : float
        Bound of the error of a height or depth at a ray, mm, approximated faces included.
    passed : bool
    reasons : tuple of str
        Sentences: why it failed; what was not checked.
    maps : tuple of SurfaceMap
        Of the targets, then of the skin; of the skin only the rays that something cut or gouged.
    stock : float
        How far stock stands above the finished faces that carry it, mm.
    from_stock : dict of str to Clearance
        Distances from those finished faces: of "shank" and "holder", and of the cutter on links, `AT_RAPID`.
    lean : ContactLean, optional
        Where a ball end leans least from the normal at its contact; None where no lean is asked for, the cutter is no
        ball end, or it touches nothing.
    step_over : PassDistance, optional
        Where neighbouring passes lie farthest apart; None where no greatest step-over is asked for, or they lie nowhere
        near as far apart.
    leads : LeadCount, optional
        Of how many ends of passes there are arcs; None where none are asked for.
    """

    name: str
    faces: tuple[str, ...]
    scallop_limit: float
    allowance: float
    scallop_max: float
    share_within: float
    declared: float
    gouge_max: float
    gouge_allowed: float
    clearance: dict[str, Clearance | str]
    worst_scallop: tuple[MapPoint, ...]
    worst_gouge: tuple[MapPoint, ...]
    link_cut: MapPoint | None
    zones: tuple[MapZone, ...]
    area: float
    rays: int
    spacing: float
    uncertainty: float
    passed: bool
    reasons: tuple[str, ...]
    maps: tuple[SurfaceMap, ...]
    stock: float = 0.0
    from_stock: dict[str, Clearance] = field(default_factory=dict)
    lean: ContactLean | None = None
    step_over: PassDistance | None = None
    leads: LeadCount | None = None

    @property
    def measured(self) -> bool:
        """Whether anything was measured: not where the judge itself failed."""
        return self.rays > 0


def not_measured(name: str, limits: tuple[float, float, float], why: str) -> OperationVerdict:
    """The verdict on an operation on which the judge itself failed: it has not passed.

    Parameters
    ----------
    name : str
        Of the operation.
    limits : (float, float, float)
        Scallop limit, allowance and gouge allowed, mm.
    why : str
    """
    scallop, allowance, gouge = limits
    unknown: dict[str, Clearance | str] = dict.fromkeys(("cutter", "shank", "holder"), NOT_CHECKED)
    return OperationVerdict(name, (), scallop, allowance, float("inf"), 0.0, 0.0, 0.0, gouge, unknown, (), (), None,
                            (), 0.0, 0, 0.0, 0.0, False, (why,), ())


@dataclass(frozen=True, eq=False)
class Verdict:
    """The verdict on a plan.

    Attributes
    ----------
    operations : tuple of OperationVerdict
    unjudged : tuple of str
        Names of the operations that were not judged, as the user stopped before.
    """

    operations: tuple[OperationVerdict, ...]
    unjudged: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether there is an operation, every one was judged, and every one passed."""
        return bool(self.operations) and not self.unjudged and all(op.passed for op in self.operations)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Sentences of all operations, each led by its name."""
        return (*(f"{op.name}: {reason}" for op in self.operations for reason in op.reasons),
                *(f"{name}: not verified: stopped before" for name in self.unjudged))


def verify(tasks: Sequence[VerificationTask], *, spacing: float | None = None, threads: int = 1,
           progress: Progress = NO_PROGRESS) -> Verdict:
    """Judge operations by removing material with the cutter along their cutter location data.

    Parameters
    ----------
    tasks : sequence of VerificationTask
    spacing : float, optional
        Distance of neighbouring rays, mm; by the size of each face unless given.
    threads : int
        Threads of the compiled kernels; the verdict does not depend on it.
    progress : Progress

    Raises
    ------
    InvalidInput
        When cutter location data is empty or not finite, or sizes make no tool.
    Cancelled
        When the progress object asks to stop.
    """
    judged = []
    for index, task in enumerate(tasks):
        progress.report("verify", index, len(tasks))
        judged.append(judge(task, spacing, threads, progress))
    return Verdict(tuple(judged))


def judge(task: VerificationTask, spacing: float | None = None, threads: int = 1,
          progress: Progress = NO_PROGRESS) -> OperationVerdict:
    """Judge one operation.

    Parameters
    ----------
    task : VerificationTask
    spacing, threads, progress
        As for `verify`.
    """
    return verdict_on(task, measure(task, spacing, threads, progress), progress)


def measure(task: VerificationTask, spacing: float | None = None, threads: int = 1,
            progress: Progress = NO_PROGRESS) -> OperationMeasurement:
    """Measure one operation: what it leaves, how deep it cuts, and how far its tool stays from all else.

    Parameters
    ----------
    task : VerificationTask
    spacing, threads, progress
        As for `verify`.
    """
    cl = (task.tips, task.axes, task.kind)
    cutter = Removal(cl, task.profile, threads=threads, progress=progress)
    standing = _standing(task)
    depths = Depths(task, partial(cutter.along, height=standing))

    def along(face: Face, point: Array, normal: Array, height: float = standing) -> RestMaterial:
        left = cutter.along((point + task.allowance * normal, normal), depth=task.depth, height=height)
        depths.correct(face, (point, normal), left)
        return left

    left = DeclaredZones(task.left, STRIP * (task.profile.flat_radius + task.profile.corner_radius))
    targets = tuple(surface_map(face, partial(along, face), spacing, declared=partial(left.holds, face))
                    for face in task.targets)
    swept, above = SweptBoxes(task.tips, task.axes, task.profile), task.tolerance.gouge
    near = [face for face in task.skin if swept.may_come_to(face, abs(task.allowance) + max(task.depth, above))]
    skin = tuple(_keep_touched(surface_map(face, partial(along, face, height=above),
                                           spacing or _spacing_for_gouges(face, task),
                                           heights=False)) for face in near)
    links = Removal(cl, task.profile, among=(Motion.LINK,), threads=threads, progress=progress)
    link_cut = _link_cut(task, targets, partial(links.along, height=_standing(task), cutting=(Motion.LINK,)))
    edge = _behind_edges(task, depths, threads, progress)
    uncertainty = cutter.uncertainty + max(face.tolerance for face in (*task.targets, *task.skin))
    return OperationMeasurement(targets, skin, _rooms(task, threads, progress), edge, link_cut, uncertainty,
                                _rooms_from_stock(task, threads, progress))


def _spacing_for_gouges(face: Face, task: VerificationTask) -> float:
    return gouge_spacing(face, task.profile.flat_radius, task.profile.corner_radius, task.tolerance.gouge)


def _keep_touched(one: SurfaceMap) -> tuple[SurfaceMap, int]:
    """What is kept of the map of a face of the skin: the rays that something cut or gouged, and how many there were."""
    return one.touched(), len(one.uv)


def _behind_edges(task: VerificationTask, depths: Depths, threads: int, progress: Progress) -> Clearance:
    """How far faces behind convex edges stay out of the cutter; what the file's faces miss each other by is taken off
    where they do not."""
    find = partial(clearance, (task.tips, task.axes, task.kind), ("cutter at convex edges", cutter_solid(task.profile)),
                   task.touching, enough=task.tolerance.gouge, threads=threads, progress=progress)
    found = find()
    if -found.distance <= SMALLEST:
        return found
    face = next(face for face in task.touching if face.label == found.face)
    missed = depths.missed_near(face, np.array(found.point))
    return find(taken_off=depths.missed_behind_edges) if missed else found


def _clearance_of(task: VerificationTask, name: str) -> float:
    """Clearance that a component must keep, mm."""
    needed = {"cutter": task.tolerance.cutter_clearance, AT_RAPID: task.tolerance.cutter_clearance,
              "shank": task.tolerance.shank_clearance}
    return needed.get(name, task.tolerance.holder_clearance)


def _rooms(task: VerificationTask, threads: int, progress: Progress) -> dict[str, Clearance | str]:
    """Clearance of every component: the cutter from the surroundings, shank and holder from all faces."""
    everything = (*task.targets, *task.skin, *task.touching, *task.surroundings)
    parts = {name: (frustum_solids(outline, name), everything) for name, outline in task.outlines.items()}
    if task.surroundings:
        parts["cutter"] = (cutter_solid(task.profile), task.surroundings)
    rooms: dict[str, Clearance | str] = {"cutter": NOT_CHECKED, "shank": NOT_CHECKED, "holder": NOT_CHECKED}
    for name, (solids, faces) in parts.items():
        rooms[name] = clearance((task.tips, task.axes, task.kind), (name, solids), faces,
                                enough=_clearance_of(task, name), threads=threads, progress=progress)
    return rooms


def _rooms_from_stock(task: VerificationTask, threads: int, progress: Progress) -> dict[str, Clearance]:
    """Distances from the faces that carry stock: of shank and holder on all motions, of the cutter on links.

    All of the stock counts as there: what operations before this one, and its own motions, have cut is not taken off.
    """
    if not (task.stock > 0 and task.proud):
        return {}
    asked: dict[str, tuple[Array, tuple[int, ...] | None]] = {
        name: (frustum_solids(outline, name), None) for name, outline in task.outlines.items()}
    asked[AT_RAPID] = cutter_solid(task.profile), (Motion.LINK,)
    return {name: clearance((task.tips, task.axes, task.kind), (name, solids), task.proud, among=among,
                            enough=task.stock + _clearance_of(task, name), threads=threads, progress=progress)
            for name, (solids, among) in asked.items()}


def _standing(task: VerificationTask) -> float:
    """How high stock stands on the targets before the cut, mm; it stays where no pass reaches, and links go over it."""
    return max(1.0, 20 * task.scallop)


def _link_cut(task: VerificationTask, maps: tuple[SurfaceMap, ...],
              links: Callable[..., RestMaterial]) -> MapPoint | None:
    """Where a link goes deepest into what the cutting motions leave above the targets."""
    worst: MapPoint | None = None
    for one in maps:
        left = links((one.point + task.allowance * one.face.normal(one.uv), one.face.normal(one.uv)), depth=task.depth)
        depth = np.minimum(one.remaining, _standing(task)) - left.remaining
        i = int(np.argmax(depth))
        if depth[i] > task.tolerance.gouge and (worst is None or depth[i] > worst.value):
            worst = place_at(one.face, one.uv[i], one.point[i], (float(depth[i]), int(left.cut_by[i])))
    return worst


def _worst(maps: tuple[SurfaceMap, ...], what: str, least: float) -> tuple[MapPoint, ...]:
    places = [place for one in maps for place in one.worst(what) if place.value > least]
    return tuple(sorted(places, key=lambda place: -place.value)[:10])


def _with_edge(task: VerificationTask, places: tuple[MapPoint, ...], edge: Clearance, least: float) -> tuple[MapPoint,
                                                                                                             ...]:
    """The deepest places of the maps and the one behind a convex edge, the worst first."""
    if -edge.distance <= least:
        return places
    face = next(face for face in task.touching if face.label == edge.face)
    point = np.array(edge.point)
    behind = place_at(face, nearest(face, point[None]).uv[0], point, (-edge.distance, edge.motion))
    return tuple(sorted((behind, *places), key=lambda place: -place.value)[:10])


def verdict_on(task: VerificationTask, measured: OperationMeasurement,
               progress: Progress = NO_PROGRESS) -> OperationVerdict:
    """Hold what was measured of an operation against what is allowed; the machine is looked at here.

    Parameters
    ----------
    task : VerificationTask
    measured : OperationMeasurement
    progress : Progress
    """
    targets, edge, link_cut = measured.targets, measured.edge, measured.link_cut
    skin, uncertainty = tuple(one for one, _ in measured.skin), measured.uncertainty
    count = sum(len(one.uv) for one in targets) + sum(rays for _, rays in measured.skin)
    rooms = {**measured.rooms, **machine_rooms(task, progress)}
    limit, maps = FACTOR * task.scallop, (*targets, *skin)
    area = sum(one.area for one in targets)
    left = sum(one.left for one in targets)
    share = sum(one.area_within(limit) for one in targets) / (area - left) if area > left else 1.0
    reached = [one.worst_scallop.value for one in targets if one.worst_scallop is not None]
    touched = any((one.remaining == 0).any() for one in targets)
    gouges = _worst(maps, "gouge", uncertainty)
    zones = tuple(sorted((zone for one in targets for zone in one.zones(limit)), key=lambda zone: -zone.area))
    gouge = max((one.worst_gouge.value for one in maps if one.worst_gouge is not None), default=0.0)
    gouge_max, reached_max = max(gouge, -edge.distance), max(reached, default=0.0 if touched else float("inf"))
    lean, step_over, leads = _find_lean(task), _find_step_over(task, targets), _find_leads(task)
    failures = [*_axis_reasons(task), *_lean_reasons(task, lean), *_step_over_reasons(task, step_over),
                *(() if leads is None else leads.faults),
                *_scallop_reasons(task, share, zones, area), *_gouge_reasons(task, gouge, gouges),
                *_edge_reasons(task, edge), *_link_reasons(task, link_cut), *_room_reasons(task, rooms),
                *_reasons_of_held_side(task), *_reasons_of_allowances(task), *_stock_reasons(task, measured.from_stock),
                *_machine_reasons(task)]
    why = {"cutter": "there is nothing besides the machined skin"}
    notes = [f"{name} not checked: {why.get(name, 'its outline is not known')}"
             for name, room in rooms.items() if room == NOT_CHECKED]
    return OperationVerdict(
        task.name, tuple(face.label for face in task.targets), task.scallop, task.allowance,
        reached_max, share, left, gouge_max, task.tolerance.gouge, rooms,
        _worst(targets, "remaining", 0.0), _with_edge(task, gouges, edge, uncertainty), link_cut, zones, area, count,
        max(one.spacing for one in maps), uncertainty, not failures, (*failures, *notes),
        maps, task.stock, measured.from_stock, lean, step_over, leads)


def _axis_reasons(task: VerificationTask) -> list[str]:
    if task.named is None:
        return []
    apart = np.linalg.norm(task.axes - task.named, axis=1)
    i = int(np.argmax(apart))
    if apart[i] <= SAME_AXIS:
        return []
    return [f"the plan names the axis {_axis_text(task.named)}, and the tool stands at {_axis_text(task.axes[i])} at "
            f"point {i + 1}: plan the operation again"]


def _find_lean(task: VerificationTask) -> ContactLean | None:
    """The least lean of a ball end of which one is asked for."""
    if task.tolerance.least_lean == 0 or task.profile.flat_radius > 0:
        return None
    above = task.scallop + task.tolerance.gouge
    return least_lean((task.tips, task.axes, task.kind), task.profile, task.targets, (task.allowance, above))


def _lean_reasons(task: VerificationTask, lean: ContactLean | None) -> list[str]:
    least = task.tolerance.least_lean
    if lean is None or lean.angle >= least - UNCERTAINTY:
        return []
    return [f"the ball end leans {degrees(lean.angle):.2f} deg from the normal of face {lean.face} at "
            f"{spot(lean.point)}, needed {degrees(least):g} deg, on the {motion_of(task, lean.motion)}"]


def _find_step_over(task: VerificationTask, maps: tuple[SurfaceMap, ...]) -> PassDistance | None:
    """The greatest distance of neighbouring passes, declared zones aside, where one is asked for."""
    if task.greatest_step_over == 0:
        return None
    left = DeclaredZones(task.left, STRIP * (task.profile.flat_radius + task.profile.corner_radius))
    faces = [MeasuredFace(one.face, one.point[~one.declared], one.spacing, partial(left.holds, one.face))
             for one in maps]
    return greatest_distance((task.tips, task.axes, task.kind), task.profile, faces,
                             (task.allowance, task.tolerance.gouge),
                             task.greatest_step_over, partial(_may_stand, task))


def _may_stand(task: VerificationTask, tips: Array, axes: Array) -> bool:
    """Whether the tool could cut on a way: no less far from everything than it has to be, and a little more."""
    kind = np.full(len(tips), int(Motion.CUT), dtype=np.int8)
    skin = (*task.targets, *task.skin)
    rest = (*skin, *task.touching, *task.surroundings)
    cutter = cutter_solid(task.profile)
    asked = [("cutter", cutter, skin, task.allowance - _DEEP * task.tolerance.gouge),
             ("cutter", cutter, task.touching, -_DEEP * task.tolerance.gouge),
             ("cutter", cutter, task.surroundings, task.tolerance.cutter_clearance + _MORE)]
    asked += [(name, frustum_solids(outline, name), rest, _clearance_of(task, name) + _MORE)
              for name, outline in task.outlines.items()]
    asked += [("cutter", cutter, (face,), left + task.tolerance.cutter_clearance + _MORE)
              for face, left in task.left_on if left > task.allowance]
    return all(clearance((tips, axes, kind), (name, solids), faces, enough=max(need, 0.0)).distance >= need
               for name, solids, faces, need in asked if faces)


def _find_leads(task: VerificationTask) -> LeadCount | None:
    """What is seen of the arcs of lead-in and lead-out, where they are asked for."""
    if task.lead == 0:
        return None
    return check_leads((task.tips, task.axes, task.kind), task.profile, task.targets, task.allowance, task.lead)


def _step_over_reasons(task: VerificationTask, found: PassDistance | None) -> list[str]:
    most = task.greatest_step_over
    if found is None or found.distance <= STEP_OVER_FACTOR * most:
        return []
    return [f"passes lie {found.distance:.3f} mm apart, allowed {most:g} mm, on face {found.face} at "
            f"{spot(found.point)}"]


def _axis_text(axis: Array) -> str:
    return "(" + ", ".join(f"{float(x) + 0.0:.6f}" for x in axis) + ")"


def _scallop_reasons(task: VerificationTask, share: float, zones: tuple[MapZone, ...], area: float) -> list[str]:
    if share >= SHARE:
        return []
    aside = " that is not left as rest material" if task.left else ""
    text = (f"{100 * share:.2f} % of the area{aside} is within {FACTOR} times the scallop limit {task.scallop} mm, "
            f"{100 * SHARE:.2f} % must be")
    if zones:
        zone = zones[0]
        left = "never reached" if zone.reason == "not reached" else f"up to {zone.largest:.4f} mm high"
        text += (f"; the largest of {len(zones)} zones beyond it is on face {zone.face} from {spot(zone.low)} to "
                 f"{spot(zone.high)}, {zone.area:.2f} mm^2 of {area:.2f}, {left}")
    return [text]


def _gouge_reasons(task: VerificationTask, gouge: float, places: tuple[MapPoint, ...]) -> list[str]:
    if gouge <= task.tolerance.gouge:
        return []
    worst = places[0]
    deep = f"{gouge:.4f} mm" if gouge < task.depth else f"{gouge:.3f} mm or more"
    return [f"gouge {deep} at face {worst.face} {spot(worst.point)}, allowed {task.tolerance.gouge} mm, by the "
            f"{motion_of(task, worst.motion)}"]


def _machine_reasons(task: VerificationTask) -> list[str]:
    if task.machine is None:
        return []
    return machine_faults(task.machine, task.tips, task.axes, task.place, task.tool_length)


def _edge_reasons(task: VerificationTask, edge: Clearance) -> list[str]:
    if -edge.distance <= task.tolerance.gouge:
        return []
    return [f"gouge {-edge.distance:.4f} mm at face {edge.face} {spot(edge.point)} behind a convex edge, allowed "
            f"{task.tolerance.gouge} mm, by the {motion_of(task, edge.motion)}"]


def _link_reasons(task: VerificationTask, place: MapPoint | None) -> list[str]:
    if place is None:
        return []
    return [f"a {motion_of(task, place.motion)} goes {place.value:.4f} mm into what the passes leave on face "
            f"{place.face} at {spot(place.point)}: links must stay clear of it"]


def _reasons_of_held_side(task: VerificationTask) -> list[str]:
    """What is to be said of components that come too near to the held side."""
    if task.held is None:
        return []
    reasons = []
    components = {"cutter": cutter_solid(task.profile),
                  **{name: frustum_solids(outline, name) for name, outline in task.outlines.items()}}
    for name, solids in components.items():
        found = distance_to_held_side((task.tips, task.axes, task.kind), solids, task.held)
        need = _clearance_of(task, name)
        if found.distance < need:
            verb = f"is {found.distance:.4f} mm from" if found.distance >= 0 else (
                f"is {-found.distance:.4f} mm inside")
            reasons.append(f"{name} {verb} the clamped side, needed {need} mm, on the {motion_of(task, found.motion)}")
    return reasons


def _reasons_of_allowances(task: VerificationTask) -> list[str]:
    """What is to be said of components that go into what is left on other faces on purpose, or come too near to it."""
    reasons = []
    components = {"cutter": cutter_solid(task.profile),
                  **{name: frustum_solids(outline, name) for name, outline in task.outlines.items()}}
    for left in sorted({value for _, value in task.left_on}):
        faces = tuple(face for face, value in task.left_on if value == left)
        for name, solids in components.items():
            need = left - task.tolerance.gouge if name == "cutter" else left + _clearance_of(task, name)
            room = clearance((task.tips, task.axes, task.kind), (name, solids), faces, enough=need)
            if room.distance < min(need, FAR):
                reasons.append(f"{name} {_gap(room)} face {room.face} at {spot(room.point)}, on which {left:g} mm are "
                               f"left, needed {need:g} mm, on the {motion_of(task, room.motion)}")
    return reasons


def _stock_reasons(task: VerificationTask, rooms: dict[str, Clearance]) -> list[str]:
    reasons = []
    for name, room in rooms.items():
        need = task.stock + _clearance_of(task, name)
        if room.distance < min(need, FAR):
            reasons.append(f"{name} {_gap(room)} face {room.face} at {spot(room.point)}, on which {task.stock:g} mm of "
                           f"stock may stand, needed {need:g} mm, on the {motion_of(task, room.motion)}")
    return reasons


def _gap(room: Clearance) -> str:
    return f"is {room.distance:.4f} mm from" if room.distance >= 0 else f"is {-room.distance:.4f} mm inside"


def _room_reasons(task: VerificationTask, rooms: dict[str, Clearance | str]) -> list[str]:
    reasons = []
    for name, room in rooms.items():
        need = _clearance_of(task, name)
        if name in KINDS and isinstance(room, Clearance):
            reasons += meeting_reasons(task, name, room)
        elif isinstance(room, Clearance) and room.distance < min(need, FAR):
            reasons.append(f"{name} {_gap(room)} face {room.face} at {spot(room.point)}, needed {need} mm, on the "
                           f"{motion_of(task, room.motion)}")
    return reasons
