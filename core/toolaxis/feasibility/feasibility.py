"""Which axes may be used: limits, visibility, a contact that stays in front, no gouge, no collision.

Screening looks at a few contacts and may only err towards "free"; proving looks at dense contacts with bounds of
normals between them, and at last at every motion of the passes really made.

A contact at which the cutter would come too near to a wall that is less than one cutter diameter away, or gouge a face
that continues the machined one, is left as rest material; anything else that is in the way forbids the axis, but at
few places that are given.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import pi, radians

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.clearance.queries import lower_bounds, motions
from toolaxis.contact.placement import tips
from toolaxis.feasibility.check_points import CheckPoints, around, contacts_at
from toolaxis.feasibility.interference import COARSE, InterferenceScene, stands_free, trouble_at
from toolaxis.feasibility.left_places import NOTHING_LEFT, LeftPlaces
from toolaxis.feasibility.normal_cone import NormalField
from toolaxis.feasibility.point_check import deepest
from toolaxis.feasibility.surroundings import OTHER, ROLES, SKIN, CheckSurfaces
from toolaxis.feasibility.violations import (
    BACK,
    CUTTER,
    FREE,
    GOUGE,
    LIMITS,
    WANDERS,
    ScreeningResult,
    Violation,
    Violations,
)
from toolaxis.machine.limits import AxisLimits, refusal
from toolaxis.numeric.rounding import round_significant
from toolaxis.numeric.vectors import angle_between, as_rows, unit
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: An axis that leaves more than this share of the contacts to a clean-up tool is none.
MOST_LEFT = 0.9
#: How much more than the least lean a ball end keeps whose axis moves, rad.
LEAN_MARGIN = radians(0.1)
_DENSE = 32


@dataclass(frozen=True, eq=False)
class Feasibility:
    """What an axis must satisfy for one face, tool and surroundings.

    Attributes
    ----------
    face : Face
    tool : Tool
    groups : tuple of CheckSurfaces
        From `toolaxis.feasibility.surroundings.group_surroundings`.
    tolerance : Tolerance
    limits : AxisLimits or None
    allowance : float
        Stock left on the face, mm.
    watched : (n, 2) array
        Parameters of contacts that screening looks at besides its own.
    learnt : (m, 3) array
        Points of the skin that screening holds against axes besides its own.
    left : LeftPlaces
        Near them nothing that is in the way forbids an axis: what is is cut out of the passes.
    """

    face: Face
    tool: Tool
    groups: tuple[CheckSurfaces, ...]
    tolerance: Tolerance
    limits: AxisLimits | None = None
    allowance: float = 0.0
    watched: Array | None = None
    learnt: Array = field(default_factory=lambda: np.empty((0, 3)))
    left: LeftPlaces = NOTHING_LEFT

    @cached_property
    def normals(self) -> NormalField:
        """Normals of the face."""
        return NormalField(self.face)

    @property
    def greatest_angle(self) -> float:
        """Greatest angle between axis and normal for which the contact lies on the cutter's bottom or arc, rad."""
        return pi / 2 - self.tool.half_angle

    @property
    def least_angle(self) -> float:
        """Least angle between axis and normal, rad: 0 for a ball end of which no lean is asked for."""
        return self.tolerance.least_angle(self.tool.flat_radius)

    @property
    def least_angle_in_motion(self) -> float:
        """Least angle for an axis that moves, rad: that of a ball end is kept between the points of a pass too."""
        leans = self.tool.flat_radius == 0 and self.least_angle > 0
        return self.least_angle + LEAN_MARGIN if leans else self.least_angle

    def watching(self, uv: ArrayLike) -> "Feasibility":
        """The same with more contacts looked at in screening.

        Parameters
        ----------
        uv : (n, 2) array_like
        """
        rows = as_rows(uv, 2, "uv")
        new = self._with(("normals", "dense", "cloud"),
                         watched=rows if self.watched is None else np.concatenate([self.watched, rows]))
        if "sparse" in self.__dict__:
            more = zip(self.sparse, self.contacts(rows, 0), strict=True)
            new.__dict__["sparse"] = CheckPoints(*(np.concatenate(both) for both in more))
        return new

    def learning(self, points: Array) -> "Feasibility":
        """The same with more points of the skin held against axes in screening.

        Parameters
        ----------
        points : (m, 3) array
            mm
        """
        return self._with(("normals", "dense", "cloud", "sparse"), learnt=np.concatenate([self.learnt, points]))

    def _with(self, kept: tuple[str, ...], **changes: Array) -> "Feasibility":
        new: Feasibility = replace(self, **changes)  # type: ignore[arg-type]
        new.__dict__.update({name: self.__dict__[name] for name in kept if name in self.__dict__})
        return new

    @cached_property
    def sparse(self) -> CheckPoints:
        """Contacts for screening: a coarse grid, points along the border, and the most concave places."""
        grid = self.face.grid(5, 5)
        rows = [grid, self.corners, around(self.face, 24)]
        return self.contacts(np.concatenate([*rows, self.watched] if self.watched is not None else rows), len(grid))

    @cached_property
    def dense(self) -> CheckPoints:
        """Contacts for proving: a fine grid, and points along the border."""
        grid = self.face.grid(_DENSE, _DENSE)
        return self.contacts(np.concatenate([grid, around(self.face, 6 * _DENSE)]), len(grid))

    @cached_property
    def corners(self) -> Array:
        """Parameters of the most concave places, (6, 2)."""
        fine = self.face.grid(24, 24)
        return fine[np.argsort(-round_significant(self.face.curvature(fine).k1), kind="stable")[:6]]

    def contacts(self, uv: Array, weighed: int) -> CheckPoints:
        """Contacts of the face, those near places aside that are left.

        Parameters
        ----------
        uv : (n, 2) array
        weighed : int
            How many of the first ones are an even grid, for which the area counts.
        """
        reach = 2 * self.tool.radius + self.tolerance.cutter_clearance
        every = contacts_at(self.face, uv, weighed, self.walls, reach)
        if not len(self.left.points):
            return every
        kept = ~self.left.near(every.point)
        return CheckPoints(every.uv[kept], every.point[kept], every.normal[kept], every.share[kept], every.near[kept])

    @cached_property
    def neighbours(self) -> tuple[Face, ...]:
        """Faces that continue this one: smooth to touch, but too narrow for the cutter where they are hollow."""
        return tuple(face for face in self.groups[0].faces
                     if self.groups[0].role == SKIN and face.number not in self.face.numbers)

    @cached_property
    def _scene(self) -> InterferenceScene:
        return InterferenceScene(self.face.numbers, self.tool, self.groups, self.neighbours)

    @property
    def walls(self) -> tuple[Face, ...]:
        """For what contacts beside it may be left as rest material: walls and obstacles, then the neighbours."""
        others = tuple(face for group in self.groups if group.role == OTHER for face in group.faces)
        return others + self.neighbours

    def screen(self, axes: ArrayLike) -> ScreeningResult:
        """Verdicts on axes from a few contacts: cheap, and wrong only towards "free".

        Parameters
        ----------
        axes : (k, 3) array_like
        """
        rows = unit(as_rows(axes, 3, "axes"))
        reason, amount = self.quick(rows)
        unreached = np.zeros(len(rows))
        some = self.sparse
        for i in np.flatnonzero(reason == FREE):
            depth = self.depth(rows[i], np.concatenate([self.cloud, self.learnt])) - self.tolerance.gouge
            if depth > 0:
                reason[i], amount[i] = GOUGE, depth
            else:
                reason[i], amount[i], unreached[i] = self.stand(rows[i], some, thorough=False)
        return ScreeningResult(reason, amount, unreached)

    def depth(self, axis: Array, points: Array) -> float:
        """How deep the cutter reaches below points of the skin at the screening contacts, mm.

        Parameters
        ----------
        axis : (3,) array
        points : (m, 3) array
        """
        some = self.sparse
        return deepest(self.tool, axis, tips(some.point, some.normal, axis, self.tool, self.allowance), points)

    @cached_property
    def cloud(self) -> Array:
        """Points of the face that surely gouging axes run into, (m, 3); those of its neighbours can be kept off."""
        return np.concatenate([self._points(face) for face in self.groups[0].faces
                               if face.number in self.face.numbers] or [np.empty((0, 3))])

    def _points(self, face: Face) -> Array:
        count = max(6, 24 // len(self.groups[0].faces))
        return face.evaluate(np.concatenate([face.grid(count, count), around(face, 3 * count)])).point

    def quick(self, rows: Array) -> tuple[NDArray[np.int8], Array]:
        """Reason and amount (rad) of axes by limits and sampled normals alone.

        Parameters
        ----------
        rows : (k, 3) array
            Unit vectors.
        """
        least, greatest = self.normals.angles(rows)
        if self.watched is not None:
            angle = angle_between(rows[:, None], self.face.normal(self.watched)[None])
            least = np.minimum(least, angle.min(axis=1))
            greatest = np.maximum(greatest, angle.max(axis=1))
        none = np.zeros(len(rows))
        excess = none
        outside = np.zeros(len(rows), dtype=bool)
        if self.limits is not None:
            excess = self.limits.excess(rows)
            outside = ~self.limits.allowed(rows)
        back = greatest - self.greatest_angle
        wanders = self.least_angle - least
        reason = np.select([outside, back > 0, wanders > 0], [LIMITS, BACK, WANDERS], FREE).astype(np.int8)
        return reason, np.choose(reason, [none, excess, back, wanders])

    def stand(self, axis: Array, contacts: CheckPoints, thorough: bool = True) -> tuple[int, float, float]:
        """Reason, amount (mm) and unreached share of one axis at contacts.

        Parameters
        ----------
        axis : (3,) array
        contacts : CheckPoints
        thorough : bool
            Whether gouges of the skin are looked for too.
        """
        return self.verdict(self.trouble(axis, contacts, thorough), contacts)

    def verdict(self, trouble: Violations, contacts: CheckPoints) -> tuple[int, float, float]:
        """Reason, amount and unreached share that follow from what is worst at each contact.

        Parameters
        ----------
        trouble : Violations
        contacts : CheckPoints
        """
        left = trouble.wall & (trouble.reason != FREE)
        bad = (trouble.reason != FREE) & ~left
        unreached = float(round_significant(contacts.share[left].sum()))
        if not bad.any() and ((left | (contacts.share == 0)).all() or unreached > MOST_LEFT):
            bad = left
        if not bad.any():
            return FREE, 0.0, unreached
        i = int(np.argmax(np.where(bad, round_significant(trouble.amount), -np.inf)))
        return int(trouble.reason[i]), float(trouble.amount[i]), unreached

    def trouble(self, axis: Array, contacts: CheckPoints, thorough: bool = True,
                roles: tuple[str, ...] = ROLES) -> Violations:
        """What is worst at each contact.

        Parameters
        ----------
        axis : (3,) array
        contacts : CheckPoints
        thorough : bool
            Whether gouges of the skin are looked for too.
        roles : tuple of str
            Groups that are looked at.
        """
        places = tips(contacts.point, contacts.normal, axis, self.tool, self.allowance)
        return trouble_at(self._scene, places, axis, contacts.near, (thorough, roles))

    def witness(self, axis: ArrayLike) -> Violation | None:
        """The proof form: what forbids an axis, at dense contacts and with bounds of the normals between them.

        Parameters
        ----------
        axis : (3,) array_like

        Returns
        -------
        Witness of the first constraint that fails, or None when all hold.
        """
        t = unit(as_rows(axis, 3, "axis")[0])
        if self.limits is not None and not self.limits.allowed(t)[0]:
            return Violation(LIMITS, float(self.limits.excess(t)[0]), words=refusal(self.limits, t))
        return self.turned_away(t) or self.worst(t, self.dense)

    def screened(self, axis: Array) -> Violation | None:
        """What screening has against an axis, at its own contacts; None where it has nothing, or knows no place.

        Parameters
        ----------
        axis : (3,) array
        """
        some = self.sparse
        trouble = self.trouble(axis, some)
        hit = trouble.reason != FREE
        bad = hit & ~trouble.wall
        return self.witness_of(trouble, bad if bad.any() else hit, some.uv)

    def turned_away(self, axis: Array) -> Violation | None:
        """What the angles between an axis and all normals forbid, proven between samples too, or None.

        Parameters
        ----------
        axis : (3,) array
        """
        spread = self.normals.range_of_angles(axis, self.least_angle, self.greatest_angle)
        for code, amount, uv in ((BACK, spread.high - self.greatest_angle, spread.greatest),
                                 (WANDERS, self.least_angle - spread.low, spread.least)):
            if amount > 1e-9:
                return Violation(code, float(amount), "", self.face.evaluate(uv[None]).point[0], uv)
        return None

    def worst(self, axis: Array, contacts: CheckPoints) -> Violation | None:
        """The worst contact of those that forbid an axis, or None.

        Parameters
        ----------
        axis : (3,) array
        contacts : CheckPoints
        """
        trouble = self.trouble(axis, contacts)
        bad = (trouble.reason != FREE) & ~trouble.wall
        if not bad.any() and ((trouble.reason != FREE) | (contacts.share == 0)).all():
            bad = trouble.reason != FREE
        return self.witness_of(trouble, bad, contacts.uv)

    def witness_of(self, trouble: Violations, bad: Bools, uv: Array) -> Violation | None:
        """The worst of the rows marked bad, or None.

        Parameters
        ----------
        trouble : Violations
        bad : (n,) array of bool
        uv : (n, 2) array
        """
        if not bad.any():
            return None
        i = int(np.argmax(np.where(bad, round_significant(trouble.amount), -np.inf)))
        group, amount = self.groups[int(trouble.group[i])], float(trouble.amount[i])
        label = group.faces[int(trouble.face[i])].label if trouble.face[i] >= 0 else ""
        distance = float(group.required[max(int(trouble.reason[i]) - CUTTER, 0)]) - amount
        return Violation(int(trouble.reason[i]), amount, label, trouble.point[i], uv[i], distance)

    def unreached(self, axis: ArrayLike) -> float:
        """Share of the area that is left as rest material, from the dense contacts.

        Parameters
        ----------
        axis : (3,) array_like
        """
        if not self.walls:
            return 0.0
        return self.stand(unit(as_rows(axis, 3, "axis")[0]), self.dense)[2]

    def reach(self, uv: ArrayLike, axis: ArrayLike, itself: bool = False) -> Bools:
        """Whether the tool may stand at contacts, on the face or beyond its border.

        Parameters
        ----------
        uv : (n, 2) array_like
        axis : (3,) array_like
        itself : bool
            Whether contacts on the face are held against the face itself and everything else too, as it is right where
            it is not known that the axis is free there.

        Returns
        -------
        (n,) bool; what is False is cut out of passes.

        Notes
        -----
        Contacts on the face are looked at for walls, obstacles and faces that continue it: for all else a free axis is
        free there, but near places that are left.
        """
        rows, t = as_rows(uv, 2, "uv"), unit(as_rows(axis, 3, "axis")[0])
        at = self.face.evaluate(rows)
        normal, point = self.face.normal(rows, at), at.point
        angle = angle_between(np.broadcast_to(t, normal.shape), normal)
        good = (angle >= self.least_angle) & (angle <= self.greatest_angle)
        inside = self.face.contains(rows)
        within = ROLES if self.neighbours else (OTHER,)
        on_the_face = (True, ROLES) if itself else (False, within)
        near = np.zeros_like(inside) if itself else inside & self.left.near(point)
        for part, asked in ((good & inside & ~near, on_the_face), (good & (near | ~inside), (True, ROLES))):
            if part.any() and any(group.role in asked[1] for group in self.groups):
                good[part] = stands_free(self._scene, tips(point[part], normal[part], t, self.tool, self.allowance),
                                         t, asked)
        return np.asarray(good)

    def room(self, axis: ArrayLike, most: float = 10.0) -> float:
        """How much more clearance than required an axis leaves at the screening contacts, mm, at most `most`.

        Parameters
        ----------
        axis : (3,) array_like
        most : float
            mm
        """
        t, some, least = unit(as_rows(axis, 3, "axis")[0]), self.sparse, most
        moves = motions(tips(some.point, some.normal, t, self.tool, self.allowance), t)
        for group in self.groups:
            if group.role != OTHER and not self.tool.outlines:
                continue
            left_out = None if group.role == OTHER else np.tile([-np.inf, 0.0, 0.0], (len(group.faces), 1))
            found = lower_bounds(group.cells, self.tool, moves, group.required + most, 10 * COARSE, left_out)
            least = min(least, float((found.lower - group.required).min()))
        return least
