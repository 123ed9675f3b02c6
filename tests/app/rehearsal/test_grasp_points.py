"""Where hands take a stack as it was seen, and which edges they lay down short."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.corrections import SHORT_M, laid_short
from app.rehearsal.grasp_points import INSIDE_M, are_edges_hidden, at_layered_corners, inside, inwards_at, where_seen
from app.rehearsal.step_motions import step_motions
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.vision.fit_fold import FoldedOutline
from app.rehearsal.vision.seen_stack import SeenStack
from app.rehearsal.vision.stack_figure import Figure
from app.rehearsal.world import StepMotion
from planner import Plan
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.task.plan import PlanStep
from planner.task.world_state import Holding
from tests.builders import evenly_along
from tests.replay.planned import shipped_plan


def seen_before(plan: Plan, step: PlanStep, stack: SeenStack | None, carried_m: float = 0.0) -> StepSeen:
    """Return a step and the stack seen before it, which lies that far from where it should."""
    return StepSeen(plan, step, step_motions(plan)[0], Isometry.rotation(0.0, carried_m), stack)


def test_a_part_that_moved_last_is_taken_where_it_was_seen() -> None:
    # The near half was folded up at y = .25 m. With its crease 4 mm to the left of the line, towards y = 0, its edge is
    # 8 mm short. The garment is turned by -90 degrees: its -y is -x of the table.
    plan = shipped_plan("letter-towel")
    folded = FoldedOutline(plan.sequence, 0, 0)
    seen = SeenStack(Figure.of(plan.sequence.cloth(1)), folded, np.array([0, 0, 0, 0.004, 0, 0.0]), np.eye(6))
    step = replace(plan.steps[0], holdings=(Holding("left", (0.4, 0.5), ()), Holding("right", (0.1, 0.1), ())))
    offsets = where_seen(seen_before(plan, step, seen))
    assert offsets["left"] == pytest.approx((-0.008, 0.0), abs=1e-6)
    assert offsets["right"] == (0.0, 0.0)  # not on the part that moved
    radius_m = plan.task.limits.comfort_radius_m  # no further than is in reach
    assert where_seen(seen_before(plan, step, seen, radius_m))["left"] == pytest.approx((0.0, 0.0))
    assert where_seen(seen_before(plan, step, None)) == {}


def test_a_hand_takes_an_edge_where_it_is_seen() -> None:
    # The crease, at y = .25 m, is seen 9 mm inside of its line, 4 mm at the other end; the rest is where it should be.
    plan = shipped_plan("letter-towel")
    ring = plan.sequence.cloth(1).silhouette.ring
    (left, crease_y), (right, far_y) = ring.min(axis=0).tolist(), ring.max(axis=0).tolist()
    outline = evenly_along(ring, 0.003)
    at_crease = outline[:, 1] < crease_y + 1e-6
    outline[at_crease, 1] += np.interp(outline[at_crease, 0], [left, right], [0.004, 0.009])
    figure, folded = Figure.of(plan.sequence.cloth(1)), FoldedOutline(plan.sequence, 0, 0)
    lies = plan.task.start.placement
    row = np.array([*figure.fit_at(lies).row, 0.0, 0.0, 0.0])
    seen = SeenStack(figure, folded, row, np.eye(6), lies.to_outer(outline))
    step = replace(
        plan.steps[0],
        holdings=(
            Holding("middle", ((left + right) / 2.0, crease_y), ()),
            Holding("corner", (right, crease_y), ()),
            Holding("edge", (right, far_y - 0.05), ()),
            Holding("inside", (left + 0.1, crease_y + 0.1), ()),
        ),
    )
    offsets = where_seen(seen_before(plan, step, seen))
    assert step.before.placement.yaw_rad == pytest.approx(-math.pi / 2.0)  # the garment's y is the table's x
    assert offsets["middle"] == pytest.approx((0.0065, 0.0), abs=1e-3)
    assert offsets["corner"] == pytest.approx((0.009, 0.0), abs=1.5e-3)
    assert offsets["edge"] == pytest.approx((0.0, 0.0), abs=1e-4)
    assert offsets["inside"] == pytest.approx((0.0, 0.0), abs=1e-9)


def test_hands_take_corners_of_several_layers_inside_of_where_they_are_seen_as_far_as_that_is_in_reach() -> None:
    plan = shipped_plan("letter-towel")
    step, turned = plan.steps[0], Isometry.rotation(0.1)
    inwards = inwards_at(StepSeen(plan, step, step_motions(plan)[0], turned))
    middle, lies = plan.garment.pattern.ring.mean(axis=0), step.before.placement
    for one in step.holdings:  # of a rectangle: along the bisectors of its corners
        corner, centre = turned.apply(lies.to_outer(np.array([one.point, middle])))
        assert np.dot(inwards[one.arm], centre - corner) > 0.2
        assert math.hypot(*inwards[one.arm]) == pytest.approx(1.0)
    assert at_layered_corners(step, plan.sequence) == frozenset()  # one layer
    assert at_layered_corners(replace(step, holdings=()), plan.sequence) == frozenset()
    skirt = shipped_plan("skirt")
    taken = [sorted(at_layered_corners(one, skirt.sequence)) for one in skirt.steps]
    assert taken == [[], [], ["right"], ["left"]]  # tips, then a corner
    (tip,) = skirt.steps[2].holdings
    along = replace(tip, point=(tip.point[0], tip.point[1] - 0.05))  # 5 cm from the tips, along the waist or the hem
    assert at_layered_corners(replace(skirt.steps[2], holdings=(along,)), skirt.sequence) == frozenset()
    vest = shipped_plan("vest")  # folded in half, then both layers by their corners
    assert [sorted(at_layered_corners(one, vest.sequence)) for one in vest.steps] == [[], ["left", "right"]]
    pulled = replace(vest.steps[1], holdings=(Holding("left", vest.steps[1].holdings[0].point, ()),))
    assert at_layered_corners(pulled, vest.sequence) == frozenset()  # it holds no corner
    seen = {"left": (0.0, 0.004)}
    found = inside(seen, {"left": (0.0, 1.0), "right": (1.0, 0.0)}, 0.03)
    assert found["left"] == pytest.approx((0.0, 0.004 + INSIDE_M))
    assert found["right"] == pytest.approx((INSIDE_M, 0.0))
    assert inside(seen, {"left": (0.0, 1.0)}, 0.006)["left"] == pytest.approx((0.0, 0.006))
    assert inside(seen, {}, 0.03) == {"left": pytest.approx((0.0, 0.004))}  # not at an edge


def test_an_edge_of_which_nothing_was_seen_is_hidden() -> None:
    # An arm hides what is within 8 cm of the middle of the crease.
    plan = shipped_plan("letter-towel")
    ring = plan.sequence.cloth(1).silhouette.ring
    (left, crease_y), (right, _) = ring.min(axis=0).tolist(), ring.max(axis=0).tolist()
    middle, inside = ((left + right) / 2.0, crease_y), ((left + right) / 2.0, crease_y + 0.1)
    figure, folded = Figure.of(plan.sequence.cloth(1)), FoldedOutline(plan.sequence, 0, 0)
    lies = plan.task.start.placement
    outline = evenly_along(ring, 0.003)
    outline = outline[np.hypot(*(outline - np.array(middle)).T) > 0.08]
    row = np.array([*figure.fit_at(lies).row, 0.0, 0.0, 0.0])
    seen = SeenStack(figure, folded, row, np.eye(6), lies.to_outer(outline))

    def taken_at(*points: Point2) -> PlanStep:
        return replace(plan.steps[0], holdings=tuple(Holding("left", point, ()) for point in points))

    assert are_edges_hidden(taken_at((right, crease_y), middle), seen)
    assert not are_edges_hidden(taken_at((right, crease_y)), seen)
    assert not are_edges_hidden(taken_at(inside), seen)  # not an edge
    assert not are_edges_hidden(taken_at(), seen)
    assert not are_edges_hidden(taken_at(middle), None)


def test_an_edge_that_the_same_hands_lift_again_lands_short_and_others_where_they_should() -> None:
    plan = shipped_plan("letter-towel")
    blue, red = plan.steps
    motion = step_motions(plan)[1]

    def made(step: PlanStep, of: Plan = plan) -> StepMotion:
        return laid_short(motion, StepSeen(of, step, motion))

    assert made(replace(blue, details={"fold": 0})) == motion
    assert made(red) == motion  # it goes on from there
    scarf = shipped_plan("scarf")  # in quarters, so that edges lie upon the stack
    assert all(made(step, scarf) == motion for step in scarf.steps)
    one_hand = replace(blue, holdings=tuple(one for one in blue.holdings if one.arm == "left"))
    for grip, former in zip(made(one_hand).grips, motion.grips, strict=True):
        assert grip.points[0] == former.points[0]
        short = np.subtract(grip.points[-1], former.points[-1])
        back = np.subtract(former.points[0], former.points[-1])
        expected = SHORT_M if grip.arm == "left" else 0.0
        assert short == pytest.approx(expected * back / np.linalg.norm(back), abs=1e-4)
