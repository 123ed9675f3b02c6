"""Where hands can end their folds elsewhere than planned."""

from dataclasses import replace

import numpy as np

from app.rehearsal.hand_reach import HandReach
from app.rehearsal.step_motions import step_motions
from planner.task.phase import Hand
from tests.app.rehearsal.towel import towel_plan


def test_a_hand_reaches_what_is_about_where_it_lands_and_nothing_behind_the_robots_back() -> None:
    plan = towel_plan()
    (motion,) = step_motions(plan)
    for grip in motion.grips:
        lands = np.array(grip.points[-1])
        far = lands + np.array([5.0, 0.0, 0.0])
        assert HandReach(plan).ends_in(0, grip.arm, np.array([lands, far])).tolist() == [True, False]


def test_of_a_plan_without_motions_nothing_is_known_to_be_in_reach() -> None:
    plan = replace(towel_plan(), trajectory=None)
    assert not HandReach(plan).ends_in(0, "left", np.zeros((2, 3))).any()


def test_of_a_hand_turned_as_the_robot_turns_none_nothing_is_known_to_be_in_reach() -> None:
    plan = towel_plan()
    path = plan.trajectory
    assert path is not None

    def turned(hand: Hand | None) -> Hand | None:
        return hand and replace(hand, approach=replace(hand.approach, heading_rad=hand.approach.heading_rad + 0.1))

    segments = tuple(
        replace(one, phase=replace(one.phase, hands=tuple(map(turned, one.phase.hands)))) for one in path.segments
    )
    elsewhere = replace(plan, trajectory=replace(path, segments=segments))
    (motion,) = step_motions(plan)
    lands = np.array([motion.grips[0].points[-1]])
    assert not HandReach(elsewhere).ends_in(0, motion.grips[0].arm, lands).any()
