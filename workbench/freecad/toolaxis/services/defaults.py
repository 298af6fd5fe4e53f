"""What a job is given unless the user says otherwise: sensible for the part, and for the tools of the document."""

from contextlib import suppress
from dataclasses import replace
from math import ceil

from freecad.toolaxis.document.cam_probe import controllers, speeds, tool_from
from freecad.toolaxis.document.inputs import JobInputs
from freecad.toolaxis.document.preferences import preferred_inputs
from freecad.toolaxis.document.read_shapes import number_in
from freecad.toolaxis.services.obstacles import bodies_beside
from freecad.toolaxis.services.part_depth import FacesSeen, with_most_area
from freecad.toolaxis.services.tools import tool_fields

#: Diameters that cutters come in, mm.
_DIAMETERS = (2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0)
_SCALLOPS = (0.01, 0.02, 0.05)
_GRID = 5
#: Stick-out, in diameters: usual and greatest; steps of it and what stays between holder and part, mm.
_USUAL, _LONGEST, _STEP, _CLEAR = 5.0, 12.0, 5.0, 2.0
#: Share of the gap before a face that a cutter may take.
_GAP = 0.6


def defaults(document, faces, whole=False):
    """Inputs for faces: the first usable tool of a CAM job, else what is preferred, or a bull nose that fits the faces.

    Its diameter follows what most of the area allows, fillets and corners aside, and the gap before the faces; its
    stick-out follows how deep they lie in the part.  The other bodies of the assembly, or part container, of which they
    are, are to be avoided.  Whole bodies get the general rack where neither a CAM job nor the user's preferences name a
    tool: few parts can be machined with one.

    Parameters
    ----------
    document : App.Document
    faces : sequence of (object, "Face7")
    whole : bool
        Whether they stand for whole bodies.

    Returns
    -------
    freecad.toolaxis.document.inputs.JobInputs
        Also where the faces cannot be used; they are refused later, with the reason.
    """
    from toolaxis.job.inputs.tool_library import GENERAL_RACK

    shapes = _faces(faces)
    beside = bodies_beside(document, list(dict.fromkeys(thing for thing, _ in faces)))
    seen = FacesSeen.of(shapes, _parts_of(faces, beside))
    inputs = _apply_preferences(_for_size(JobInputs(tuple(faces), obstacles=tuple(beside)), shapes, seen), seen)
    for controller in controllers(document):
        with suppress(Exception):  # a tool of another kind: the next one
            found = tool_fields(tool_from(controller))
            feed, spindle = speeds(controller)
            inputs = replace(inputs, **found, feedrate=feed or inputs.feedrate, spindle=spindle or inputs.spindle)
            return inputs
    if whole and "tool" not in preferred_inputs():
        return replace(inputs, rack=(GENERAL_RACK,))
    return inputs


def _parts_of(faces, beside):
    """The shapes of the parts that faces are of, and of the bodies beside them."""
    from toolaxis.cad.freecad.documents import shape_of

    found = []
    for thing in dict.fromkeys([*(thing for thing, _ in faces), *beside]):
        with suppress(Exception):  # it is refused with the reason when it is computed with
            found.append(shape_of(thing))
    return found


def _apply_preferences(inputs, seen):
    """What the user prefers in place of what the part suggests; a tool that is none is left out."""
    from toolaxis.errors import InvalidInput
    from toolaxis.tools.tool import Tool

    found = preferred_inputs()
    if "tool" in found:
        try:
            diameter = 2 * Tool.parse(found["tool"]).radius
        except InvalidInput:
            del found["tool"]
        else:
            found |= {"stickout": _stickout(diameter, seen), "holder": _holder(diameter)}
    return replace(inputs, **found)


def _faces(faces):
    """The faces that can be read, in the document's space."""
    from toolaxis.cad.freecad.documents import shape_of

    found = []
    for thing, name in faces:
        with suppress(Exception):
            shape = shape_of(thing)
            found.append(shape.Faces[number_in(thing, shape, name) - 1])
    return found


def _for_size(inputs, faces, seen):
    """Diameter by the size of the faces, their tightest hollows and what stands before them; the rest by that."""
    if not faces:
        return replace(inputs, holder=_holder(12.0))
    sizes = [area**0.5 for area in seen.areas]
    rooms = [min(size / 4, *(1.6 / bend for bend in [_hollow(face)] if bend > 0), 20.0)
             for size, face in zip(sizes, faces, strict=True)]
    room = min(with_most_area(rooms, seen.areas, high=False), _GAP * seen.gap)
    diameter = max((one for one in _DIAMETERS if one <= room), default=_DIAMETERS[0])
    corner = max(0.5, round(diameter / 6 * 2) / 2)
    size = with_most_area(sizes, seen.areas, high=False)
    scallop = max((one for one in _SCALLOPS if one <= size / 1500), default=_SCALLOPS[0])
    return replace(inputs, tool=f"torus:{diameter:g}x{corner:g}", stickout=_stickout(diameter, seen),
                   holder=_holder(diameter), scallop=scallop)


def _stickout(diameter, seen):
    """Five diameters, or as much more as keeps the holder above the part, mm."""
    needed = _STEP * ceil((seen.depth(diameter / 2, _holder(diameter)[0][0]) + _CLEAR) / _STEP)
    return max(_USUAL * diameter, min(needed, _LONGEST * diameter))


def _holder(diameter):
    radius = max(8.0, diameter)
    return ((radius, 0.0), (radius, 30.0), (1.6 * radius, 30.0), (1.6 * radius, 60.0))


def _hollow(face):
    """Greatest curvature towards the tool at a few places, 1/mm; 0 where the face is flat or bulges."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    sense = -1.0 if face.Orientation == "Reversed" else 1.0
    found = [0.0]
    for i in range(_GRID):
        for j in range(_GRID):
            with suppress(Exception):  # no curvature at a pole
                both = face.curvatureAt(low_u + (high_u - low_u) * (i + 0.5) / _GRID,
                                        low_v + (high_v - low_v) * (j + 0.5) / _GRID)
                found += [sense * bend for bend in both]
    return max(found)
