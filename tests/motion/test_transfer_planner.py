"""The cache of a transfer planner: nothing is computed twice, and everything is counted all the same."""

import math
from dataclasses import replace
from typing import Any

import pytest

from planner import Scene, Task, load_garment
from planner.geometry.pose import FloatArray, Pose2
from planner.motion.transfer import Transfer
from planner.motion.transfer_candidate import QUICK, Candidate, ways_of
from planner.motion.transfer_path_finder import TransferPathFinder
from planner.motion.transfer_planner import TransferPlanner
from planner.motion.transfer_timing import TransferTiming
from planner.motion.transit_paths import TransitPaths
from planner.planning.problem import Problem
from planner.primitives.primitive import Step
from planner.primitives.primitive_set import PRIMITIVES
from tests.builders import fold, garment, rectangle_points
from tests.planning.found import found_plan


def some_fold(arm_motion_s: float = 3.0) -> tuple[TransferPlanner, tuple[Step, ...], tuple[Step, ...]]:
    """Return a planner, and a fold of a napkin as two searches find it, equally good."""
    placement = Pose2(-0.6, 0.15, -math.pi / 2)
    cloth = garment(rectangle_points(0.3, 0.3), fold((0.3, 0.15), (0.0, 0.15), name="half"), placement=placement)
    problem = Problem.of(Task.of(cloth, Scene(arm_motion_s=arm_motion_s)))
    first, again = (
        next(
            step
            for kind in PRIMITIVES
            for step in kind(problem.context).successors(problem.start)
            if step.kind == "fold"
        )
        for _ in range(2)
    )
    return problem.maker, (first,), (again,)


def test_what_was_made_real_once_is_not_made_again_but_counted() -> None:
    maker, first, again = some_fold()
    assert first[0] is not again[0] and first[0].motion == again[0].motion
    transfer = maker.validated(first)
    assert transfer is not None and maker.path_requests > 0
    path_requests, glances = maker.path_requests, maker.glances
    assert maker.validated(again) is transfer
    assert (maker.path_requests, maker.glances) == (2 * path_requests, 2 * glances)


def test_all_that_a_long_search_asked_for_is_kept_for_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    first = found_plan(load_garment("tie")).plan

    def unwanted(*_: object) -> None:
        raise AssertionError("a transfer was searched or timed again")

    monkeypatch.setattr(TransferPathFinder, "_search", unwanted)
    monkeypatch.setattr(TransferTiming, "of", unwanted)
    assert found_plan(load_garment("tie")).plan.cost_s == first.cost_s


def test_what_needs_a_sampled_path_is_tried_again_once_more_may_be_sampled(monkeypatch: pytest.MonkeyPatch) -> None:
    maker, first, again = some_fold()
    way = maker.transits.way

    def by_samples_alone(*asked: Any, samples: bool) -> FloatArray | None:
        return way(*asked, samples=samples) if samples else None

    monkeypatch.setattr(TransitPaths, "way", staticmethod(by_samples_alone))
    sampling = maker.known.sampling
    sampling.vain = sampling.most
    candidate = maker.candidate(first)
    assert maker.made(candidate) is None and sampling.left_out == 1
    assert maker.made(candidate) is None and sampling.left_out == 1
    maker.sample_more()
    assert maker.made(maker.candidate(again)) is not None


def test_no_two_ways_of_a_fold_have_the_same_motion() -> None:
    _, first, _ = some_fold()
    ways = [tuple(step.motion for step in way) for way in ways_of(first, QUICK)]
    assert len(ways) == QUICK.variants == len(set(ways))


def test_ways_that_cannot_be_quicker_than_one_that_was_found_are_not_led(monkeypatch: pytest.MonkeyPatch) -> None:
    # The arms carry the napkin over in 2.1 s with the fingers' rest, which is more than two arm motions.
    maker, first, _ = some_fold(arm_motion_s=0.9)
    quick = maker.validated(first, replace(QUICK, ways=1))
    assert quick is not None and quick.is_late
    takes_s, led, made = sum(quick.durations_s()), list[tuple[Step, ...]](), maker.made
    slower = [(way,) for way in first[0].elsewhere(64) if way.duration_s > takes_s]
    assert len(slower) >= QUICK.late

    def noted(candidate: Candidate) -> Transfer | None:
        led.append(candidate.steps)
        return made(candidate)

    monkeypatch.setattr(maker, "made", noted)
    assert maker.first_valid([first, *slower], QUICK) is quick
    assert led == [first]
