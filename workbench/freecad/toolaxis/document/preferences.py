"""What the user prefers: read where it counts, edited on a page of FreeCAD's preferences."""

import FreeCAD

#: Where FreeCAD keeps them; the page names the same place.
PLACE = "User parameter:BaseApp/Preferences/Mod/ToolAxis"
#: Colours as FreeCAD's buttons keep them, 0xRRGGBBAA: orange and grey that colour-blind eyes tell apart.
_CUT, _LINK = 0xE66100FF, 0x737373FF
#: Threads unless others are preferred.
_THREADS = 2


def _kept():
    return FreeCAD.ParamGet(PLACE)


def machines_folder():
    """The user's folder of machines; empty where none is named."""
    return _kept().GetString("MachinesFolder", "").strip()


def threads():
    """Threads that judge a plan."""
    return max(1, _kept().GetInt("Threads", _THREADS))


def preferred_inputs():
    """Fields of `document.inputs.JobInputs` that the user prefers for new plans; what is left open is not there.

    Returns
    -------
    dict
        tool, scallop, feedrate and spindle, as far as they are given.
    """
    kept, found = _kept(), {}
    for name, field in (("Scallop", "scallop"), ("FeedRate", "feedrate"), ("Spindle", "spindle")):
        value = kept.GetFloat(name, 0.0)
        if value > 0:
            found[field] = value
    if kept.GetString("Tool", "").strip():
        found["tool"] = kept.GetString("Tool", "").strip()
    return found


def colours():
    """Colours of cuts and links in the 3D view while a plan is looked at, each three numbers from 0 to 1."""
    kept = _kept()
    return tuple(tuple((kept.GetUnsigned(name, usual) >> shift & 255) / 255 for shift in (24, 16, 8))
                 for name, usual in (("CutColour", _CUT), ("LinkColour", _LINK)))
