"""The colour scale of maps; needs no window."""

import numpy as np

#: Anchors of a scale that rises in lightness from violet to yellow (viridis), 0 to 1.
_SCALE = ("#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725")
#: Colours of what is above the limit, of what the cutter never reached, and of what is left to clean-up.
ABOVE, MISSED, ASIDE = (213, 94, 0), (204, 121, 167), (200, 200, 200)


def _rgb(text):
    return [int(text[k:k + 2], 16) for k in (1, 3, 5)]


def scale_colours(count=256):
    """The scale as (count, 3) bytes, least value first.

    Parameters
    ----------
    count : int
    """
    anchors = np.array([_rgb(text) for text in _SCALE], dtype=float)
    place = np.linspace(0, len(anchors) - 1, count)
    channels = [np.interp(place, np.arange(len(anchors)), anchors[:, k]) for k in range(3)]
    return np.stack(channels, axis=1).astype(np.uint8)


def coloured(values, low, high):
    """Colours of values, (..., 3) bytes; values beyond the ends get the ends' colours.

    Parameters
    ----------
    values : array
        NaN gives the lower end's colour.
    low, high : float
    """
    share = (np.nan_to_num(np.asarray(values, dtype=float), nan=low) - low) / (high - low if high > low else 1.0)
    return scale_colours()[np.clip(share * 255, 0, 255).astype(np.intp)]


def judged(values, limit, most, aside=None):
    """Colours of heights or depths, (n, 3) bytes.

    Parameters
    ----------
    values : (n,) array
    limit : float
        End of the scale, mm.
    most : float
        What the judge accepts, mm; what is above it is one colour, what is infinite another.
    aside : (n,) array of bool, optional
        What has a colour of its own, whatever its value.
    """
    rgb = coloured(np.where(np.isfinite(values), values, 0.0), 0.0, limit)
    rgb[values > most] = ABOVE
    rgb[~np.isfinite(values)] = MISSED
    if aside is not None:
        rgb[aside] = ASIDE
    return rgb
