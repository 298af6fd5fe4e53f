"""Which faces can be seen in the 3D view: those of things that are shown, as far as nothing stands before them."""

from contextlib import suppress
from typing import NamedTuple

import numpy as np
from freecad.toolaxis.document.placement import chain_of
from freecad.toolaxis.document.read_shapes import number_in

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

    def is_before(self, place, nearness, owner):
        """Whether a triangle of another face stands before a place, nearer than so much."""
        x, y = place
        near = np.flatnonzero((self.low[:, 0] <= x) & (x <= self.high[:, 0]) & (self.low[:, 1] <= y)
                              & (y <= self.high[:, 1]) & (self.high[:, 2] > nearness) & (self.owner != owner))
        first, second, third = (self.corner[near, k] for k in range(3))
        along, across, out = second - first, third - first, np.array([x, y]) - first[:, :2]
        area = along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):  # a triangle that is seen from its edge hides nothing
            s = (out[:, 0] * across[:, 1] - out[:, 1] * across[:, 0]) / area
            t = (along[:, 0] * out[:, 1] - along[:, 1] * out[:, 0]) / area
            there = first[:, 2] + s * along[:, 2] + t * across[:, 2]
            return bool(((s >= 0) & (t >= 0) & (s + t <= 1) & (there > nearness)).any())


def hidden_faces(faces, beside, camera):
    """Those of some faces that cannot be seen: of a thing that is hidden, or with something else before all of them.

    Parameters
    ----------
    faces : sequence of (object, "Face7")
    beside : sequence of App.DocumentObject
        What else may stand before them.
    camera : Viewpoint

    Returns
    -------
    list of (object, str)
    """
    from toolaxis.cad.freecad.documents import shape_of

    things = list(dict.fromkeys([*(thing for thing, _ in faces), *beside]))
    shapes = {thing: shape_of(thing) for thing in things if is_shown(thing)}
    seen, numbers = _triangles(list(shapes.values()), camera)
    first, count = {}, 0
    for thing, shape in shapes.items():
        first[thing], count = count, count + len(shape.Faces)
    whole = _diagonal(shapes.values())
    hidden = []
    for thing, name in faces:
        shape = shapes.get(thing)
        if shape is None:
            hidden.append((thing, name))
            continue
        owner = first[thing] + number_in(thing, shape, name) - 1
        if not _is_seen(seen, numbers.get(owner, ()), owner, camera, _BEFORE * whole):
            hidden.append((thing, name))
    return hidden


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


def _triangles(shapes, camera):
    """All faces of some shapes as triangles, and the triangles of each, by its number through all shapes."""
    size, corners, owners, of, number = _diagonal(shapes), [np.empty((0, 3, 3))], [], {}, 0
    for face in (face for shape in shapes for face in shape.Faces):
        with suppress(Exception):  # a face without triangles is not drawn either
            points, triangles = face.tessellate(max(_COARSE * size, _NEAR))
            rows = np.array(triangles, dtype=int).reshape(-1, 3)
            turned = camera.project(np.array([tuple(point) for point in points]).reshape(-1, 3))[rows]
            turned = turned[np.isfinite(turned).all(axis=(1, 2))]
            of[number] = np.arange(len(owners), len(owners) + len(turned))
            corners.append(turned)
            owners += [number] * len(turned)
        number += 1
    corner = np.concatenate(corners)
    return _Triangles(corner, np.array(owners, dtype=int), corner.min(axis=1), corner.max(axis=1)), of


def _is_seen(seen, own, owner, camera, before):
    """Whether one of the middles of a face's triangles has nothing of another face before it."""
    if not len(own):
        return False
    step = max(len(own) // _PLACES, 1)
    for middle in seen.corner[own[::step]].mean(axis=1):
        if not seen.is_before(middle[:2], camera.nearer(middle[2], before), owner):
            return True
    return False
