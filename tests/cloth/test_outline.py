"""Invalid outlines are refused, and the error names the point and the number."""

import math

import pytest

from planner.cloth.outline import require_simple_outline
from planner.errors import GarmentError
from planner.geometry.pose import Point2

SQUARE: list[Point2] = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)]


def refusal(points: list[Point2]) -> tuple[str, str]:
    with pytest.raises(GarmentError) as caught:
        require_simple_outline(points)
    return caught.value.field, caught.value.message


@pytest.mark.parametrize("points", [SQUARE, SQUARE[::-1], SQUARE[:3]])
def test_simple_polygons_in_either_orientation_are_taken_and_refused_with_a_corner_twice(points: list[Point2]) -> None:
    require_simple_outline(points)
    assert refusal([points[0], *points])[0].startswith("outline")


def test_fewer_than_three_points_are_refused() -> None:
    assert refusal(SQUARE[:2]) == ("outline", "has 2 points, it needs 3 to 400")


def circle(count: int) -> list[Point2]:
    return [(math.cos(math.tau * i / count), math.sin(math.tau * i / count)) for i in range(count)]


def test_four_hundred_points_are_taken_and_one_more_is_refused() -> None:
    require_simple_outline(circle(400))
    assert refusal(circle(401))[1] == "has 401 points, it needs 3 to 400"


def test_an_edge_of_one_millimetre_is_taken_and_a_shorter_one_is_refused() -> None:
    require_simple_outline([*SQUARE[:2], (0.4, 0.001), *SQUARE[2:]])
    field, message = refusal([*SQUARE[:2], (0.4, 0.0005), *SQUARE[2:]])
    assert field == "outline[2]"
    assert "edge 1 from point 1 to point 2 is 0.500 mm long" in message


def test_the_first_point_repeated_at_the_end_is_refused() -> None:
    field, message = refusal([*SQUARE, SQUARE[0]])
    assert field == "outline[0]" and "edge 4" in message and "0.000 mm" in message


def test_edges_that_cross_are_named_with_the_place() -> None:
    # A bow tie: the diagonals of the unit square cross in its middle.
    field, message = refusal([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])
    assert field == "outline[2]" and message == "edges 0 and 2 cross at (0.500, 0.500) m"


def test_a_neck_narrower_than_what_counts_as_one_place_is_refused() -> None:
    def hourglass(neck_m: float) -> list[Point2]:
        low, high = 0.15 - neck_m / 2, 0.15 + neck_m / 2
        return [(0.0, 0.0), (0.2, low), (0.4, 0.0), (0.4, 0.3), (0.2, high), (0.0, 0.3)]

    require_simple_outline(hourglass(2e-5))
    assert "(0.200, 0.150)" in refusal(hourglass(5e-6))[1]


def test_a_vertex_that_touches_another_edge_is_refused() -> None:
    field, message = refusal([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.0), (0.0, 1.0)])
    assert "(0.500, 0.000)" in message and field.startswith("outline[")


def test_a_vertex_visited_twice_is_refused() -> None:
    # Two triangles that share the corner (0.5, 0.5).
    points = [(0.0, 0.0), (0.5, 0.5), (1.0, 0.0), (1.0, 1.0), (0.5, 0.5), (0.0, 1.0)]
    assert "(0.500, 0.500)" in refusal(points)[1]


def test_an_edge_that_runs_back_over_the_one_before_is_refused() -> None:
    points = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0), (0.5, 1.0)]
    assert "edges 0 and 1 cross at (1.000, 0.000) m" in refusal(points)[1]


def test_a_closing_edge_that_runs_back_over_the_first_is_refused() -> None:
    points = [(0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.5), (0.7, 0.0), (0.6, 0.0)]
    assert refusal([points[0], *points[1:5], (0.9, 0.0)])[0].startswith("outline[")


def test_edges_in_one_line_that_overlap_elsewhere_are_refused() -> None:
    points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.8, 1.0), (0.8, 0.0), (0.6, 0.0), (0.6, 1.0), (0.0, 1.0)]
    assert "cross" in refusal(points)[1]


def test_less_than_a_square_centimetre_of_cloth_is_refused() -> None:
    # 9 mm x 10 mm = 0.9 cm^2.
    assert "0.000090 m^2" in refusal([(0.0, 0.0), (0.01, 0.0), (0.01, 0.009), (0.0, 0.009)])[1]
    require_simple_outline([(0.0, 0.0), (0.01, 0.0), (0.01, 0.0101), (0.0, 0.0101)])
