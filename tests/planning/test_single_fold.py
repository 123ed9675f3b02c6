"""The single-fold relaxation never rejects feasible folds, and rejects infeasible ones quickly."""

import math
from itertools import count

import pytest

from planner import Scene, Task, find_plan, load_garment, make_plan, shipped_garment_names
from planner.planning import path_search as planning
from planner.planning.budget import Budget
from planner.planning.problem import Problem
from planner.planning.single_fold import OFFSETS_MAX, SingleFold
from planner.primitives.drag_way import drag_offsets
from planner.task.reason import Code
from tests.planning.found import found_plan
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.sweep import sweep

HALVED = ("scarf-halved", "tie-halved")
SOLVABLE = [name for name in shipped_garment_names() if name not in HALVED]


@sweep("name", SOLVABLE)
def test_a_fold_that_can_be_done_is_never_called_impossible(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    searched = shipped_plan(name)
    monkeypatch.setattr(planning, "LOOK_ALONE_AFTER", 1)
    looked_at = make_plan(load_garment(name), time_limit_s=60.0)
    assert looked_at.status == "solved"
    assert looked_at.cost_s == pytest.approx(searched.cost_s, abs=1e-9)


@sweep("name", HALVED, ())
def test_what_is_called_impossible_is_so_when_all_states_are_exhausted(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    quick = shipped_plan(name)
    monkeypatch.setattr(planning, "LOOK_ALONE_AFTER", 1_000_000_000)
    exhausted = find_plan(Task.of(load_garment(name), time_limit_s=60.0), with_reasons=False).plan
    assert quick.status == exhausted.status == "infeasible"
    assert quick.statistics.expanded < exhausted.statistics.expanded / 3


@pytest.mark.parametrize("name", HALVED)
def test_a_no_says_which_fold_is_out_of_reach_and_by_how_much(name: str) -> None:
    first, *others = shipped_plan(name).reasons
    assert (first.fold, first.code) == (0, Code.OUT_OF_REACH)
    assert first.cause in {"too_far", "joint_limit", "comfort_only"}
    short_by_m = required(first.short_by_m)
    assert 0.0 < short_by_m < 0.3
    assert first.station in dict(Scene().stations)
    assert len(required(first.point)) == 3
    assert f"{short_by_m:.2f} m" in first.message
    assert (others[0].fold, others[0].code) == (1, Code.WAITS_FOR_FOLD)


@pytest.mark.parametrize("name", HALVED)
def test_it_asks_often_whether_to_stop_and_then_calls_nothing_impossible(name: str) -> None:
    def looked_at(stop_after: float) -> tuple[bool, int]:
        """Return whether the first fold is impossible, and how often the search asked whether to stop."""
        problem, asked = Problem.of(Task.of(load_garment(name))), count(1)
        alone = SingleFold(problem.context, problem.start.station, Budget.endless(lambda: next(asked) > stop_after))
        return alone.is_impossible(0), next(asked) - 1

    is_impossible, times = looked_at(math.inf)
    assert is_impossible
    assert times > 100
    for stop_after in (0, times // 2, times - 1):
        assert looked_at(stop_after) == (False, stop_after + 1)


def test_drags_lead_only_where_some_of_the_garment_can_lie_on_the_table() -> None:
    found = found_plan(load_garment("hand-towel"))
    offsets = drag_offsets(found.context, OFFSETS_MAX)
    half_depth, half_width = Scene().table.depth_m / 2, Scene().table.width_m / 2
    placement = found.plan.garment.placement
    assert (offsets[0] == 0.0).all()
    assert (offsets[:, 0] <= 1e-9).all(), "front drags towards itself, the sides drag sideways, nobody drags away"
    assert (abs(placement.y_m - 0.343 + offsets[:, 1]) < half_width + 0.343).all()
    assert (placement.x_m + 0.419 + offsets[:, 0] > -half_depth).all()
