"""Hands that take cloth that hangs over the table's edge."""

from random import Random

import pytest

from planner.motion.hand_holds import usual_holds
from planner.planning.found_plan import FoundPlan
from planner.planning.plan_check import require_replay
from planner.robots.card import EDGE_OPEN_M
from tests.laws.wear import wear_task
from tests.planning.found import found_plan


@pytest.fixture(scope="module")
def hood() -> FoundPlan:
    task = wear_task(Random(911))
    return found_plan(task.garment, task.scene, time_limit_s=60.0, work_limit_s=2.0)


def test_a_garment_that_hangs_is_folded_without_driving_round_the_table(hood: FoundPlan) -> None:
    # Fingers taken to be wide open while they hold would meet the table's edge: two drives, 43 s more.
    assert hood.plan.is_solved and not any(step.kind == "move" for step in hood.plan.steps)
    assert any(grip.pick[2] < -0.05 for step in hood.plan.steps for grip in step.grips)
    require_replay(hood.plan)


def test_only_hands_at_hanging_cloth_may_open_narrowly(hood: FoundPlan) -> None:
    height_m = hood.context.scene.table.height_m
    counts = [0, 0]
    for plan_segment in hood.plan_segments:
        if plan_segment.transfer is None:
            continue
        waypoints = plan_segment.transfer.transfer_path.waypoints
        *_, last = usual_holds(waypoints, height_m)
        for arm in waypoints.is_used.nonzero()[0].tolist():
            heights_m = waypoints.positions[arm, waypoints.is_held[arm], 2][[0, -1]] - height_m
            hangs = bool(heights_m.min() < 0.019)
            counts[hangs] += 1
            assert (last[arm].opening_m <= EDGE_OPEN_M) == hangs
    assert min(counts) > 0
