import math

import pytest

from app.ui.viewpoints.presets import Ground, on_table
from planner.geometry.table import Table
from tests.app.drawing.drawings import outlined, towel_drawing


def test_points_go_to_the_table() -> None:
    # The towel lies at (-0.7, 0.2), turned by -90 degrees: its x points to the table's -y, its y to the table's x.
    assert on_table(towel_drawing(), [(0.4, 0.3)])[0] == pytest.approx((-0.4, -0.2))


def test_the_ground_is_the_table_and_what_hangs_beside_it() -> None:
    table = Table()
    x, y = table.depth_m / 2, table.width_m / 2
    lying = Ground.of(towel_drawing())
    assert (lying.low, lying.high) == ((-x, -y), (x, y))
    # The same towel 0.3 m further to the front: its edge comes to x = -1.0.
    hanging = Ground.of(towel_drawing(placement={"x_m": -1.0, "y_m": 0.2, "yaw_rad": -math.pi / 2}))
    assert hanging.low == pytest.approx((-1.0, -y))


def test_without_an_outline_the_ground_is_the_table() -> None:
    table = Table()
    assert Ground.of(outlined(towel_drawing())).high == (table.depth_m / 2, table.width_m / 2)
