"""Rates from cutting data, and what tools are called."""

from math import pi

import pytest

from toolaxis.errors import InvalidInput
from toolaxis.tools.cutting_data import rates_from_cutting_data
from toolaxis.tools.registry import cutter_of_bit, cutters
from toolaxis.tools.tool import Tool


def test_speed_and_feed_follow_from_cutting_data() -> None:
    """A point of the edge runs v_c, and each tooth advances by f_z in its share of a turn."""
    rates = rates_from_cutting_data(12.0, {"teeth": 4, "cutting_speed": 180.0, "feed_per_tooth": 0.09})
    assert rates["spindle"] * pi * 12.0 / 1000 == pytest.approx(180.0)
    assert rates["feedrate"] / (rates["spindle"] * 4) == pytest.approx(0.09)
    assert rates_from_cutting_data(10.0, {"spindle": 5000, "teeth": 2, "feed_per_tooth": 0.1}) == {
        "spindle": 5000.0, "feedrate": 1000.0}
    assert rates_from_cutting_data(10.0, {"cutting_speed": 100 * pi, "feedrate": 900.0}) == {
        "spindle": pytest.approx(10_000), "feedrate": 900.0}
    assert rates_from_cutting_data(10.0, {"teeth": 4}) == {}


@pytest.mark.parametrize("stated, said", [
    ({"spindle": 5000, "cutting_speed": 100}, "both spindle and cutting_speed are given: leave out one"),
    ({"feedrate": 500, "feed_per_tooth": 0.1}, "both feedrate and feed_per_tooth are given"),
    ({"feed_per_tooth": 0.1, "spindle": 5000}, "without teeth: state the number"),
    ({"feed_per_tooth": 0.1, "teeth": 4}, "without a speed: state spindle or cutting_speed"),
    ({"teeth": 2.5}, "number of teeth is 2.5: it must be a whole number from 1"),
    ({"teeth": 0}, "number of teeth is 0"),
    ({"cutting_speed": float("nan")}, "cutting speed is nan m/min"),
    ({"cutting_speed": -100}, "cutting speed is -100.0 m/min"),
    ({"spindle": 0}, "spindle is 0.0 rev/min"),
])
def test_wrong_cutting_data(stated: dict[str, object], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        rates_from_cutting_data(10.0, stated)


@pytest.mark.parametrize("form, stickout, name", [
    ("torus:12x1", 60.0, "Bull nose D12 R1, 60 out"),
    ("torus:6x0.5", None, "Bull nose D6 R0.5"),
    ("ball:0.5", 28.5, "Ball D0.5, 28.5 out"),
    ("flat:20", 80.0, "Flat end mill D20, 80 out"),
    ("tapered:6x3x4", 55.0, "Tapered ball D6 4 deg, 55 out"),
    ("tapered:6x1x2.5", None, "Tapered D6 R1 2.5 deg"),
])
def test_tools_are_called_what_a_shop_calls_them(form: str, stickout: float | None, name: str) -> None:
    assert Tool.parse(form, stickout=stickout).shop_name == name
    assert Tool.parse(form, stickout=stickout, title="No. 7").shop_name == "No. 7"


@pytest.mark.parametrize("word, kind", [
    ("ball end mill", "ball"), ("Ball-nose", "ball"), ("BALL", "ball"), ("bull nose end mill", "torus"),
    ("Bullnose", "torus"), ("flat end mill", "flat"), ("End Mill", "flat"), ("tapered mill", "tapered"),
    ("TaperedBallNose", "tapered"), ("Torusfräser", "torus"), ("drill", None), ("tap right hand", None),
    ("thread mill", None), ("radius mill", None), ("lollipop mill", None), ("face mill", None), ("", None),
])
def test_words_for_kinds(word: str, kind: str | None) -> None:
    found = cutter_of_bit(word)
    assert (found and found.name) == kind


def test_no_word_stands_for_two_kinds() -> None:
    words = [word for cutter in cutters().values() for word in cutter.read_from]
    assert len(words) == len(set(words)) and all(word == word.lower() and word.isalpha() for word in words)
