"""The time of a reach covers going home from the transfer before, and coming: either may use the other's remainder."""

from dataclasses import replace

import pytest

from planner.motion.act import duration_s, in_turn
from planner.motion.transfer import ReachTime
from planner.planning.found_plan import FoundPlan
from tests.replay.planned import planned


@pytest.mark.parametrize(("before_s", "late_s"), [(0.5, 0.0), (1.1, 0.0), (1.4, 0.3)])
def test_hands_come_in_time_as_long_as_those_before_them_leave_room(before_s: float, late_s: float):
    # 3 s of reach, 0.5 s to close and 0.5 s to open: 2 s for leaving and for coming, which takes 0.9 s.
    reach = ReachTime(coming_s=0.9, leaving_s=0.7, room_s=2.0, share_s=1.25, before_s=before_s)
    assert reach.late_s == pytest.approx(late_s)


@pytest.mark.parametrize("leaving_s", [0.0, 0.7, 1.2, 1.3, 2.0])
@pytest.mark.parametrize("coming_s", [0.2, 0.75, 0.9, 2.4])
def test_with_fixed_shares_reaches_never_take_less(leaving_s: float, coming_s: float):
    one = ReachTime(0.0, leaving_s, 2.5, 1.25, 1.25)
    other = ReachTime(coming_s, 0.0, 2.0, 1.25, 1.25)
    together_s = replace(other, before_s=leaving_s).late_s
    assert together_s <= one.late_at_most_s[1] + other.late_at_most_s[0] + 1e-9


def plan_of(name: str) -> FoundPlan:
    return planned(name).found


@pytest.mark.parametrize("name", ["t-shirt", "scarf"])
def test_each_run_of_a_plan_follows_the_one_before_it(name: str):
    plan = plan_of(name)
    transfers = [act.transfer for act in plan.acts if act.transfer is not None]
    assert [transfer.reach.before_s for transfer in transfers] == [
        0.0,
        *(transfer.reach.leaving_s for transfer in transfers[:-1]),
    ]
    # A plan may take longer by what hands need to speed up and to slow down on their way to the next grips.
    assert duration_s(in_turn(plan.acts)) <= plan.plan.cost_s + 1e-9
    assert duration_s(in_turn(plan.acts)) == pytest.approx(plan.plan.cost_s, abs=0.1)


def test_after_the_last_fold_no_hand_needs_to_go_home():
    *_, last = (act.transfer for act in plan_of("t-shirt").acts if act.transfer is not None)
    assert last.reach.leaving_s == 0.0
