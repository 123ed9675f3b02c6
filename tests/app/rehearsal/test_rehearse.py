import math
from dataclasses import replace
from typing import Any

import pytest

from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.rehearse import RehearsalOptions, one_run, rehearse
from app.rehearsal.result import RehearsalResult, Run, success_bounds
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import GripMotion
from app.worker.stop import StoppedError
from planner import Task
from planner.errors import RequestError, UnsolvedPlanError
from tests.app.rehearsal.towel import COARSE, COARSER, towel_plan, verdict_on


def moved(grip: GripMotion, dx_m: float, dy_m: float) -> GripMotion:
    return replace(grip, points=tuple((x + dx_m, y + dy_m, z) for x, y, z in grip.points))


def test_a_towel_folded_with_one_of_two_grips_is_lost() -> None:
    (motion,) = step_motions(towel_plan())
    verdict = verdict_on(towel_plan(), replace(motion, grips=motion.grips[:1]), COARSER)
    assert not verdict.held
    assert verdict.iou < 0.7 < verdict_on(towel_plan(), motion, COARSER).iou


@pytest.mark.long
def test_a_towel_gripped_eight_centimetres_inwards_is_lost() -> None:
    (motion,) = step_motions(towel_plan())
    left, right = motion.grips
    verdict = verdict_on(towel_plan(), replace(motion, grips=(moved(left, 0.08, 0.0), right)))
    assert not verdict.held
    assert not verdict.empty


def test_a_hand_that_closes_beside_the_cloth_finds_none() -> None:
    (motion,) = step_motions(towel_plan())
    left, right = motion.grips
    verdict = verdict_on(towel_plan(), replace(motion, grips=(moved(left, -0.08, 0.0), right), needs_all=True))
    assert verdict.empty == (left.arm,)
    assert not verdict.held


def test_hands_close_on_the_picks_of_the_plan_and_open_on_its_places() -> None:
    (motion,) = step_motions(towel_plan())
    (step,) = towel_plan().steps
    for grip, planned in zip(motion.grips, step.grips, strict=True):
        assert grip.arm == planned.arm
        assert grip.points[0] == pytest.approx(planned.pick)
        assert grip.points[-1] == pytest.approx(planned.place)
        assert grip.closes
        assert grip.opens
        assert 0.0 < grip.times_s[0] < grip.times_s[-1] < step.duration_s


def test_hands_roll_over_with_the_cloth_as_the_plan_has_them_roll() -> None:
    (motion,) = step_motions(towel_plan())
    trajectory = towel_plan().trajectory
    assert trajectory is not None
    rolls = [hand.rolls_rad[-1] for hand in trajectory.of_step(0)[-1].phase.hands if hand is not None]
    assert [grip.turned_rad[-1] for grip in motion.grips] == pytest.approx([math.pi, math.pi])
    assert sorted(rolls) == pytest.approx([-math.pi, math.pi])
    for grip in motion.grips:
        assert grip.turned_at(grip.times_s[0]) == pytest.approx(0.0)
        assert list(grip.turned_rad) == sorted(grip.turned_rad)


@pytest.mark.long
@pytest.mark.slow
def test_the_same_rehearsal_twice_is_the_same_alone_and_side_by_side() -> None:
    options = RehearsalOptions(2, seed=4, resolution=Resolution(edge_m=0.06, settle_s=0.1))
    told: list[float] = []
    apart = rehearse(towel_plan(), options, told.append)
    alone = rehearse(towel_plan(), replace(options, workers=1))
    assert [run.steps for run in apart.runs] == [run.steps for run in alone.runs]
    assert told == sorted(told)


def test_a_garment_is_simulated_as_finely_as_suits_its_size(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[Resolution] = []

    def noted(_self: PhysicsWorld, _task: Task, _fabric: Fabric, resolution: Resolution, *_rest: object) -> None:
        taken.append(resolution)
        raise StoppedError

    monkeypatch.setattr(PhysicsWorld, "__init__", noted)
    for options in (RehearsalOptions(), RehearsalOptions(resolution=COARSE)):
        with pytest.raises(StoppedError):
            rehearse(towel_plan(), options)
    assert taken == [Resolution.of(0.12), COARSE]


def test_a_run_that_should_stop_stops() -> None:
    with pytest.raises(StoppedError):
        one_run(towel_plan(), RehearsalOptions(resolution=COARSE), 0, lambda _: None, should_stop=lambda: True)


def test_what_has_no_plan_cannot_be_rehearsed() -> None:
    with pytest.raises(UnsolvedPlanError):
        rehearse(replace(towel_plan(), steps=(), trajectory=None, status="infeasible"), RehearsalOptions())


@pytest.mark.parametrize(("field", "value"), [("runs", 0), ("runs", 1001), ("seed", -1)])
def test_options_out_of_range_are_refused_by_name(field: str, value: int) -> None:
    options: dict[str, Any] = {field: value}
    with pytest.raises(RequestError) as refused:
        RehearsalOptions(**options)
    assert refused.value.field == field


def near(rate: float) -> object:
    return pytest.approx(rate, abs=1e-4)


def test_a_rate_is_told_with_the_bounds_of_clopper_and_pearson() -> None:
    # Their table of 1934: 20 of 20 is at least .8316; 9 of 10 lies within .5550 and .9975.
    assert success_bounds(20, 20) == (near(0.8316), 1.0)
    assert success_bounds(0, 20) == (0.0, near(1.0 - 0.8316))
    assert success_bounds(9, 10) == (near(0.5550), near(0.9975))


def test_a_run_that_ended_early_has_not_held() -> None:
    result = RehearsalResult((Run(0, (), reason="the simulation has become unstable"), Run(1, ())))
    assert not result.is_held
    assert (result.to_dict()["held"], result.to_dict()["of"]) == (1, 2)
