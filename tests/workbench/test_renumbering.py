"""The faces of a part are renumbered, or another one is chosen: what happened is told in one sentence."""

import json
import re

import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.services import api


@pytest.fixture
def part(document, parts):
    return parts.block(document)


def stale(operation, words):
    """Whether an operation is marked stale for one reason, by its properties and by a look at the document."""
    reasons = "; ".join(operation.StaleReasons)
    assert words in reasons, reasons
    return operation.Stale and api.is_stale(operation)


def renumbered(part, order):
    """The faces of a part in another order, as a shape."""
    import Part as FreecadPart

    faces = part.Shape.Faces
    return FreecadPart.Solid(FreecadPart.Shell([faces[k] for k in order]))


def test_renumbered_faces_are_told_with_what_stands_in_their_place(document, parts, part):
    name = parts.sculptured_name(part)
    made = parts.planned(document, (part, name))[0]
    number, count = int(name.removeprefix("Face")), len(part.Shape.Faces)
    part.Shape = renumbered(part, [(k - 1) % count for k in range(count)])
    document.recompute()
    told = [reason for reason in made.StaleReasons if "renumbered" in reason]
    assert len(told) == 1 and stale(made, f"that is Face{number % count + 1} now, put it into Faces")
    assert f"{name} is another one now, " in told[0] and "planned was a B-spline surface of" in told[0]
    assert re.search(r" of [0-9.]+ \w*m²", told[0]) and "another face was chosen" not in told[0]
    made.Faces = [(part, (f"Face{number % count + 1}",))]
    document.recompute()
    assert stale(made, f"{name} is Face{number % count + 1} now") and len(made.StaleReasons) == 2


def test_a_face_that_freecad_follows_through_a_change(document, parts):
    base, hole = parts.block(document, "Base"), document.addObject("Part::Cylinder", "Hole")
    hole.Height, hole.Placement = 60, Placement(Vector(10, 8, -500), Rotation())
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = base, hole
    document.recompute()
    made = parts.planned(document, (cut, parts.sculptured_name(cut)))[0]
    before = made.Faces[0][1][0]
    hole.Placement.Base = Vector(10, 8, 9)
    document.recompute()
    after = made.Faces[0][1][0]
    assert stale(made, "the part has changed") and not any("chosen" in reason for reason in made.StaleReasons)
    assert any("renumbered" in reason for reason in made.StaleReasons) == (before != after)


def test_another_face_is_told_as_chosen_and_a_missing_one_as_gone(document, parts, part):
    name = parts.sculptured_name(part)
    made = parts.planned(document, (part, name))[0]
    plane = next(k for k, face in enumerate(part.Shape.Faces, 1) if type(face.Surface).__name__ == "Plane")
    made.Faces = [(part, (f"Face{plane}",))]
    document.recompute()
    assert stale(made, f"another face was chosen: Face{plane}, a plane of ") and len(made.StaleReasons) == 1
    made.Faces = [(part, (name,))]
    document.recompute()
    assert not made.Stale
    part.Shape = part.Shape.Faces[plane - 1]
    document.recompute()
    assert stale(made, "choose it anew in Faces")


def test_an_operation_of_an_older_version_keeps_its_sentence(document, parts, part):
    name = parts.sculptured_name(part)
    made = parts.planned(document, (part, name))[0]
    made.Details = json.dumps({key: value for key, value in json.loads(made.Details).items() if key != "about"})
    document.recompute()
    assert not made.Stale
    made.Faces = [(part, ("Face1" if name != "Face1" else "Face2",))]
    document.recompute()
    assert stale(made, "another face was chosen")
