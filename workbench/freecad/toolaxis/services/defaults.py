"""What a job is given unless the user says otherwise: sensible for the part, and for the tools of the document."""

from contextlib import suppress
from dataclasses import replace

from freecad.toolaxis.document.cam_probe import controllers, speeds, tool_from
from freecad.toolaxis.document.inputs import JobInputs
from freecad.toolaxis.document.preferences import preferred_inputs
from freecad.toolaxis.document.read_shapes import number_in
from freecad.toolaxis.services.obstacles import bodies_beside
from freecad.toolaxis.services.tools import tool_fields

#: Diameters that cutters come in, mm.
_DIAMETERS = (2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0)
_SCALLOPS = (0.005, 0.01, 0.02, 0.05)
_GRID = 5


def defaults(document, faces):
    """Inputs for faces: the first usable tool of a CAM job, else what is preferred, or a bull nose that fits the faces.

    The other bodies of the assembly, or part container, of which they are, are to be avoided.

    Parameters
    ----------
    document : App.Document
    faces : sequence of (object, "Face7")

    Returns
    -------
    freecad.toolaxis.document.inputs.JobInputs
        Also where the faces cannot be used; they are refused later, with the reason.
    """
    shapes = _faces(faces)
    beside = bodies_beside(document, list(dict.fromkeys(thing for thing, _ in faces)))
    inputs = _apply_preferences(_for_size(JobInputs(tuple(faces), obstacles=tuple(beside)), shapes))
    for controller in controllers(document):
        with suppress(Exception):  # a tool of another kind: the next one
            found = tool_fields(tool_from(controller))
            feed, spindle = speeds(controller)
            inputs = replace(inputs, **found, feedrate=feed or inputs.feedrate, spindle=spindle or inputs.spindle)
            break
    return inputs


def _apply_preferences(inputs):
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
            found |= {"stickout": 5 * diameter, "holder": _holder(diameter)}
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


def _for_size(inputs, faces):
    """Diameter by the size of the smallest face and its tightest hollow, everything else by the diameter."""
    if not faces:
        return replace(inputs, holder=_holder(12.0))
    size = min(face.Area for face in faces) ** 0.5
    room = min(size / 4, *(1.6 / bend for bend in map(_hollow, faces) if bend > 0), 20.0)
    diameter = max((one for one in _DIAMETERS if one <= room), default=_DIAMETERS[0])
    corner = max(0.5, round(diameter / 6 * 2) / 2)
    scallop = max((one for one in _SCALLOPS if one <= size / 1500), default=_SCALLOPS[0])
    return replace(inputs, tool=f"torus:{diameter:g}x{corner:g}", stickout=5 * diameter, holder=_holder(diameter),
                   scallop=scallop)


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
