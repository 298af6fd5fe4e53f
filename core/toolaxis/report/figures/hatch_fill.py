"""Hatched pieces of faces: clean-up zones, in what a canvas shows of them."""

from collections.abc import Sequence

import numpy as np
from matplotlib.patches import Patch

from toolaxis.plan.operation import Operation
from toolaxis.report.figures.splat_renderer import Canvas, face_splats
from toolaxis.shape.face import Face

#: Colour of the lines, their distance and their width, pixels.
COLOUR = (0.835, 0.369, 0.0)
_PITCH, _WIDTH = 9, 3


def zone_faces(op: Operation) -> tuple[Face, ...]:
    """The clean-up zones of an operation as faces.

    Parameters
    ----------
    op : Operation
    """
    return tuple(op.face.trimmed(zone.loops) for zone in op.zones)


def hatch(canvas: Canvas, faces: Sequence[Face], slack: float) -> None:
    """Hatch what can be seen of faces that lie on others.

    Parameters
    ----------
    canvas : Canvas
        With everything drawn and closed.
    faces : sequence of Face
    slack : float
        How far below what is drawn a face may lie and still be seen, mm.
    """
    if not faces:
        return
    own = Canvas(canvas.camera)
    for face in faces:
        own.splat(*face_splats(face, canvas.camera), COLOUR)
    own.close()
    seen = np.isfinite(own.depth) & (own.depth >= np.where(np.isfinite(canvas.depth), canvas.depth, -np.inf) - slack)
    row, column = np.indices(seen.shape)
    border = seen & ~(np.roll(seen, 1, 0) & np.roll(seen, -1, 0) & np.roll(seen, 1, 1) & np.roll(seen, -1, 1))
    canvas.colour[(seen & ((row + column) % _PITCH < _WIDTH)) | border] = COLOUR


def hatch_patch() -> Patch:
    """What stands for a clean-up zone in a legend."""
    return Patch(facecolor="white", edgecolor=COLOUR, hatch="////", linewidth=0.8, label="rest material")
