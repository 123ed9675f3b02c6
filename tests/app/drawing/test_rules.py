"""The rules of drawing that 3D view and board share; `tests/browser` holds what the board does against them."""

from pathlib import Path

import pytest

from app.drawing.page_rules import page_rules
from app.drawing.rules import fold_name, next_corner, snapped, snapped_corner
from planner.cloth.outline import POINTS_MAX
from planner.geometry.region import Region

SQUARE = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.4, 0.4), (0.0, 0.4)])
PIXEL_M = 0.001
RULES = Path(__file__).parents[3] / "static" / "js" / "board" / "rules.js"
TRIANGLE = [(0.0, 0.0), (0.4, 0.0), (0.0, 0.3)]


def test_the_page_has_the_rules_as_they_are() -> None:
    told = RULES.read_text()
    assert told == page_rules(), "run `make page-rules`"


@pytest.mark.parametrize(
    ("point", "place"),
    [
        ((0.007, 0.007), (0.0, 0.0)),  # 9.9 mm from a corner, which holds 10 px
        ((0.205, 0.006), (0.2, 0.0)),  # 7.8 mm from the middle of an edge
        ((0.1384, 0.0072), (0.4 / 3, 0.0)),  # 8.8 mm from a third of an edge
        ((0.24, 0.0075), (0.24, 0.0)),  # nothing but the edge within 8 px
        ((0.24, 0.0085), (0.24, 0.0085)),
        ((0.2, 0.2), (0.2, 0.2)),
    ],
)
def test_a_pointer_means_the_corner_before_the_fraction_before_the_edge(
    point: tuple[float, float], place: tuple[float, float]
) -> None:
    assert snapped(SQUARE, point, PIXEL_M) == pytest.approx(place)


def test_an_outline_closes_at_its_first_corner_from_further_away_than_it_meets_others() -> None:
    assert snapped_corner(TRIANGLE, (0.008, 0.008), PIXEL_M) == (0.0, 0.0)
    assert snapped_corner(TRIANGLE, (0.408, 0.008), PIXEL_M) == (0.408, 0.008)
    assert snapped_corner(TRIANGLE, (0.406, 0.006), PIXEL_M) == (0.4, 0.0)
    assert snapped_corner(TRIANGLE[:2], (0.008, 0.008), PIXEL_M) == (0.008, 0.008)


def test_what_becomes_of_an_outline_at_its_next_corner() -> None:
    assert next_corner(TRIANGLE, (0.0, 0.0005)) == "close"
    assert next_corner(TRIANGLE, TRIANGLE[-1]) == "close"
    assert next_corner(TRIANGLE, TRIANGLE[1]) == "taken"
    assert next_corner(TRIANGLE[:2], TRIANGLE[0]) == "taken"
    assert next_corner(TRIANGLE, (0.2, 0.2)) == "put"
    many = [(0.01 * n, 0.0) for n in range(POINTS_MAX)]
    assert next_corner(many, (0.0, 0.3)) == "full"
    assert next_corner(many, many[0]) == "close"


def test_a_fold_is_called_by_the_side_from_which_the_cloth_comes() -> None:
    assert [fold_name(way, ()) for way in ((0, 1), (0, -1), (1, 0), (-1, 0))] == [
        "left over",
        "right over",
        "top down",
        "bottom up",
    ]
    assert fold_name((0.0, 1.0), {"left over", "left over 2"}) == "left over 3"
