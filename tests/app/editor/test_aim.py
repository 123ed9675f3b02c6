import math

import pytest

from app.ui.editor.aim import CLOTH_HEIGHT_M, aim, pixel_angle
from app.ui.editor.ground import Ground, in_article, on_table
from planner.geometry.table import Table
from tests.app.drawing.drawings import outlined, towel_drawing


def test_a_ray_straight_down_meets_the_cloth_under_the_eye() -> None:
    found = aim((0.2, -0.1, 2.0 + CLOTH_HEIGHT_M), (0.2, -0.1, 1.0), 0.001)
    assert found is not None
    assert found.point == (0.2, -0.1)
    assert found.pixel_m == pytest.approx(0.002)  # 2 m off, 1 mrad a pixel


def test_a_slanting_ray_goes_on_beyond_the_point_it_is_given_by() -> None:
    # From 1 m above the cloth, through a point 0.25 m lower and 0.1 m further: the cloth is four times as far.
    found = aim((0.0, 0.0, 1.0 + CLOTH_HEIGHT_M), (0.1, 0.0, 0.75 + CLOTH_HEIGHT_M), 0.001)
    assert found is not None
    assert found.point == pytest.approx((0.4, 0.0))
    assert found.pixel_m == pytest.approx(0.001 * math.hypot(0.4, 1.0))


@pytest.mark.parametrize("through_z_m", [1.0, 1.5])
def test_a_ray_that_does_not_go_down_meets_nothing(through_z_m: float) -> None:
    assert aim((0.0, 0.0, 1.0), (1.0, 0.0, through_z_m), 0.001) is None


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_no_place_is_not_pointed_at(bad: float) -> None:
    assert aim((0.0, 0.0, 1.0), (bad, 0.0, 0.5), 0.001) is None
    assert aim((0.0, 0.0, 1.0), (0.0, 0.0, bad), 0.001) is None


def test_from_below_the_table_nothing_is_pointed_at() -> None:
    assert aim((0.0, 0.0, -0.1), (0.0, 0.0, -0.5), 0.001) is None


def test_a_pixel_is_the_tangent_of_half_the_field_of_view_by_half_the_height() -> None:
    assert pixel_angle(math.pi / 2, 500) == pytest.approx(1 / 250)


def test_points_go_to_the_table_and_back() -> None:
    # The towel lies at (-0.7, 0.2), turned by -90 degrees: its x points to the table's -y, its y to the table's x.
    drawing = towel_drawing()
    assert on_table(drawing, [(0.4, 0.3)])[0] == pytest.approx((-0.4, -0.2))
    assert in_article(drawing, (-0.4, -0.2)) == pytest.approx((0.4, 0.3))


def test_the_ground_is_the_table_and_what_hangs_beside_it() -> None:
    table = Table()
    x, y = table.depth_m / 2, table.width_m / 2
    lying = Ground.of(towel_drawing())
    assert (lying.low, lying.high) == ((-x, -y), (x, y))
    # The same towel 0.3 m further to the front: its edge comes to x = -1.0.
    hanging = Ground.of(towel_drawing(placement={"x_m": -1.0, "y_m": 0.2, "yaw_rad": -math.pi / 2}))
    assert hanging.low == pytest.approx((-1.0, -y))
    assert hanging.holds((-0.99, 0.0)) and not lying.holds((-0.99, 0.0))


def test_without_an_outline_the_ground_is_the_table() -> None:
    assert Ground.of(outlined(towel_drawing())).holds((0.0, 0.0))
