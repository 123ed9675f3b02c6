"""Where a drag's hands hold on for a fold, ways in which they need not turn in their grip are tried first."""

import math
from itertools import pairwise

import pytest

from planner import Scene, Task, load_garment
from planner.motion.transfer_candidate import QUICK, ways_of
from planner.planning.found_plan import FoundPlan
from planner.plans import find_plan
from planner.primitives.primitive import Step


@pytest.fixture(scope="module")
def found() -> FoundPlan:
    return find_plan(Task.of(load_garment("scarf")))


def dragged_and_folded(found: FoundPlan) -> tuple[Step, ...]:
    steps = found.plan_segments[0].steps
    assert [step.kind for step in steps] == ["drag", "fold"]
    return steps


def test_a_scarf_dragged_and_folded_is_held_at_both_corners_and_no_hand_is_late(found: FoundPlan) -> None:
    # One hand in the middle of its end lets its corners, 12.7 cm away, fold under.
    assert [len(step.grips) for plan_segment in found.plan_segments for step in plan_segment.steps] == [2, 2, 2, 2]
    # Each drag takes one arm motion, each fold of what is held two; drags by 40 and 10 cm go from rest to rest.
    speed, hard = Scene().base_speed_m_s, 0.5
    dragging_s = 0.4 / speed + speed / hard + 2.0 * math.sqrt(0.1 / hard)
    stands = [0.0, *(step.after.base.back_off_m for step in found.plan.steps)]
    driven_m = sum(abs(end - start) for start, end in pairwise(stands)) - 0.4 - 0.1
    assert found.plan.is_proven
    assert found.plan.cost_s == pytest.approx(6 * Scene().arm_motion_s + dragging_s + driven_m / speed, abs=1e-6)


def test_ways_in_which_hands_hold_on_as_the_fold_needs_them_come_right_after_the_first(found: FoundPlan) -> None:
    drag, fold = dragged_and_folded(found)
    turned_away = next(variant for variant in drag.variants() if variant.turns != fold.turns)
    ways = list(ways_of((turned_away, fold), QUICK))
    assert ways[0] == (turned_away, fold)
    assert ways[1][0].turns == fold.turns and ways[1][1].motion == fold.motion
    assert all(one.turns == other.turns for one, other in ways[2:4])
    keys = [tuple(step.motion for step in way) for way in ways]
    assert len(keys) == len(set(keys)) <= QUICK.ways


def test_a_drag_is_turned_only_as_its_hands_can_be_and_are_not(found: FoundPlan) -> None:
    drag, fold = dragged_and_folded(found)
    other = next(variant for variant in drag.variants() if variant.turns != drag.turns)
    (back,) = other.turned(drag.turns)
    assert back.turns == drag.turns
    assert list(drag.turned(drag.turns)) == [] == list(drag.turned({}))
    assert list(fold.turned(drag.turns)) == []
