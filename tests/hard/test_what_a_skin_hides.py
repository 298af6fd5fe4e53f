"""Found: of face 90 of mousecover 0.15 mm^2 lie 3.5 mm under face 3, as the skin of both is seen.

A piece of the skin at that place is a piece of face 3.  The judge took it for one of both, and failed passes over it
for what they cannot reach of face 90.
"""

import numpy as np
import pytest

from toolaxis.cad.load import load
from toolaxis.job.inputs.spec import with_joined
from toolaxis.skin.join import GREATEST_CORNER
from toolaxis.skin.pieces import own_pieces
from toolaxis.skin.view_surface import ViewSurface

HIDDEN = np.array([80.540, 67.105, 13.11])


def test_what_lies_under_another_member_is_not_of_a_piece(shared_parts):
    joined, _ = with_joined(load(shared_parts / "mousecover.step"), "skins", GREATEST_CORNER, 16.0, False)
    skin = next(face for face in joined.faces if {3, 90} <= set(face.numbers))
    surface = skin.surface
    assert isinstance(surface, ViewSurface)
    under = next(seen for seen in surface.seen if seen.face.number == 90)
    place = under.project(HIDDEN[None])[0]
    square = place + 0.05 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    assert under.contains(square).all() and (surface.owners(square) != surface.seen.index(under)).all()
    assert np.linalg.norm(surface.evaluate(place[None]).point[0] - HIDDEN) > 3.0
    piece = skin.trimmed((square,), f"{skin.label}a")
    assert [own.number for own in own_pieces(piece)] == [3]
    hidden = surface.hidden[0]
    assert (hidden.face, hidden.beneath) == (90, 3) and 0.2 < hidden.area < 1.0
    assert np.linalg.norm(hidden.point - HIDDEN) < 0.5, "it is told where that is"
    left = sum(face.area for face in skin.own_faces) - sum(one.area for one in surface.hidden)
    assert skin.area == pytest.approx(left, rel=1e-12)
    assert sum(own.area for own in own_pieces(skin)) == pytest.approx(skin.area, rel=1e-5)
