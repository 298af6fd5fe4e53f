"""Points of the box around a part, and of its stock, as origins of programs."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.shape.work_origin import (
    PLACES,
    StockBox,
    check_origin,
    describe_origin,
    format_margins,
    locate_origin,
    parse_margins,
    parse_origin,
)

BOX = np.array([[10.0, -20.0, 5.0], [50.0, 0.0, 30.0]])
MARGINS = (1.0, 2.0, 3.0, 4.0, 0.0, 5.0)


def test_the_places_of_a_box() -> None:
    assert locate_origin("part:top", BOX, ()).tolist() == [30, -10, 30]
    assert locate_origin("part:bottom-front-left", BOX, ()).tolist() == [10, -20, 5]
    assert locate_origin("stock:top-back-right", BOX, MARGINS).tolist() == [52, 4, 35]
    assert locate_origin("stock:middle", BOX, MARGINS).tolist() == [30.5, -9.5, 20]
    assert locate_origin(" Point: 1,-2, 3.5 ", BOX, ()).tolist() == [1, -2, 3.5]
    assert locate_origin("", BOX, MARGINS).tolist() == [0, 0, 0]


@pytest.mark.parametrize("body", ("part", "stock"))
def test_opposite_corners_have_the_middle_between_them_and_all_move_along(body: str) -> None:
    middle = locate_origin(f"{body}:middle", BOX, MARGINS)
    opposite = {"top": "bottom", "bottom": "top", "front": "back", "back": "front", "left": "right", "right": "left"}
    for place in PLACES:
        other = "-".join(opposite.get(word, word) for word in place.split("-"))
        both = [locate_origin(f"{body}:{name}", BOX, MARGINS) for name in (place, other)]
        assert np.allclose(np.mean(both, axis=0), middle)
        moved = locate_origin(f"{body}:{place}", BOX + np.array([7, 8, 9]), MARGINS)
        assert np.allclose(moved - both[0], [7, 8, 9])


def test_the_stock_around_a_part() -> None:
    stock = StockBox.around(BOX, MARGINS)
    assert stock == StockBox((9, -23, 5), (52, 4, 35)) and stock.size == (43, 27, 30)


def test_margins_in_their_forms() -> None:
    assert parse_margins("2") == parse_margins(2) == (2.0,) * 6
    assert parse_margins("1,2,3,4,0,5") == parse_margins(MARGINS) == MARGINS
    assert parse_margins("") == parse_margins(None) == ()
    for margins in ((), (2.0,) * 6, MARGINS):
        assert parse_margins(format_margins(margins)) == margins
    for wrong in ("1,2", "x", "1,2,3,4,5,nan", [1, 2, 3], -1, "1,1,1,1,1,1e9"):
        with pytest.raises(InvalidInput, match="margin"):
            parse_margins(wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ("top", "part:", "part:front", "stock:top:left", "point:1,2", "point:1,2,inf",
                                  "vertex:3"))
def test_what_is_no_origin_is_refused_with_the_forms(text: str) -> None:
    with pytest.raises(InvalidInput, match=r"origin .* is not understood: write part:top, .*point:X,Y,Z"):
        parse_origin(text)


def test_a_point_of_the_stock_needs_the_stock() -> None:
    with pytest.raises(InvalidInput, match="is a point of the stock and there is none"):
        check_origin("stock:top", ())
    check_origin("stock:top", MARGINS)
    check_origin("part:top", ())


def test_origins_in_words() -> None:
    assert describe_origin("") == ""
    assert describe_origin("part:top") == "middle of the top of the part"
    assert describe_origin("stock:bottom-front-left") == "front left corner of the bottom of the stock"
    assert describe_origin("stock:middle") == "middle of the stock"
    words = {describe_origin(f"{body}:{place}") for body in ("part", "stock") for place in PLACES}
    assert len(words) == 2 * len(PLACES)
