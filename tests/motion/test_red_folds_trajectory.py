"""Plans with red folds: each replays, and its trajectory shows the right hands and cloth."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from planner import Plan, make_plan
from planner.geometry.pose import FloatArray
from planner.motion.cloth_surface import ClothSurface
from planner.motion.joint_trajectory import CLOSED_M, OPEN_M
from planner.motion.timeline import Timeline
from planner.task.plan import PlanStep
from tests.planning.red_towels import BACK, CORNER, OUT, OVER, TWO_SIDES, towel
from tests.replay.checker import check
from tests.required import required

RELEASE_S = 0.5
LAYER_M = 0.002
"""The height of a layer: 1 mm of cloth and 1 mm of air."""


@cache
def planned_chain() -> Plan:
    """Plan the towel's chain of two red folds for a PR2."""
    return make_plan(towel(OVER, BACK, OUT), time_limit_s=60.0)


@cache
def planned_corner() -> Plan:
    return make_plan(towel(OVER, CORNER), time_limit_s=60.0)


@cache
def planned_sides() -> Plan:
    return make_plan(TWO_SIDES, time_limit_s=60.0)


@pytest.mark.parametrize("planned", [planned_chain, planned_corner, planned_sides])
def test_plans_with_chains_replay(planned: Callable[[], Plan]) -> None:
    plan = planned()
    check(plan.garment.to_dict(), plan.scene.to_dict(), plan.to_dict())


def openings(plan: Plan, t_s: float) -> dict[str, float]:
    return {track.arm: track.opening_at(t_s) for track in required(plan.trajectory).grippers}


def performed(plan: Plan, index: int) -> PlanStep:
    """Return the step that performs a fold."""
    return next(step for step in plan.steps if step.fold == index)


def span(plan: Plan, index: int) -> tuple[float, float]:
    """Return the times at which a fold begins and ends (s)."""
    step = performed(plan, index)
    return step.start_s, step.end_s


def test_the_hands_stay_closed_from_the_blue_folds_grasp_to_the_end_of_the_chain() -> None:
    plan = planned_chain()
    assert set(openings(plan, 0.0).values()) == {OPEN_M}
    end = span(plan, 2)[1]
    grasped = next(t for t in np.arange(0.0, end, 0.05) if max(openings(plan, t).values()) <= CLOSED_M)
    assert grasped < span(plan, 0)[1] - 6.0 + 0.05, "the blue fold's two motions along its path come after the grasp"
    for t_s in np.arange(grasped, end - RELEASE_S, 0.05):
        assert set(openings(plan, float(t_s)).values()) == {CLOSED_M}


def test_the_hand_that_is_not_needed_opens_as_the_red_fold_begins_and_the_other_does_not() -> None:
    plan = planned_corner()
    start, end = span(plan, 1)
    for t_s in np.arange(start + RELEASE_S, end - RELEASE_S, 0.05):
        found = openings(plan, float(t_s))
        assert found["left"] == pytest.approx(OPEN_M) and found["right"] == pytest.approx(CLOSED_M)


@pytest.mark.parametrize(("planned", "last"), [(planned_chain, 2), (planned_corner, 1), (planned_sides, 1)])
def test_the_hands_are_open_once_the_chain_is_done(planned: Callable[[], Plan], last: int) -> None:
    plan = planned()
    assert openings(plan, span(plan, last)[1]) == {"left": pytest.approx(OPEN_M), "right": pytest.approx(OPEN_M)}


def corners(surface: ClothSurface, below: int) -> FloatArray:
    """Return the distinct corners of the layers below one, sorted, shape (n, 3), m."""
    shown = surface.vertices[surface.triangles[surface.layers < below]].reshape(-1, 3)
    return np.unique(np.round(shown, 6), axis=0)


@pytest.mark.parametrize(("number", "staying", "depth_m"), [(1, 2, 0.1), (2, 3, 0.05)])
def test_while_a_red_fold_is_made_only_the_last_flap_moves(number: int, staying: int, depth_m: float) -> None:
    # Layers: 0 the towel, 1 the first flap's rest, 2 (and for the last fold 3) what moves. It stands up over
    # its line as high as it is deep, and no higher.
    plan = planned_chain()
    start, end = span(plan, number)
    at_rest = corners(Timeline.of(plan).at(end - 1e-6).cloth, staying)
    # A fold may begin with the wrists turning in their grips: then nothing of it moves yet.
    for t_s in np.linspace(start + 0.2 * (end - start), end - 1e-6, 40):
        surface = Timeline.of(plan).at(float(t_s)).cloth
        np.testing.assert_allclose(corners(surface, staying), at_rest, atol=2e-6)
        assert surface.vertices[:, 2].max() <= depth_m + 1e-6
    heights = [Timeline.of(plan).at(float(t)).cloth.vertices[:, 2].max() for t in np.linspace(start, end, 300)]
    assert max(heights) == pytest.approx(depth_m, abs=2e-3)


def test_below_a_red_fold_the_cloth_lies_as_it_lay_before() -> None:
    plan = planned_chain()
    lay = Timeline.of(plan).at(span(plan, 0)[1] - 1e-6).cloth
    lies = Timeline.of(plan).at(span(plan, 1)[1] - 1e-6).cloth
    np.testing.assert_allclose(corners(lies, 1), corners(lay, 1), atol=2e-6)
    # The flap lay from its crease, y = 0.25, to y = 0.5; what is left of it ends at the new crease, y = 0.4.
    origin = performed(plan, 0).after.placement.x_m
    for surface, far in ((lay, 0.5), (lies, 0.4)):
        flap = surface.vertices[surface.triangles[surface.layers == 1]].reshape(-1, 3)
        assert (flap[:, 0].min(), flap[:, 0].max()) == pytest.approx((origin + 0.25, origin + far), abs=1e-5)


def test_at_the_end_the_layers_lie_above_one_another_in_the_order_of_the_folds() -> None:
    plan = planned_chain()
    end = Timeline.of(plan).at(required(plan.cost_s)).cloth
    for layer in range(4):
        heights = end.vertices[end.triangles[end.layers == layer]][..., 2]
        assert heights == pytest.approx(np.full_like(heights, (layer + 1) * LAYER_M), abs=1e-6)
