"""Faces divided into sub-surfaces as a plan asks for it: each by itself, or so that they share few axes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from toolaxis.errors import Cancelled, ToolAxisError, fault, piece_of
from toolaxis.job.planning.failures import refuse_face
from toolaxis.job.planning.parallel import abreast
from toolaxis.job.planning.sub_surfaces import Target, by_axis, lost_face
from toolaxis.partition.bosses import distances
from toolaxis.partition.face_division import MOST, Divider, Regions
from toolaxis.partition.partition import check_count
from toolaxis.partition.partition import regions as regions_of
from toolaxis.partition.shared_axes import divide_with_shared_axes, trade
from toolaxis.plan.plan import Option
from toolaxis.progress import Progress
from toolaxis.search.face_problem import FaceProblem
from toolaxis.shape.face import Face
from toolaxis.shape.measure import mean_width
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool


@dataclass(frozen=True, eq=False)
class AskedDivision:
    """How the faces of a plan are divided.

    Attributes
    ----------
    part : Part
    obstacles : tuple of Face
        Of further bodies.
    tool : Tool
    task : callable
        Takes a face and progress, and returns what decides about an axis for it.
    regions, orientations : int, "auto" or None
        As `toolaxis.plan` takes them.
    workers : int
        Processes to work with.
    """

    part: Part
    obstacles: tuple[Face, ...]
    tool: Tool
    task: Callable[[Face, Progress], FaceProblem]
    regions: int | str | None
    orientations: int | str | None
    workers: int

    def divide(self, faces: Sequence[Face], progress: Progress) -> tuple[list[Target], tuple[Option, ...]]:
        """Sub-surfaces of faces, and the numbers of axes to choose from where axes are shared.

        Parameters
        ----------
        faces : sequence of Face
        progress : Progress

        Raises
        ------
        Cancelled
        """
        if not faces:
            return [], ()
        return self._sharing(faces, progress) if self.orientations else (self._divided(faces, progress), ())

    def _divided(self, faces: Sequence[Face], progress: Progress) -> list[Target]:
        """Sub-surfaces of each face by itself; a number of them is not asked of faces narrower than the cutter."""
        if self.regions in (None, 1):  # one is the face itself: what pieces of it would cost need not be reckoned
            return [Target(face) for face in faces]

        def _division(k: int, inner: Progress) -> Regions | ToolAxisError:
            named = inner.within(f"face {faces[k].label}")
            standing = distances(faces[k], self.tool, self.part, self.obstacles)
            count = "auto" if mean_width(faces[k]) < 2 * self.tool.radius else self.regions
            try:
                return regions_of(self.task(faces[k], inner), count, progress=named, bosses=standing)
            except Cancelled:
                raise
            except ToolAxisError as reason:
                return reason

        found = abreast(_division, len(faces), self.workers, progress)
        if found.cancelled:
            raise Cancelled("cancelled by the user")
        refused = [one for one in found.results.values() if isinstance(one, ToolAxisError)]
        if len(refused) == len(faces):
            raise refused[0]
        targets: list[Target] = []
        for k, face in enumerate(faces):
            one = found.results.get(k)
            if one is None:
                targets.append(lost_face(face, self.tool, found.faults[k]))
            elif isinstance(one, ToolAxisError):  # this face cannot be divided so; the others can
                targets.append(Target(face, ended=refuse_face(1, face, self.tool, one)))
            else:
                targets += [Target(piece, axis) for piece, axis in zip_longest(one.faces, one.axes)]
        return targets

    def _sharing(self, faces: Sequence[Face], progress: Progress) -> tuple[list[Target], tuple[Option, ...]]:
        """Sub-surfaces of all faces with the few axes that they share, and the numbers of axes to choose from.

        A face for which no division was found stays whole with an axis of its own, unless that is so of all.
        """
        most = MOST if self.regions is None else check_count(self.regions) or MOST
        every: list[Divider] = []
        ended: list[Target] = []
        for face in faces:
            try:
                one = Divider(self.task(face, progress), most=most, progress=progress.within(f"face {face.label}"))
                _ = one.best
                every.append(one)
            except ToolAxisError:  # Cancelled among them
                raise
            except Exception as reason:
                ended.append(lost_face(face, self.tool, fault(reason)))
        dividers = [one for one in every if len(one.best.known)] or every
        ended += [Target(one.job.worth.face) for one in every if one not in dividers]
        while dividers:
            try:
                targets, options = self._in_common(dividers, progress)
                return targets + ended, options
            except ToolAxisError:
                raise
            except Exception as reason:
                left = end_failed([Target(one.job.worth.face) for one in dividers], self.tool, reason)
                ended += [target for target in left if target.ended is not None]
                dividers = [one for one, target in zip(dividers, left, strict=True) if target.ended is None]
        return ended, ()

    def _in_common(self, dividers: list[Divider], progress: Progress) -> tuple[list[Target], tuple[Option, ...]]:
        """Sub-surfaces of faces with the few axes that they share, and the numbers of axes to choose from."""
        options: tuple[Option, ...] = ()
        count = check_count(self.orientations, "orientations")
        if count is None:
            found, knee = trade(dividers, progress=progress)
            options = tuple(Option(one.orientations, one.pieces, one.length, k == knee, one.seconds)
                            for k, one in enumerate(found))
            chosen = found[knee]
        else:
            chosen = divide_with_shared_axes(dividers, count, progress=progress)
        axes = np.unique(np.concatenate([one.axes for one in chosen.regions]), axis=0)
        rows = [(piece, axis) for one in chosen.regions for piece, axis in zip(one.faces, one.axes, strict=True)]
        return by_axis([Target(piece, axis, True, tuple(other for other in axes if (other != axis).any()))
                        for piece, axis in rows]), options


def end_failed(targets: list[Target], tool: Tool, reason: Exception) -> list[Target]:
    """Targets, that one ended on which the program failed; all of them where nobody knows which it was.

    Parameters
    ----------
    targets : list of Target
    tool : Tool
    reason : Exception
    """
    why, piece = fault(reason), piece_of(reason)
    guilty = {target.face.label for target in targets if target.face.label == piece} or {
        target.face.label for target in targets}
    return [lost_face(target.face, tool, why) if target.ended is None and target.face.label in guilty else target
            for target in targets]
