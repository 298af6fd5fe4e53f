"""Which faces can be seen in the 3D view: those of things that are shown, as far as nothing stands before them."""

from contextlib import suppress
from typing import NamedTuple

import numpy as np
from freecad.toolaxis.document.placement import chain_of
from freecad.toolaxis.document.read_shapes import number_in
from freecad.toolaxis.document.shape_cache import known_of

#: How coarse triangles may be, and how much nearer than a face something has to be to stand before it, in diagonals of
#: what is seen: faces that meet overlap by what triangles are off.
_COARSE, _BEFORE = 1e-3, 3e-3
#: Places of a face that are looked at, at most.
_PLACES = 60
#: Least distance before a camera that counts as before it, mm.
_NEAR = 1e-6


class Viewpoint(NamedTuple):
    """From where one looks.

    Attributes
    ----------
    rotation : (3, 3) array
        Rows: directions to the right, up, and towards the one who looks.
    eye : (3,) array or None
        Where the one who looks stands, mm; None where all lines of sight are parallel.
    """

    rotation: np.ndarray
    eye: np.ndarray | None = None

    def project(self, points):
        """Places on the screen and nearness, which grows towards the one who looks and is linear over a triangle.

        Parameters
        ----------
        points : (n, 3) array
            mm

        Returns
        -------
        (n, 3) array
            NaN for what lies behind the one who looks.
        """
        if self.eye is None:
            return points @ self.rotation.T
        turned = (points - self.eye) @ self.rotation.T
        far = np.where(-turned[:, 2] > _NEAR, -turned[:, 2], np.nan)
        return np.column_stack([turned[:, 0] / far, turned[:, 1] / far, 1.0 / far])

    def nearer(self, nearness, distance):
        """Nearness of what is nearer by a distance.

        Parameters
        ----------
        nearness : float
        distance : float
            mm
        """
        if self.eye is None:
            return nearness + distance
        left = 1.0 / nearness - distance
        return 1.0 / left if left > _NEAR else np.inf


class _Triangles(NamedTuple):
    """All that is in sight: corners on the screen with their nearness, (n, 3, 3), and the face that each is of."""

    corner: np.ndarray
    owner: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def may_hide(self, own):
        """Those of other faces that stand before some place of a face, or beside one; `own` are that face's rows."""
        low, high = self.low[own].min(axis=0), self.high[own].max(axis=0)
        near = ((self.low[:, 0] <= high[0]) & (self.low[:, 1] <= high[1]) & (self.high[:, 0] >= low[0])
                & (self.high[:, 1] >= low[1]) & (self.high[:, 2] >= low[2]))
        near[self.owner == self.owner[own[0]]] = False
        return _Triangles(*(each[near] for each in self))

    def is_before(self, place, nearness):
        """Whether a triangle stands before a place, nearer than so much."""
        x, y = place
        near = np.flatnonzero((self.low[:, 0] <= x) & (x <= self.high[:, 0]) & (self.low[:, 1] <= y)
                              & (y <= self.high[:, 1]) & (self.high[:, 2] > nearness))
        first, second, third = (self.corner[near, k] for k in range(3))
        along, across, out = second - first, third - first, np.array([x, y]) - first[:, :2]
        area = along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):  # a triangle that is seen from its edge hides nothing
            s = (out[:, 0] * across[:, 1] - out[:, 1] * across[:, 0]) / area
            t = (along[:, 0] * out[:, 1] - along[:, 1] * out[:, 0]) / area
            there = first[:, 2] + s * along[:, 2] + t * across[:, 2]
            return bool(((s >= 0) & (t >= 0) & (s + t <= 1) & (there > nearness)).any())


class SightScene(NamedTuple):
    """What may be seen, apart from the document: for any thread.

    owners : of the faces that are asked for the number through all shapes, -1 where its thing is hidden;  corner :
    (n, 3, 3) of all triangles, mm;  owner : (n,) of each, the face that it is of, growing;  before : how much nearer
    something has to be to stand before a face, mm.
    """

    owners: tuple
    corner: np.ndarray
    owner: np.ndarray
    before: float

    def hidden(self, camera, progress=None):
        """Places among the faces of those that cannot be seen.

        Parameters
        ----------
        camera : Viewpoint
        progress : toolaxis.progress.Progress, optional
            Asked whether to stop.

        Returns
        -------
        list of int
        """
        turned = camera.project(self.corner.reshape(-1, 3)).reshape(-1, 3, 3)
        there = np.isfinite(turned).all(axis=(1, 2))
        corner, owner = turned[there], self.owner[there]
        seen, found = _Triangles(corner, owner, corner.min(axis=1), corner.max(axis=1)), []
        for k, number in enumerate(self.owners):
            if progress is not None:
                progress.check()
            own = np.arange(*np.searchsorted(owner, [number, number + 1]))
            if number < 0 or not _is_seen(seen, own, camera, self.before):
                found.append(k)
        return found


def scene_of(faces, beside):
    """The triangles of faces and of what may stand before them, with those of things that are hidden left out.

    Parameters
    ----------
    faces : sequence of (object, "Face7")
    beside : sequence of App.DocumentObject
        What else may stand before them.

    Returns
    -------
    SightScene
    """
    from toolaxis.cad.freecad.documents import shape_of

    things = list(dict.fromkeys([*(thing for thing, _ in faces), *beside]))
    shapes = {thing: shape_of(thing) for thing in things if is_shown(thing)}
    first, count = {}, 0
    for thing, shape in shapes.items():
        first[thing], count = count, count + len(shape.Faces)
    owners = [first[thing] + number_in(thing, shapes[thing], name) - 1 if thing in shapes else -1
              for thing, name in faces]
    corner, owner = _triangles(list(shapes.values()))
    return SightScene(tuple(owners), corner, owner, _BEFORE * _diagonal(shapes.values()))


def is_shown(thing):
    """Whether an object and all that carries it are shown.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return all(one.Visibility for one in {thing, *chain_of(thing)})


def _diagonal(shapes):
    """Diagonal of the box around some shapes, mm."""
    boxes = [shape.BoundBox for shape in shapes]
    if not boxes:
        return 0.0
    low = np.min([(box.XMin, box.YMin, box.ZMin) for box in boxes], axis=0)
    return float(np.linalg.norm(np.max([(box.XMax, box.YMax, box.ZMax) for box in boxes], axis=0) - low))


def _triangles(shapes):
    """All faces of some shapes as triangles, (n, 3, 3) mm, and the number of the face of each through all shapes."""
    coarse = max(_COARSE * _diagonal(shapes), _NEAR)
    rows = [one for shape in shapes for one in _triangles_of(shape, coarse)]
    owner = np.repeat(np.arange(len(rows)), [len(one) for one in rows])
    return np.concatenate([np.empty((0, 3, 3)), *rows]), owner


def _triangles_of(shape, coarse):
    """Triangles of each face of a shape, (n, 3, 3) mm; kept, since a view is turned many times."""
    known = known_of(shape)
    before, rows = known.get("triangles", (0.0, None))
    if not coarse / 2 < before < 2 * coarse:  # boxes change a little once there are triangles
        rows = [_triangles_of_face(face, coarse) for face in shape.Faces]
        known["triangles"] = coarse, rows
    return rows


def _triangles_of_face(face, coarse):
    with suppress(Exception):  # a face without triangles is not drawn either
        points, triangles = face.tessellate(coarse)
        rows = np.array(triangles, dtype=int).reshape(-1, 3)
        return np.array([tuple(point) for point in points]).reshape(-1, 3)[rows]
    return np.empty((0, 3, 3))


def _is_seen(seen, own, camera, before):
    """Whether one of the middles of a face's triangles has nothing of another face before it."""
    if not len(own):
        return False
    others, step = seen.may_hide(own), max(len(own) // _PLACES, 1)
    for middle in seen.corner[own[::step]].mean(axis=1):
        if not others.is_before(middle[:2], camera.nearer(middle[2], before)):
            return True
    return False
