"""How far cutter, shank and holder stay from everything else: a lower bound that holds between all points."""

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, motions, segment_motions
from toolaxis.contact.clearance.surroundings import IGNORED, Surroundings
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import axis_rows
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.part import Part
from toolaxis.tools.solid import COMPONENTS
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

RESOLUTION = 0.001
CUTOFF = 10.0


Obstacles: TypeAlias = Part | Face | Sequence[Face] | None


class Clearances(NamedTuple):
    """Lower bounds for n positions or motions, by component.

    distance : (n, 3) signed distance of cutter, shank and holder, mm; negative where they collide, and there at least
    as deep as the deepest point lies in one convex piece of the tool; the cutoff where nothing is nearer or where the
    component is not known;
    face : (n, 3) index of the nearest face in the surroundings, -1 where nothing is nearer than the cutoff;
    place : (n, 3, 3) a point near the nearest place of that face, mm;
    checked : names of the components that are known and that some face asks for.
    """

    distance: Array
    face: Indices
    place: Array
    checked: tuple[str, ...]


class ClearanceFlags(NamedTuple):
    """Whether n positions or motions keep all required distances.

    safe : (n,) True is proven;
    component : (n,) which of cutter (0), shank (1) and holder (2) was found or feared to be too near, -1 where safe;
    face : (n,) index of the face that it was too near to, -1 where safe or not known.
    """

    safe: NDArray[np.bool_]
    component: Indices
    face: Indices


def clearance(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, obstacles: Obstacles, *,
              allowance: float = 0.0) -> Array:
    """Lower bound of the distance between the whole tool and obstacles, for contacts of a face.

    Parameters
    ----------
    face : Face
    tool : Tool
    uv : (n, 2) array_like
        Parameters of the contacts.
    axis : (3,) or (n, 3) array_like
        Tool axis, tip to spindle, of any length.
    obstacles : Part, Face, sequence of Face, or None
        The machined face itself (where the part is the face's own: its whole skin) is left out for the cutter, not for
        shank and holder.
    allowance : float
        Stock left on the face, mm.

    Returns
    -------
    (n,) array, mm: negative in collision; `CUTOFF` where nothing is nearer.  At most `RESOLUTION` (and the faces'
    tolerance) below the true distance; in collision it counts how deep the obstacle reaches into one convex piece of
    the tool (the cutter, one frustum of shank or holder), to a twentieth beyond 0.1 mm.

    Notes
    -----
    **Properties**: 1. never above the distance of any point of an obstacle; 2. moves with the part; 3. more obstacles
    never enlarge it.
    """
    tips = place(face, tool, uv, axis, allowance)
    faces = _faces_of(obstacles)
    skin = (face, *obstacles.skin(face.number)) if _is_own(obstacles, face) else (face,)
    found = clearances(tool, tips, axis_rows(axis, len(tips)), Surroundings.of(faces, skin=skin))
    return np.asarray(found.distance.min(axis=1))


def _faces_of(obstacles: Obstacles) -> tuple[Face, ...]:
    if obstacles is None:
        return ()
    if isinstance(obstacles, Face):
        return (obstacles,)
    faces = obstacles.faces if isinstance(obstacles, Part) else obstacles
    if isinstance(faces, Sequence) and all(isinstance(one, Face) for one in faces):
        return tuple(faces)
    raise InvalidInput(f"obstacles are {type(obstacles).__name__}: give a part, a face or a sequence of faces "
                       "(toolaxis.load reads them from a file)")


def _is_own(obstacles: Obstacles, face: Face) -> TypeGuard[Part]:
    """Whether obstacles are the part that a face belongs to: numbers alone do not tell, each part has a face 1."""
    if not isinstance(obstacles, Part):
        return False
    named = next((one for one in obstacles.faces if one.number == face.number), None)
    if named is None or named.surface is face.surface:
        return named is not None
    points = face.evaluate(np.vstack([face.grid(5, 5), *face.outline])).point
    return bool(nearest(named, points).distance.max() <= 1e-6 * face.diagonal + face.tolerance)


def clearances(tool: Tool, tips: ArrayLike, axis: ArrayLike, around: Surroundings, cutoff: float = CUTOFF,
               *, resolution: float = RESOLUTION) -> Clearances:
    """Lower bounds of the distances of cutter, shank and holder, for tool tips.

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n, 3) array_like
        Unit tool axis, tip to spindle.
    around : Surroundings
        Of its required distances only -inf counts here: these pairs are left out.
    cutoff : float
        Greater distances are answered with this, mm.
    resolution : float
        How far a bound may lie below the true distance, mm.
    """
    return _distances(tool, motions(tips, axis), around, (cutoff, resolution))


def segment_clearances(tool: Tool, tips: ArrayLike, axis: ArrayLike, around: Surroundings, cutoff: float = CUTOFF,
                       *, resolution: float = RESOLUTION) -> Clearances:
    """Lower bounds of the distances on the straight motions from each tip to the next, n - 1 rows.

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n - 1, 3) array_like
        Unit tool axis.
    around : Surroundings
        Of its required distances only -inf counts here: these pairs are left out.
    cutoff : float
        Greater distances are answered with this, mm.
    resolution : float
        How far a bound may lie below the true distance, mm.
    """
    return _distances(tool, segment_motions(tips, axis), around, (cutoff, resolution))


def clears(tool: Tool, tips: ArrayLike, axis: ArrayLike, around: Surroundings) -> ClearanceFlags:
    """Whether every component keeps its required distance from every face, for tool tips.

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n, 3) array_like
        Unit tool axis, tip to spindle.
    around : Surroundings
    """
    return _verdicts(tool, motions(tips, axis), around)


def segment_clears(tool: Tool, tips: ArrayLike, axis: ArrayLike, around: Surroundings) -> ClearanceFlags:
    """Whether every component keeps its required distance on the motions from each tip to the next, n - 1 rows.

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n - 1, 3) array_like
        Unit tool axis.
    around : Surroundings
    """
    return _verdicts(tool, segment_motions(tips, axis), around)


def _known(tool: Tool) -> tuple[str, ...]:
    return tuple(name for name in COMPONENTS if name == "cutter" or name in tool.outlines)


def _distances(tool: Tool, moves: Array, around: Surroundings, how: tuple[float, float]) -> Clearances:
    n, (cutoff, resolution) = len(moves), how
    asked = np.asarray((around.required > IGNORED).any(axis=0))
    checked = tuple(name for name in _known(tool) if asked[COMPONENTS.index(name)])
    if not around.faces or not n:
        return Clearances(np.full((n, 3), cutoff), np.full((n, 3), -1), np.zeros((n, 3, 3)), checked)
    found = lower_bounds(around.cells, tool, moves, cutoff, resolution, around.required)
    return Clearances(found.lower, found.face, found.point, checked)


def _verdicts(tool: Tool, moves: Array, around: Surroundings) -> ClearanceFlags:
    count = len(moves)
    if not around.faces or not count:
        return ClearanceFlags(np.ones(count, dtype=bool), np.full(count, -1), np.full(count, -1))
    found = keeps_limits(around.cells, tool, moves, around.required)
    safe = np.asarray(found.blocked < 0)
    component = np.maximum(found.blocked, 0)
    met = np.take_along_axis(found.face, component[:, None], axis=1)[:, 0]
    return ClearanceFlags(safe, found.blocked, np.where(safe, -1, met))
