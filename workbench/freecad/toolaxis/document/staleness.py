"""Whether what was planned still holds: the shapes as they were, and the inputs as they were."""

import json

from freecad.toolaxis.document.children import missing
from freecad.toolaxis.document.earlier_setups import changes_since, fingerprint_of
from freecad.toolaxis.document.face_identity import what_became
from freecad.toolaxis.document.inputs import FORMER_TOLERANCE, inputs_of
from freecad.toolaxis.document.shape_cache import known_of
from freecad.toolaxis.document.strategies import INDEXED, ROUGHNESS

from toolaxis.plan.choices import ISO

#: Deviation at which a shape counts as changed, mm; reading a document back rounds to fifteen digits.
_SAME = 1e-6
_SUMS = 8
_GRID = 4
#: Inputs that older documents do not have, with what stood for them.
_USUAL = {"regions": None, "orientations": None, "method": "sphere", "strategy": INDEXED, "roughness": ROUGHNESS,
          "flute_length": 0.0, "passes": ISO, "rack": (), "most_tools": None, "tool_number": 0, "tool_title": "",
          "stock": 0.0, "least_lean": 0.0, "greatest_step_over": 0.0, "allowance_on": "", "lead": 0.0,
          "avoid_faces": "", "held": "", "origin": "", "stock_box": ""}
#: Inputs of which changes are told in sentences of their own.
_APART = ("faces", "obstacles", "after")


def signature(things, obstacles=(), turned=False):
    """Numbers that change with the shapes, and not with where the first of them stands.

    Parameters
    ----------
    things, obstacles : sequence of App.DocumentObject
    turned : bool
        Whether the direction in which the part stands counts too: limits of the axis stand in the document's space.

    Returns
    -------
    list of float

    Raises
    ------
    InvalidInput
        When one of them has no shape any more.
    """
    from toolaxis.cad.freecad.documents import shape_of

    shapes = [shape_of(thing) for thing in (*things, *obstacles)]
    own = shapes[0].Placement.inverse().toMatrix()
    found = [number for shape in shapes for number in _numbers(shape, own)]
    return found + ([float(x) for x in own.A] if turned else [])


def _numbers(shape, own):
    """The numbers of one shape in a frame, a matrix."""
    import numpy as np

    known, frame = known_of(shape), tuple(own.A)
    if "points" not in known:
        known["points"] = np.array(_points(shape), dtype=float)
    if known.get("frame") != frame:
        turn = np.array(frame, dtype=float).reshape(4, 4)
        values = (known["points"] @ turn[:3, :3].T + turn[:3, 3]).ravel()
        index = np.arange(1, len(values) + 1)
        known["numbers"] = [float(len(shape.Faces)), float(len(values)),
                            *(float(np.cos(index * (0.7 + 1.1 * k)) @ values) for k in range(_SUMS))]
        known["frame"] = frame
    return known["numbers"]


def _points(shape):
    """Points on every face and edge of a shape, and what its free surfaces are made of."""
    found = []
    for face in shape.Faces:
        low_u, high_u, low_v, high_v = face.ParameterRange
        for i in range(_GRID):
            for j in range(_GRID):
                found.append(face.valueAt(low_u + (high_u - low_u) * i / 3, low_v + (high_v - low_v) * j / 3))
        surface = _surface(face)
        if type(surface).__name__ == "BSplineSurface":
            found += [pole for row in surface.getPoles() for pole in row]
    for edge in shape.Edges:
        if not edge.Degenerated:
            first, last = edge.ParameterRange
            found += [edge.valueAt(first + (last - first) * k / 3) for k in range(4)]
    return [tuple(point) for point in found]


def _surface(face):
    try:
        return face.Surface
    except Exception:  # a kind of surface that FreeCAD's Python does not know
        return None


def same(one, other):
    """Whether two signatures are those of the same shapes.

    Parameters
    ----------
    one, other : sequence of float
    """
    return len(one) == len(other) and all(abs(a - b) <= _SAME * max(1.0, abs(a) / 1e4)
                                          for a, b in zip(one, other, strict=True))


def digest(inputs):
    """The inputs as text, with the names of the objects.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    """
    numbers = ("stickout", "scallop", "allowance", "feedrate", "spindle")
    words = {name: f"{getattr(inputs, name):.9g}" for name in numbers}
    tolerance, former = (f"{value:.9g}" for value in (inputs.tolerance, FORMER_TOLERANCE))
    words |= {} if tolerance == former else {"tolerance": tolerance}
    words |= {name: getattr(inputs, name) for name in ("tool", "limits", "objective", "direction")}
    words |= {name: [[f"{x:.9g}" for x in row] for row in getattr(inputs, name)] for name in ("shank", "holder")}
    words |= {name: str(getattr(inputs, name)) for name, usual in _USUAL.items() if getattr(inputs, name) != usual}
    words["faces"] = [[thing.Name, name] for thing, name in inputs.faces]
    words["obstacles"] = [thing.Name for thing in inputs.obstacles]
    if inputs.after is not None:
        words["after"] = [inputs.after.Name, fingerprint_of(inputs.after)]
    return json.dumps(words, sort_keys=True)


def standing(operation):
    """What a verdict on an operation is about: the inputs as text, and the numbers of the shapes.

    Parameters
    ----------
    operation : App.DocumentObject

    Raises
    ------
    InvalidInput
        When the part or a body to avoid has no shape any more.
    """

    inputs = inputs_of(operation)
    return digest(inputs), signature([inputs.faces[0][0]], inputs.obstacles, inputs.placed)


def why_stale(operation):
    """Why the results of an operation do not hold any more, sentences; none where they do.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    from toolaxis.errors import ToolAxisError

    if not operation.PlannedWith:
        return ["nothing was planned yet"]
    inputs = inputs_of(operation)
    if not inputs.faces:
        return ["the part was deleted", *missing(operation)]
    planned = json.loads(operation.PlannedWith)
    now = json.loads(digest(inputs))
    reasons = []
    gone = [name for name in planned["obstacles"] if name not in now["obstacles"]]
    if gone:
        reasons.append(f"{', '.join(gone)}: no longer avoided")
    reasons += _changes(planned, now)
    reasons += missing(operation)
    try:
        found = signature([inputs.faces[0][0]], inputs.obstacles, inputs.placed)
    except ToolAxisError as reason:
        return [*reasons, str(reason)]
    (thing, name), (part, planned_name) = inputs.faces[0], planned["faces"][0]
    if thing.Name != part:
        return [*reasons, f"a face of another part was chosen, of {thing.Label}"]
    changed = _what_changed(list(operation.Signature), found, len(inputs.obstacles))
    then = json.loads(operation.Details).get("about")
    return reasons + changed + what_became(thing, (planned_name, name), then, bool(changed))


def changed_inputs(planned, inputs):
    """What of the inputs of a whole plan is not as it was when it was planned, sentences.

    Parameters
    ----------
    planned : dict
        Read from `digest` at the time of planning.
    inputs : freecad.toolaxis.document.inputs.JobInputs
        As they are now, with a face at least.
    """
    now = json.loads(digest(inputs))
    document = inputs.faces[0][0].Document
    names = dict.fromkeys([part for part, _ in planned["faces"]] + planned["obstacles"])
    gone = [name for name in names if document.getObject(name) is None]
    reasons = [f"{', '.join(gone)}: deleted"] if gone else []
    of_earlier = changes_since(planned.get("after"), inputs.after, document)
    reasons += of_earlier
    kept = [face for face in planned["faces"] if face[0] not in gone]
    if not of_earlier and sorted(kept) != sorted(now["faces"]):
        reasons.append("the faces were changed")
    if sorted(name for name in planned["obstacles"] if name not in gone) != sorted(now["obstacles"]):
        reasons.append("the bodies to avoid were changed")
    return reasons + _changes(planned, now)


def _changes(planned, now):
    names = [name for name in dict.fromkeys((*planned, *now)) if name not in _APART]
    return [f"{name} was changed" for name in names if planned.get(name) != now.get(name)]


def _what_changed(planned, found, obstacles):
    """Sentences on shapes that have changed."""
    size = 2 + _SUMS
    if same(planned, found):
        return []
    if not same(planned[:size], found[:size]):
        return ["the part has changed"]
    if len(planned) != len(found) or not same(planned[:size * (1 + obstacles)], found[:size * (1 + obstacles)]):
        return ["a body to avoid was moved or changed"]
    return ["the part was moved or turned, and the limits of the axis, the clamped side or the stock were not"]
