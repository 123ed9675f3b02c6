"""Planning contexts share a cloth memory if all that it depends on is equal, and only then."""

import math
from dataclasses import replace

import numpy as np
import pytest

from planner import Scene
from planner.geometry.pose import Pose2
from planner.geometry.tolerance import grid_key
from planner.primitives.context import Context, cloth_memory
from planner.primitives.fold_trial import fold_trials
from planner.primitives.state import State
from planner.task.reason import Code
from tests.builders import context, fold, garment, rectangle_points

PLACE = Pose2(-0.9, 0.2, -math.pi / 2)
"""A towel there hangs over the near edge."""


def towel(scene: Scene | None = None, placement: Pose2 = PLACE, wide_m: float = 0.4) -> Context:
    half = fold((wide_m, 0.15), (0.0, 0.15))
    return context(garment(rectangle_points(wide_m, 0.3), half, placement=placement), scene=scene or Scene())


def test_equal_contexts_share_what_is_known_and_another_cone_or_cost_changes_nothing_of_it() -> None:
    kept = towel().cloth
    assert towel().cloth is kept
    assert towel(Scene(approach_cone_rad=0.5, arm_motion_s=2.0, base_speed_m_s=0.1)).cloth is kept


@pytest.mark.parametrize(
    "other",
    [
        towel(Scene(friction=0.3)),
        towel(Scene(support_angle_rad=0.0)),
        towel(Scene(table=replace(Scene().table, depth_m=1.5))),
        towel(placement=Pose2(-0.7, 0.2, -math.pi / 2)),
        towel(wide_m=0.5),
    ],
)
def test_a_context_that_differs_in_what_counts_knows_nothing_of_others(other: Context) -> None:
    assert other.cloth is not towel().cloth


def test_a_context_that_forgets_leaves_what_it_found_to_the_next() -> None:
    first = towel()
    found = first.stability_violation(0, (0.1, 0.0)), fold_trials(first, State(0, (0.1, 0.0), 0, 0), 0)
    first.forget()
    next_one = towel()
    assert (0, grid_key(0.1), 0) in next_one.cloth.stability_violation
    assert next_one.stability_violation(0, (0.1, 0.0)) == found[0]
    assert fold_trials(next_one, State(0, (0.1, 0.0), 0, 0), 0)[0].tools is found[1][0].tools


def test_hands_that_are_known_are_those_found_anew() -> None:
    there = State(0, (0.25, 0.0), 0, 3)
    fold_trials(towel(Scene(approach_cone_rad=0.1)), there, 0)
    known = fold_trials(towel(), there, 0)
    cloth_memory.cache_clear()
    anew = fold_trials(towel(), there, 0)
    assert len(known) == len(anew) > 0
    for one, other in zip(known, anew, strict=True):
        assert (one.arms, one.cover) == (other.arms, other.cover)
        np.testing.assert_array_equal(one.tools, other.tools)
        for approaches, others in zip(one.approaches, other.approaches, strict=True):
            np.testing.assert_array_equal(approaches, others)


def test_why_there_are_no_hands_is_noted_in_each_context() -> None:
    for _ in range(2):
        near = towel(wide_m=0.4)
        wide = Context(near.sequence, near.scene, near.reach, PLACE, near.circle_m, grips_apart_m=2.0)
        assert fold_trials(near, State(0, (0.3, 0.0), 0, 0), 0)
        assert not fold_trials(wide, State(0, (0.3, 0.0), 0, 0), 0)
        assert Code.GRIPS_TOO_CLOSE in wide.obstacles.codes(0)
