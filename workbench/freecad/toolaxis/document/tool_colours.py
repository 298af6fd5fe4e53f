"""Colours that tell the tools of a plan apart, of passes and of what they machine."""

import FreeCAD

#: Strong colours that stay apart for colour-blind eyes (Okabe and Ito), in the order in which tools are used.
_COLOURS = ((0.835, 0.369, 0.0), (0.0, 0.447, 0.698), (0.0, 0.620, 0.451), (0.800, 0.475, 0.655),
            (0.902, 0.624, 0.0), (0.337, 0.706, 0.914), (0.35, 0.35, 0.35))
#: Share of white in the pale ones.
_WHITE = 0.55


def tool_colour(place):
    """The colour of a tool, (r, g, b) from 0 to 1.

    Parameters
    ----------
    place : int
        Among the tools with which a plan machines something, in their order, from 0.
    """
    return _COLOURS[place % len(_COLOURS)]


def pale_tool_colour(place):
    """The same paler, so that lines stand out on it.

    Parameters
    ----------
    place : int
        As for `tool_colour`.
    """
    return tuple(_WHITE + (1 - _WHITE) * value for value in tool_colour(place))


def colour_passes(passes, colour):
    """Draw the cuts of a Path object in a colour, where there is a window.

    Parameters
    ----------
    passes : App.DocumentObject
    colour : (r, g, b)
    """
    if FreeCAD.GuiUp:
        passes.ViewObject.NormalColor = colour
