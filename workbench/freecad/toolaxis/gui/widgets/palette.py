"""Colours and hatches of maps: readable by colour-blind eyes, on light and dark backgrounds."""

import numpy as np
from PySide import QtGui

#: What stands out against every colour of the scale and against grey.
CHOSEN, TRIED, ROMAN, LOBE = "#d55e00", "#ffffff", "#56b4e9", "#ffffff"


def is_dark(palette):
    """Whether a Qt palette has light text on a dark ground; a style sheet may have left its ground as it was.

    Parameters
    ----------
    palette : QPalette
    """
    return palette.color(QtGui.QPalette.WindowText).lightness() > 127


def greys(dark):
    """Ground and hatch of forbidden axes, each (3,) bytes.

    Parameters
    ----------
    dark : bool
    """
    return (np.array([78, 78, 78]), np.array([150, 150, 150])) if dark else (np.array([222, 222, 222]),
                                                                            np.array([140, 140, 140]))


def hatch(code, x, y):
    """Whether pixels carry a line of the hatch of a reason.

    Parameters
    ----------
    code : array of int
        Index into `toolaxis.plan.orientation.REASONS`.
    x, y : arrays of int
        Pixels.
    """
    patterns = {1: y % 6 == 0, 3: (x % 6 < 2) & (y % 6 < 2), 4: (x + y) % 7 == 0, 5: (x - y) % 7 == 0,
                6: (x % 7 == 0) | (y % 7 == 0), 7: x % 6 == 0}
    found = np.zeros(np.broadcast(code, x, y).shape, dtype=bool)
    for reason, lines in patterns.items():
        found |= (code == reason) & lines
    return found


def image_of(rgb, alpha=None):
    """A QImage of (rows, columns, 3) bytes, that owns its pixels.

    Parameters
    ----------
    rgb : array
    alpha : (rows, columns) array of uint8, optional
    """
    rows, columns = rgb.shape[:2]
    pixels = np.empty((rows, columns, 4), dtype=np.uint8)
    pixels[..., :3] = rgb
    pixels[..., 3] = 255 if alpha is None else alpha
    return QtGui.QImage(pixels.tobytes(), columns, rows, 4 * columns, QtGui.QImage.Format_RGBA8888).copy()
