"""Checks before arms are led: whether they can be at a transfer's start and end, and follow its path."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.table import Table
from planner.motion.transfer_candidate import QUICK
from planner.motion.transfer_planner import TransferPlanner
from planner.motion.waypoints import waypoints_of
from planner.planning.problem import Problem
from planner.robots.pr2.robot import Pr2
from tests.replay.planned import planned


@pytest.mark.parametrize("name", ["t-shirt", "tie", "letter-towel", "big-towel"])
def test_a_run_begins_and_ends_where_its_extremes_are(name: str) -> None:
    found = planned(name).found
    for plan_segment in (plan_segment for plan_segment in found.plan_segments if plan_segment.transfer is not None):
        whole = Problem.of(found.plan.task).maker.candidate(plan_segment.steps).waypoints
        phases = [phase for step in plan_segment.steps for phase in step.extremes()]
        ends = waypoints_of(phases, found.plan.scene.table.height_m)
        for waypoint in (0, -1):
            np.testing.assert_allclose(ends.bases[waypoint], whole.bases[waypoint], atol=1e-9)
            np.testing.assert_allclose(ends.positions[:, waypoint], whole.positions[:, waypoint], atol=1e-9)
            np.testing.assert_allclose(ends.rotations[:, waypoint], whole.rotations[:, waypoint], atol=1e-9)


def test_what_was_made_real_is_a_candidate() -> None:
    found = planned("t-shirt").found
    transfers = [plan_segment.steps for plan_segment in found.plan_segments if plan_segment.transfer is not None]
    assert [candidate.steps for candidate in Problem.of(found.plan.task).maker.candidates(transfers)] == transfers


class UnderCeiling(Pr2):
    """A PR2 whose hands must stay below a height over the table (m)."""

    def __init__(self, height_m: float) -> None:
        super().__init__()
        self._height_m = height_m

    def collisions(self, table: Table, torso_m: float, *args: Any, **options: Any) -> Any:
        real = super().collisions(table, torso_m, *args, **options)
        anywhere, most_m = real.arm_free, table.height_m + self._height_m

        def arm_free(arm: int, bases: Any, joints: FloatArray) -> BoolArray:
            is_low = [self.tool_pose(arm, one, torso_m)[0][2] < most_m for one in joints]
            return np.asarray(anywhere(arm, bases, joints) & np.array(is_low, dtype=bool))

        real.arm_free = arm_free  # type: ignore[method-assign]
        return real


def test_where_one_got_stuck_others_that_do_the_same_are_looked_at_first() -> None:
    # The skirt's second fold lifts its cloth higher than that on its way; it begins and ends on the table. One hand
    # does it: only where it begins and ends is looked at unless a fold of its kind got stuck.
    found = planned("skirt").found
    steps = found.plan_segments[1].steps
    waypoints = Problem.of(found.plan.task).maker.candidate(steps).waypoints
    assert waypoints.is_held.any(axis=1).sum() == 1
    assert np.nanmax(waypoints.positions[..., 2]) > found.plan.scene.table.height_m + 0.2
    maker = TransferPlanner(found.context, UnderCeiling(0.2))
    assert [candidate.steps for candidate in maker.candidates([steps])] == [steps]
    assert maker.validated(steps, replace(QUICK, ways=1)) is None
    assert list(maker.candidates([steps])) == []
