"""The faces of the benchmark as control points: published surfaces, the examples', seeded patches, exact quadrics."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, radians
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks.fields import patch_points
from numpy.typing import NDArray

from toolaxis.shape.analytic import ConicalSurface, CylindricalSurface, SphericalSurface, ToroidalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
#: Seeds of the patches that are bicubic over 60 x 45 mm.
SEEDS = range(8)
#: Decimals of control points, mm, weights and trim loops in the files: what is rounded is the surface.
DECIMALS = 9
#: Corners of a trim loop that stands for an oval.
_CORNERS = 72


@dataclass(frozen=True, eq=False)
class FaceData:
    """A face as its file has it.

    Attributes
    ----------
    points : (nu, nv, 3) array
        Control points, mm.
    degree : (int, int)
    source : str
        Key of `resources/references.bib` and where in it, or "made for this benchmark".
    weights : (nu, nv) array, optional
        None where all are one.
    knots : pair of arrays, optional
        Full knot vectors in u and v; None for clamped uniform ones on [0, 1].
    trims : tuple of (m, 2) arrays
        Closed loops in (u, v), the outer one first.
    flip : bool
        Whether the normal out of the material is against Su x Sv.
    obstacles : tuple of FaceData
        What stands around the face and must not be touched.
    """

    points: Array
    degree: tuple[int, int]
    source: str = "made for this benchmark"
    weights: Array | None = None
    knots: tuple[Array, Array] | None = None
    trims: tuple[Array, ...] = ()
    flip: bool = False
    obstacles: tuple["FaceData", ...] = ()

    @classmethod
    def from_surface(cls, surface: NurbsSurface, flip: bool = False) -> "FaceData":
        """The data of a rational surface.

        Parameters
        ----------
        surface : NurbsSurface
        flip : bool
        """
        weights = surface.control[..., 3]
        return cls(surface.control[..., :3] / weights[..., None], surface.degree, weights=weights,
                   knots=(surface.knots_u, surface.knots_v), flip=flip)

    def face(self, number: int = 1) -> Face:
        """The face itself.

        Parameters
        ----------
        number : int
            What messages call it.
        """
        made = Face.from_bspline(self.points, self.degree, self.knots, self.weights, self.trims, self.flip)
        return Face(made.surface, made.trims, made.flip, number)

    def document(self) -> dict[str, Any]:
        """The face as a document that `json.dump` takes, rounded to `DECIMALS`."""
        return {"source": self.source, "degree": list(self.degree), "flip": self.flip,
                "knots": None if self.knots is None else [_rounded(one) for one in self.knots],
                "weights": None if self.weights is None else _rounded(self.weights),
                "trims": [_rounded(loop) for loop in self.trims], "points": _rounded(self.points),
                "obstacles": [one.document() for one in self.obstacles]}

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> "FaceData":
        """What `document` wrote.

        Parameters
        ----------
        document : dict
        """
        weights, knots = document["weights"], document["knots"]
        return cls(np.array(document["points"], dtype=float), (document["degree"][0], document["degree"][1]),
                   document["source"], None if weights is None else np.array(weights, dtype=float),
                   None if knots is None else (np.array(knots[0], dtype=float), np.array(knots[1], dtype=float)),
                   tuple(np.array(loop, dtype=float) for loop in document["trims"]), document["flip"],
                   tuple(cls.from_document(one) for one in document["obstacles"]))


def _rounded(values: Array) -> Any:
    return (np.round(values, DECIMALS) + 0.0).tolist()


def build_faces() -> dict[str, FaceData]:
    """All faces by name, in the order of the tables."""
    return {**_from_examples(), **{f"seed-{seed}": FaceData(patch_points(seed), (3, 3)) for seed in SEEDS},
            **_quadrics(), **_with_trims(), **_with_obstacles(), **_beyond_one_axis()}


def _from_examples() -> dict[str, FaceData]:
    """What the examples' files have: three published surfaces, and five that were made for the project."""
    found = {}
    for name in ("hyperbolic_paraboloid", "manta", "biquintic", "freeform", "saddle", "waves", "dish"):
        document = json.loads((EXAMPLES / f"{name}.json").read_text("utf-8"))
        degree = (document["degree"][0], document["degree"][1])
        found[name.replace("_", "-")] = FaceData(np.array(document["points"], dtype=float), degree, document["source"])
    return found


def _quadrics() -> dict[str, FaceData]:
    """Exact surfaces of constant or simple curvature; a plane for calibration, whose shortest passes are known."""
    x, y = np.meshgrid([0.0, 50.0], [0.0, 36.0], indexing="ij")
    plane = FaceData(np.stack([x, y, 0.2 * x + 0.1 * y], axis=-1), (1, 1))
    quarter, wide = (radians(35), radians(145)), (radians(-50), radians(50))
    return {
        "plane": plane,
        "cylinder": FaceData.from_surface(CylindricalSurface(25.0, quarter, (0.0, 45.0)).nurbs()),
        "trough": FaceData.from_surface(CylindricalSurface(30.0, (radians(225), radians(315)), (0.0, 45.0)).nurbs(),
                                        flip=True),
        "cone": FaceData.from_surface(ConicalSurface(28.0, radians(20), quarter, (-20.0, 20.0)).nurbs()),
        "sphere": FaceData.from_surface(SphericalSurface(30.0, wide, (radians(15), radians(65))).nurbs()),
        "bowl": FaceData.from_surface(SphericalSurface(40.0, wide, (radians(-75), radians(-30))).nurbs(), flip=True),
        "tube": FaceData.from_surface(ToroidalSurface(45.0, 20.0, (radians(-30), radians(30)),
                                                      (radians(30), radians(110))).nurbs()),
        "gutter": FaceData.from_surface(ToroidalSurface(60.0, 25.0, (radians(-25), radians(25)),
                                                        (radians(230), radians(300))).nurbs(), flip=True),
    }


def _oval(middle: Sequence[float], radii: Sequence[float], corners: int = _CORNERS) -> Array:
    """A loop of corners on an oval in (u, v), counter-clockwise."""
    turn = 2 * pi * np.arange(corners) / corners
    return np.stack([middle[0] + radii[0] * np.cos(turn), middle[1] + radii[1] * np.sin(turn)], axis=-1)


def _with_trims() -> dict[str, FaceData]:
    """Faces of which no border runs along a parameter: an oval, one with a hole, an outline with a hollow."""
    turn = 2 * pi * np.arange(_CORNERS) / _CORNERS
    reach = 0.4 + 0.06 * np.cos(3 * turn + 0.5)
    outline = np.stack([0.5 + reach * np.cos(turn), 0.5 + reach * np.sin(turn)], axis=-1)
    base = patch_points(11)
    return {"oval": FaceData(patch_points(9), (3, 3), trims=(_oval((0.5, 0.5), (0.45, 0.42)),)),
            "hole": FaceData(patch_points(10), (3, 3),
                             trims=(_oval((0.5, 0.5), (0.46, 0.44)), _oval((0.45, 0.55), (0.13, 0.15))[::-1])),
            "trefoil": FaceData(base, (3, 3), trims=(outline,))}


def _with_obstacles() -> dict[str, FaceData]:
    """Faces beside which something stands: a wall along a side, and a post in a hole."""
    x, y = np.meshgrid([-24.0, 0.0, 24.0], [-18.0, 0.0, 18.0], indexing="ij")
    coefficients = [(half**2) * np.array([1.0, -1.0, 1.0]) for half in (24.0, 18.0)]
    saddle = np.stack([x, y, coefficients[0][:, None] / 160 - coefficients[1][None, :] / 110], axis=-1)
    along, up = np.meshgrid([-40.0, 40.0], [-10.0, 45.0], indexing="ij")
    wall = FaceData(np.stack([along, np.full((2, 2), 30.0), up], axis=-1), (1, 1))
    post = FaceData.from_surface(CylindricalSurface(4.0, (0.0, 2 * pi), (-15.0, 20.0)).nurbs())
    bump = np.stack([x * 1.2, y * 1.3, -coefficients[0][:, None] / 140 - coefficients[1][None, :] / 180], axis=-1)
    hole = _oval((0.5, 0.5), (0.28, 0.34))[::-1]
    frame = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    return {"wall": FaceData(saddle, (2, 2), obstacles=(wall,)),
            "post": FaceData(bump, (2, 2), trims=(frame, hole), obstacles=(post,))}


def _beyond_one_axis() -> dict[str, FaceData]:
    """Faces whose normals no hemisphere holds, so that one axis does not do."""
    low = (radians(-25), radians(35))
    return {"roll": FaceData.from_surface(CylindricalSurface(22.0, (radians(-75), radians(255)), (0.0, 30.0)).nurbs()),
            "zone": FaceData.from_surface(SphericalSurface(24.0, (0.0, radians(330)), low).nurbs()),
            "bend": FaceData.from_surface(ToroidalSurface(30.0, 14.0, (0.0, radians(100)),
                                                          (radians(-25), radians(205))).nurbs()),
            "barrel": FaceData.from_surface(ToroidalSurface(20.0, 19.0, (0.0, radians(230)),
                                                            (radians(-30), radians(30))).nurbs())}
