"""Transits: planned once, part of the segments' durations, joined to the transfers on both sides; where the base is."""

from itertools import pairwise

import numpy as np
import pytest

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table, TableTop
from planner.motion.lying_cloth import LyingCloth
from planner.motion.plan_segment import PlanSegment, duration_s, linked
from planner.motion.timed_phase import TimedPhase, TransitTime
from planner.motion.transit_planner import TransitPlanner
from planner.planning.found_plan import FoundPlan
from planner.planning.problem import Problem
from planner.task.trajectory import ClothMotion, Phase
from tests.replay.planned import planned


def plan_of(name: str) -> FoundPlan:
    return planned(name).found


def transferring(plan: FoundPlan) -> list[PlanSegment]:
    return [plan_segment for plan_segment in plan.plan_segments if plan_segment.transfer is not None]


@pytest.mark.parametrize("name", ["t-shirt", "scarf", "big-towel"])
def test_acts_take_as_long_as_the_plan_that_is_made_of_them(name: str) -> None:
    plan = plan_of(name)
    assert duration_s(plan.plan_segments) == pytest.approx(plan.plan.cost_s, abs=1e-6)
    assert duration_s(linked(plan.plan_segments, Problem.of(plan.plan.task).maker)) == pytest.approx(
        plan.plan.cost_s, abs=1e-6
    )


@pytest.mark.parametrize("name", ["t-shirt", "big-towel"])
def test_hands_go_from_one_transfer_to_the_next(name: str) -> None:
    plan_segments = transferring(plan_of(name))
    for before, plan_segment in pairwise(plan_segments):
        assert plan_segment.transit is not None and before.transfer is not None and plan_segment.transfer is not None
        times_s, joints, _ = plan_segment.transit.keyframes
        assert times_s[0] >= 0.0 and np.diff(times_s).min() > -1e-9
        assert times_s[-1] == pytest.approx(plan_segment.transit.duration_s)
        approach = plan_segment.transfer.approach
        there_rad = (
            approach.joints[-1] if approach.at_grips is None else approach.at_grips
        )  # where fingers close, at an edge
        turns = (joints[-1] - there_rad) / (2.0 * np.pi)
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
        drives = [timed for timed in plan_segment.transit.timed_phases if not any(timed.phase.hands)]
        there = [*(timed.phase.base for timed in drives), plan_segment.transit.timed_phases[-1].phase.base]
        assert there[0][0] == before.transfer.steps[-1].phases[-1].base[1]


def test_a_transit_is_planned_once_for_the_same_steps() -> None:
    plan = plan_of("t-shirt")
    maker = Problem.of(plan.plan.task).maker
    first, second = (linked(plan.plan_segments, maker) for _ in range(2))
    assert [plan_segment.transit for plan_segment in first] == [plan_segment.transit for plan_segment in second]
    assert maker.transits_planned == len(transferring(plan))


def test_a_transit_depends_on_where_the_hands_come_from() -> None:
    plan_segments = transferring(plan_of("t-shirt"))
    maker = Problem.of(plan_of("t-shirt").plan.task).maker
    assert plan_segments[1].transfer is not None
    from_home = maker.transit(None, (), plan_segments[1].transfer)
    after_first = maker.transit(plan_segments[0].transfer, (), plan_segments[1].transfer)
    assert from_home is not None and after_first is not None and from_home is not after_first
    assert maker.transits_planned == 2


def test_shortcuts_of_a_late_transit_are_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    plan_segments = transferring(plan_of("t-shirt"))
    maker = Problem.of(plan_of("t-shirt").plan.task).maker
    monkeypatch.setattr(maker.transits, "is_clear", lambda *_: False)
    before, after = plan_segments[0].transfer, plan_segments[1].transfer
    assert before is not None and after is not None
    late = maker.transit(before, (), after)
    assert late is not None and late.late_s > 0.0 and maker.transits_planned == 1
    hastened = maker.transit(before, (), after, hastens=True)
    assert hastened is not None and hastened.late_s == pytest.approx(late.late_s) and maker.transits_planned == 2
    assert maker.transit(before, (), after, hastens=True) is hastened is maker.transit(before, (), after)
    assert maker.transits_planned == 2


def test_a_base_waits_while_hands_withdraw_that_it_would_sweep_along(monkeypatch: pytest.MonkeyPatch) -> None:
    plan_segments = transferring(plan_of("t-shirt"))
    maker = Problem.of(plan_of("t-shirt").plan.task).maker
    before, driven = next(
        (before.transfer, after.transfer)
        for before, after in pairwise(plan_segments)
        if after.transit is not None and len(after.transit.timed_phases) == 2 and after.late_s == 0.0
    )
    assert before is not None and driven is not None
    withdrawn = before.retreat.joints[-1]

    def stands_first(cloth: LyingCloth, bases: FloatArray, joints: FloatArray, openings_m: FloatArray) -> bool:
        low = int(np.abs(joints - withdrawn).max(axis=1).argmin())
        return bool(np.allclose(bases[: low + 1], bases[0]))

    monkeypatch.setattr(maker.transits, "is_clear", stands_first)
    transit = maker.transit(before, (), driven)
    assert transit is not None and transit.late_s == 0.0
    wait, drive, _ = transit.timed_phases
    assert wait.phase.base[0] == wait.phase.base[1] and drive.phase.base[0] != drive.phase.base[1]
    assert wait.duration_s == pytest.approx(before.retreat.shortest_s)


def test_a_detour_that_takes_too_long_is_led_as_near_to_the_straight_path_as_is_clear(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plan_segments = transferring(plan_of("t-shirt"))
    maker = Problem.of(plan_of("t-shirt").plan.task).maker
    before, after = plan_segments[0].transfer, plan_segments[1].transfer
    assert before is not None and after is not None and after.transfer_path.cloths[0] is not None
    start = before.retreat.joints[-1]
    goal = maker.transits.unwound(after.approach.joints[0], start)

    def aside(joints: FloatArray) -> float:
        along = np.clip((joints - start) @ (goal - start) / ((goal - start) @ (goal - start)), 0.0, 1.0)
        return float(np.linalg.norm(joints - start - along[:, None] * (goal - start), axis=1).max())

    home = maker.transits.unwound(maker.transits.home, start)
    ends = max(aside(before.retreat.joints), aside(after.approach.joints + goal - after.approach.joints[0]))
    far_enough = ends + 0.2 * (aside(home[None]) - ends)
    monkeypatch.setattr(maker.transits, "is_clear", lambda cloth, bases, joints, openings_m: aside(joints) > far_enough)
    reach = TimedPhase.even(0, after.free_phases[-1], 1.5)
    free = TransitTime([reach], after.transfer_path.cloths[0])

    def lasts_s() -> float:
        planner = TransitPlanner(maker.transits, maker.dwell_s)
        return planner.keyframes(free, before.retreat, after.approach, before.going, after.coming)[0].end_s

    near_s = lasts_s()
    monkeypatch.setattr("planner.motion.transit_planner._STRAIGHTENED", 0)
    assert near_s < lasts_s() - 0.1


def test_an_arm_in_nobodys_way_does_not_share_the_detour_of_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    plan_segments = transferring(plan_of("t-shirt"))
    maker = Problem.of(plan_of("t-shirt").plan.task).maker
    before, after = plan_segments[0].transfer, plan_segments[1].transfer
    assert before is not None and after is not None and after.transfer_path.cloths[0] is not None
    transits, home = maker.transits, maker.transits.home
    hindered = transits.layout.spans[1]

    def is_home(cloth: LyingCloth, bases: FloatArray, joints: FloatArray, openings_m: FloatArray) -> bool:
        away = (joints[:, hindered] - home[hindered] + np.pi) % (2.0 * np.pi) - np.pi
        return bool(np.abs(away).max(axis=1).min() < 0.2)

    monkeypatch.setattr(transits, "is_clear", is_home)
    planner = TransitPlanner(transits, maker.dwell_s)
    free = TransitTime([TimedPhase.even(0, after.free_phases[-1], 1.5)], after.transfer_path.cloths[0])
    late = planner.keyframes(free, before.retreat, after.approach, before.going, after.coming)
    soon = planner.sooner(free, before.retreat, after.approach, late)
    assert free.end_s < soon[0].end_s < late[0].end_s - 0.1
    assert is_home(free.cloth, np.empty(0), soon[1].joints, np.empty(0))
    np.testing.assert_allclose(soon[1].joints[-1], late[1].joints[-1], atol=1e-9)


STATION, BACK, TURNED = Pose2(-0.95, 0.0, 3.0), Pose2(-1.15, 0.1, 3.0), Pose2(-1.15, 0.1, -3.0)
STILL = ClothMotion(0, Pose2(0.0, 0.0, 0.0), Pose2(0.0, 0.0, 0.0), TableTop.of(Table()))


def test_the_base_goes_evenly_through_one_phase_after_the_other_and_turns_the_short_way() -> None:
    legs = [
        Phase(seconds, ends, (None, None), STILL) for seconds, ends in ((2.0, (STATION, BACK)), (4.0, (BACK, TURNED)))
    ]
    free = TransitTime([TimedPhase.even(0, leg, leg.duration_s) for leg in legs], None)  # type: ignore[arg-type]
    assert (free.last, free.end_s) == (TURNED, 6.0)
    short = 2.0 * np.pi - 6.0
    expected = [
        (-0.95, 0.0, 3.0),
        (-1.05, 0.05, 3.0),
        (-1.15, 0.1, 3.0),
        (-1.15, 0.1, 3.0 + 0.25 * short),
        (-1.15, 0.1, 3.0 + short),
    ]
    np.testing.assert_allclose(free.bases_at(np.array([0.0, 1.0, 2.0, 3.0, 6.0])), expected, atol=1e-12)
    assert free.bases_at(np.array([2.0]))[0] == pytest.approx([-1.15, 0.1, 3.0])
