import numpy as np
import pytest

from app.overlays.moment import Moment
from app.overlays.slip import CutCloth, limit_m, slip_overlay
from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import TableInGarment, stability_violation
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.pose import Point2, Pose2
from planner.geometry.segment import Segment
from planner.task.scene import DEFAULT_STATIONS, Scene
from tests.builders import rectangle_points, spread

# A line along x; what lies to its right is below it.
EDGE = Segment((0.0, 0.0), (1.0, 0.0))


def lying(cloth: ClothState, placement: Pose2, friction: float = 1.0) -> Moment:
    scene = Scene(friction=friction)
    return Moment("pr2", scene, 0.03, DEFAULT_STATIONS["front"], "front", 0.0, placement, cloth)


def folded_over(width_m: float, length_m: float, at_m: float) -> ClothState:
    """Return a strip from y = 0 to its length, with the part below `at_m` folded up over it."""
    return fold_cloth(spread(rectangle_points(width_m, length_m)), Segment((width_m, at_m), (0.0, at_m)), "blue").cloth


def test_the_area_beyond_a_line_counts_every_layer() -> None:
    # A strip 0.4 m wide and 1 m long; its lowest 0.3 m lie on the next 0.3 m, so from 0.3 to 0.6 there are two layers.
    cloth = CutCloth.of(folded_over(0.4, 1.0, 0.3))
    assert cloth.area_beyond(Segment((0.0, 0.5), (1.0, 0.5))) == pytest.approx(0.4 * 0.2 * 2)
    assert cloth.area_beyond(Segment((0.0, 0.7), (1.0, 0.7))) == pytest.approx(0.4 * (0.3 * 2 + 0.1))
    assert cloth.area_beyond(Segment((0.0, 2.0), (1.0, 2.0))) == pytest.approx(0.4)
    assert cloth.area_beyond(EDGE) == 0.0


def test_the_area_beyond_a_slanted_line_is_that_of_the_corner_it_cuts_off() -> None:
    # The line from (0, 0.2) to (0.2, 0) cuts a triangle of legs 0.2 off a square.
    cloth = CutCloth.of(spread(rectangle_points(0.4, 0.4)))
    assert cloth.area_beyond(Segment((0.0, 0.2), (0.2, 0.0))) == pytest.approx(0.02)


@pytest.mark.parametrize(("friction", "hanging_m"), [(1.0, 0.5), (0.5, 1 / 3), (3.0, 0.75), (0.0, 0.0)])
def test_a_strip_may_hang_by_its_share_of_friction(friction: float, hanging_m: float) -> None:
    # Of a strip of 1 m, mu / (1 + mu) may hang.
    cloth = CutCloth.of(spread(rectangle_points(0.4, 1.0)))
    assert limit_m(cloth, EDGE, friction) == pytest.approx(-hanging_m, abs=1e-5)


def test_where_the_cloth_lies_double_less_of_it_may_hang() -> None:
    # The strip above weighs 1.0: 0.6 in the double part, 0.4 beyond. Half of that, 0.5, is 0.25 m of the double part.
    cloth = CutCloth.of(folded_over(0.4, 1.0, 0.3))
    assert limit_m(cloth, EDGE, 1.0) == pytest.approx(-(0.3 + 0.25), abs=1e-5)


def test_the_lines_are_where_the_planner_says_that_the_cloth_slips() -> None:
    # Stiff cloth, so that it is the friction alone that is asked for.
    scene, cloth = Scene(friction=0.6, support_angle_rad=1.4), folded_over(0.4, 0.5, 0.2)
    for limit in slip_overlay(lying(cloth, Pose2(0.0, 0.0, 0.3), 0.6)).limits:
        # Laid so that the line is on its edge, the cloth is about to slip: 4 mm further out it does.
        for further, is_at_rest in ((-0.004, True), (0.004, False)):
            placement = laid(limit.edge, list(limit.line), further, scene)
            top = TableInGarment.seen_from(placement, scene.table)
            found = stability_violation(cloth, top, scene.friction, scene.support_angle_rad)
            assert (found is None) == is_at_rest, limit.edge
            assert found is None or found.code == "slips"


def laid(edge: str, line: list[Point2], further_m: float, scene: Scene) -> Pose2:
    """Return the placement that puts the middle of a line on that of a table edge, and the cloth further out."""
    outwards = {"right": (0.0, -1.0), "far": (1.0, 0.0), "left": (0.0, 1.0), "near": (-1.0, 0.0)}[edge]
    half = scene.table.depth_m / 2 if outwards[0] else scene.table.width_m / 2
    target = np.array(outwards) * (half + further_m)
    turned = Pose2(0.0, 0.0, 0.3)
    x, y = target - turned.to_outer(np.mean(line, axis=0))
    return Pose2(float(x), float(y), 0.3)


def test_what_hangs_now_is_told_by_the_edge() -> None:
    # 0.4 m wide, 1 m long, garment and table frames parallel: its lowest y is 0.2 m beyond the right edge at -0.49.
    told = slip_overlay(lying(spread(rectangle_points(0.4, 0.8)), Pose2(0.0, -0.69, 0.0)))
    assert told.hanging_m2 == pytest.approx({"right": 0.08, "far": 0.0, "left": 0.0, "near": 0.0})
    assert (told.lying_m2, told.pull_m2) == pytest.approx((0.24, 0.08))
    assert told.holds
    right = next(limit for limit in told.limits if limit.edge == "right")
    assert (right.now_m, right.at_m) == pytest.approx((0.2, 0.4), abs=1e-5)
    assert np.allclose(sorted(right.line), [(0.0, 0.4), (0.4, 0.4)], atol=1e-5)


def test_what_hangs_over_opposite_edges_balances() -> None:
    # A runner 0.2 m wide and 1.4 m long across the table, 0.21 m over either edge.
    told = slip_overlay(lying(spread(rectangle_points(0.2, 1.4)), Pose2(0.0, -0.7, 0.0), 0.01))
    assert told.hanging_m2["left"] == pytest.approx(told.hanging_m2["right"]) == pytest.approx(0.042)
    assert told.pull_m2 == pytest.approx(0.0, abs=1e-9)
    assert told.holds
