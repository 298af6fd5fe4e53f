"""What of the room around a part is material, on a grid: where it is not sure, a cell counts as none."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.regions.reach_kernel import ReachTree
from toolaxis.regions.solid_kernel import BITS, HELD, NEARLY, NO_BORDER, mark_borders
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Words = NDArray[np.uint64]

#: Cells of a grid at most, about, their least length, mm, and how many stand beyond the part on each side.
_MOST, _LEAST, _BEYOND = 6_000_000, 0.1, 2
#: Regions of fewer cells than these are not looked at; at how many places a region is asked for its side.
_FEWEST, _ASKED = 8, 7
#: Cosine to the normal of the nearest face that tells of a side, what is none, and rounding of distances, mm.
_TELLS, _NONE, _TIE = 0.3, 1e-3, 1e-6


#: How far at most a face is from any place of a cell that it is in, or that has an edge in common with such a cell, in
#: the length of a cell: from middle to middle, from both of these to their corners, and from there.
_AWAY = np.sqrt(2) + np.sqrt(3) + NEARLY


class SolidGrid(NamedTuple):
    """A part on a grid, as bits of cells; all beyond it is open.

    Each of three arrays has planes across x, y or z, words and rows: bits of the first lie along z and rows along y, of
    the second along x and z, of the third along y and x.
    """

    shape: tuple[int, int, int]
    """Cells each way."""
    origin: Array
    """Corner of the first cell, (3,) mm."""
    size: float
    """Length of a cell, mm."""
    open: tuple[Words, Words, Words]
    """Cells that are not known to be wholly material."""
    clear: tuple[Words, Words, Words]
    """Those of them that may be farther than `away` from all faces."""

    @property
    def away(self) -> float:
        """A line meets a face in a cell that is not clear where its tool is so thick around it, mm."""
        return float(_AWAY * self.size)


@dataclass(frozen=True, eq=False)
class PartSolid:
    """The material of a part.

    Attributes
    ----------
    bodies : tuple of tuple of Face
        The faces of each of its bodies that bounds a volume: others have no inside.
    tree : ReachTree
        Of these and of all that stands around them.
    """

    bodies: tuple[tuple[Face, ...], ...]
    tree: ReachTree

    @cached_property
    def grid(self) -> SolidGrid | None:
        """The material on a grid, made once; None where there is none.

        Notes
        -----
        **Property**: no place of a cell of material lies outside the part, and none is met by a face.
        """
        return _make_grid(self.bodies, self.tree) if self.bodies else None


def _make_grid(bodies: tuple[tuple[Face, ...], ...], tree: ReachTree) -> SolidGrid | None:
    own = [face for body in bodies for face in body]
    low = np.min([face.box[0] for face in own], axis=0)
    high = np.max([face.box[1] for face in own], axis=0)
    extent = high - low
    # A flat part has a volume too, so that its cells are not all too small.
    volume = np.prod(np.maximum(extent, 1e-3 * extent.max()))
    size = max(float(np.cbrt(volume / _MOST)), _LEAST)
    shape = np.ceil(extent / size).astype(int) + 2 * _BEYOND
    cells = np.full(shape, NO_BORDER, dtype=np.uint8)
    origin = low - _BEYOND * size
    leaves = np.flatnonzero(tree.link[:, 3] >= 0)
    mark_borders(tree, leaves, cells, origin, size)
    material = _material(bodies, cells, origin, size)
    if not material.any():
        return None
    return pack_grid(material, cells == HELD, origin, size)


def _material(bodies: tuple[tuple[Face, ...], ...], cells: NDArray[np.uint8], origin: Array, size: float) -> Bools:
    """Whether cells are material, (i, j, k): whole regions are that borders part from others."""
    from scipy.ndimage import find_objects, label

    regions, count = label(cells == NO_BORDER)
    sizes = np.bincount(regions.ravel(), minlength=count + 1)
    material = np.zeros(count + 1, dtype=bool)
    for region, box in enumerate(find_objects(regions), start=1):
        if sizes[region] >= _FEWEST and region != regions[0, 0, 0]:
            some = np.argwhere(regions[box] == region)
            some = some[np.linspace(0, len(some) - 1, _ASKED).astype(int)] + [side.start for side in box]
            # Where two bodies touch, the faces of the one are nothing to the other.
            material[region] = any(_is_material(body, origin + (some + 0.5) * size) for body in bodies)
    return np.asarray(material[regions])


def pack_grid(material: Bools, held: Bools, origin: Array, size: float) -> SolidGrid:
    """A grid of cells.

    Parameters
    ----------
    material, held : (i, j, k) arrays of bool
        Which cells are wholly material, and in which there is a place of a face.
    origin : (3,) array
        Corner of the first cell, mm.
    size : float
        Length of a cell, mm.
    """
    from scipy.ndimage import binary_dilation, generate_binary_structure

    clear = ~(material | binary_dilation(held, generate_binary_structure(3, 2)))
    return SolidGrid(material.shape, origin, size, _pack_each_way(~material), _pack_each_way(clear))


def _pack_each_way(cells: Bools) -> tuple[Words, Words, Words]:
    return _pack(cells.transpose(0, 1, 2)), _pack(cells.transpose(1, 2, 0)), _pack(cells.transpose(2, 0, 1))


def _pack(cells: Bools) -> Words:
    """Words of bits along the last of three sides, in the middle; what is left of the last word is set."""
    bits = np.ones((*cells.shape[:2], BITS * -(-cells.shape[2] // BITS)), dtype=bool)
    bits[:, :, :cells.shape[2]] = cells
    words = np.packbits(bits, axis=-1, bitorder="little").view("<u8")
    return np.ascontiguousarray(words.transpose(0, 2, 1))


def _is_material(faces: tuple[Face, ...], places: Array) -> bool:
    """Whether places that no face parts from each other lie in the part: all of them lie behind what is nearest."""
    distance, out = _sides(faces, places)
    tied = distance <= distance.min(axis=0) + _TIE
    # At an edge no face that ends there may say otherwise, and one has to say so.
    least, most = np.where(tied, out, np.inf).min(axis=0), np.where(tied, out, -np.inf).max(axis=0)
    return bool(((least > -_NONE) & (most > _TELLS)).all())


def _sides(faces: tuple[Face, ...], places: Array) -> tuple[Array, Array]:
    """How far places are from faces, and the cosine of the way there and the normal, (faces, k) each."""
    distance, out = np.full((len(faces), len(places)), np.inf), np.zeros((len(faces), len(places)))
    least = np.full(len(places), np.inf)
    for k, face in enumerate(faces):
        away = np.maximum(np.maximum(face.box[0] - places, places - face.box[1]), 0.0)
        rows = np.flatnonzero(np.linalg.norm(away, axis=1) < least + _TIE)
        if len(rows):
            found = nearest(face, places[rows])
            way = found.point - places[rows]
            distance[k, rows] = found.distance
            out[k, rows] = dot(face.normal(found.uv), way) / np.maximum(found.distance, _TIE)
            least[rows] = np.minimum(least[rows], found.distance)
    return distance, out
