"""The picture of a two-point contact shows both contacts where they are, and one where there is one."""

import numpy as np
import pytest

from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.strategies.two_point.contact import BRIDGE, circle_strip_width, settle, two_point_lead
from toolaxis.strategies.two_point.pictures import contacts_picture
from toolaxis.strategies.two_point.rings import ContactSet
from toolaxis.tools.tool import Tool


def _drawn(lift):
    face = Face(CylindricalSurface(100.0, (-0.5, 0.5), (0.0, 80.0)).nurbs(), flip=True)
    uv = np.array([[0.0, 40.0]])
    setting = ContactSet(face, Tool.flat(60), uv, face.evaluate(uv).sv, 0.03, 0.2)
    _, ring = settle(setting, lift)
    made = contacts_picture(setting, ring, "op01")
    return made, made.axes[1]


def test_both_contacts_and_the_strip_are_drawn() -> None:
    made, ax = _drawn(BRIDGE * 0.03)
    contacts = next(line for line in ax.lines if line.get_label() == "contact")
    x, y = contacts.get_data()
    assert len(x) == 2 and x[0] == pytest.approx(-x[1], abs=0.1) and 8 < abs(x[0]) < 14 and np.abs(y).max() < 2
    strip = float(next(text.get_text() for text in ax.texts if "strip" in text.get_text()).split()[1])
    lead = two_point_lead(30.0, 99.8, 0.03)
    assert strip == pytest.approx(float(circle_strip_width(30.0, 99.8, 0.03, lead, 0.03)), rel=0.02)
    made.canvas.draw()
    assert np.asarray(made.canvas.buffer_rgba())[..., :3].std() > 5


def test_one_contact_is_drawn_as_one() -> None:
    _, ax = _drawn(0.0)
    x, _ = next(line for line in ax.lines if line.get_label() == "contact").get_data()
    assert np.ptp(x) < 4 and abs(np.mean(x)) < 2
