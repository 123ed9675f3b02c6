"""Restricted tasks, which bring to the front ways that are among many others where there is more room."""

import math
from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace

import pytest

from planner import Scene, Task, load_garment
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.transfer_candidate import THOROUGH, SearchLimits
from planner.planning.budget import Budget
from planner.planning.path_search import PathSearch, Pause
from planner.planning.plan_search import Hints, _PlanSearch
from planner.planning.problem import Problem
from planner.planning.restricted_tasks import with_more_comfort, with_narrower_cones
from planner.primitives.g_fold import GFold


def problem_of(comfort_m: float, cone_rad: float) -> Problem:
    scene = Scene(approach_cone_rad=cone_rad, friction=0.4)
    return Problem.of(Task.of(load_garment("vest"), scene, start_station="left", comfort_radius_m=comfort_m))


@pytest.mark.parametrize(("comfort_m", "more"), [(0.0, [0.01, 0.02, 0.03]), (0.02, [0.03]), (0.03, []), (0.1, [])])
def test_more_comfort_is_asked_for_where_there_is_less_than_the_default(comfort_m: float, more: list[float]) -> None:
    found = list(with_more_comfort(problem_of(comfort_m, 1.3)))
    assert [(one.context.reach.comfort_m, one.context.scene.approach_cone_rad) for one in found] == [
        (m, 1.3) for m in more
    ]


@pytest.mark.parametrize(("cone_rad", "narrower"), [(math.pi, [0.0, 0.5, 1.0]), (0.7, [0.0, 0.5]), (0.0, [])])
def test_cones_are_narrower_and_comfort_is_as_it_was(cone_rad: float, narrower: list[float]) -> None:
    found = list(with_narrower_cones(problem_of(0.01, cone_rad)))
    assert [(one.context.reach.comfort_m, one.context.scene.approach_cone_rad) for one in found] == [
        (0.01, cone) for cone in narrower
    ]


def test_all_else_is_the_same_in_a_tighter_task() -> None:
    problem = problem_of(0.0, 1.3)
    for one in (*with_more_comfort(problem), *with_narrower_cones(problem)):
        alike = replace(one.context.scene, approach_cone_rad=1.3)
        assert (alike, one.start, one.context.placement) == (
            problem.context.scene,
            problem.start,
            problem.context.placement,
        )


def test_a_tighter_task_knows_already_where_the_cloth_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    # Far enough towards the robot the vest hangs over the near edge, and with little friction it slips.
    problem = problem_of(0.0, 1.3)
    places = [(-0.1 * number, 0.0) for number in range(12)]
    known = [problem.context.stability_violation(0, place) for place in places]
    assert {found.code for found in known if found is not None} >= {"slips"}
    tighter = [*with_more_comfort(problem), *with_narrower_cones(problem)]
    other = problem.varied(scene=replace(problem.context.scene, friction=1.0))

    def fail(*_: object) -> None:
        raise AssertionError("what is known is asked again")

    monkeypatch.setattr("planner.primitives.context.stability_violation_at", fail)
    for one in tighter:
        assert [one.context.stability_violation(0, place) for place in places] == known
    with pytest.raises(AssertionError, match="asked again"):
        _ = [other.context.stability_violation(0, place) for place in places]


def test_that_cloth_would_slip_is_noted_where_a_step_is_ruled_out_and_not_where_it_is_asked() -> None:
    context = problem_of(0.0, 1.3).context
    asked = {place: context.stability_violation(0, place) for place in ((-0.1 * number, 0.0) for number in range(12))}
    slips = next(place for place, found in asked.items() if found is not None and found.code == "slips")
    assert not context.obstacles.has_slipped
    assert not context.stays(0, slips)
    assert context.obstacles.has_slipped


def test_with_a_narrower_cone_what_is_known_of_transfers_is_not_computed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    garment = load_garment("hand-towel")
    problem = Problem.of(Task.of(garment))
    fold = next(step for step in GFold(problem.context).successors(problem.start))
    known = problem.maker.validated((fold,))
    assert known is not None
    narrower, closer = (next(with_narrower_cones(problem)), problem.restricted(comfort_m=0.04))
    again = replace(fold, context=narrower.context)

    def fail(*_: object, **__: object) -> None:
        raise AssertionError("what is known is computed again")

    monkeypatch.setattr("planner.motion.transfer_planner.waypoints_of", fail)
    made = narrower.maker.validated((again,))
    assert made is not None and made.transfer_path is known.transfer_path
    assert made.steps == (again,), "its steps are those of the tighter task"
    assert narrower.maker.path_requests == 1, "but it counts"
    with pytest.raises(AssertionError, match="computed again"):
        closer.maker.validated((replace(fold, context=closer.context),))


def test_where_it_is_worth_it_more_tries_are_made_in_restricted_tasks_too(monkeypatch: pytest.MonkeyPatch) -> None:
    again: list[Problem] = []

    def noted(self: PathSearch, search_limits: SearchLimits, transfers_max: float) -> Iterator[Pause]:
        assert search_limits is THOROUGH and transfers_max < math.inf
        again.append(self.problem)
        return iter(())

    monkeypatch.setattr(PathSearch, "run", lambda self: iter(()))
    monkeypatch.setattr(PathSearch, "run_again", noted)
    monkeypatch.setattr(PathSearch, "has_doubts", True)
    problem = problem_of(0.02, 0.7)
    search = _PlanSearch(problem, Budget.endless(), Hints(), is_patient=True)
    tighter = [*with_more_comfort(problem), *with_narrower_cones(problem)]
    for one in tighter:
        search.restrict(one, 1.0)
    assert not list(search.thorough())
    assert again == [problem, *tighter]


def test_of_what_is_validated_only_what_beats_the_known_plan_is_kept() -> None:
    search = PathSearch(Problem.of(Task.of(load_garment("vest"))), Budget.endless(), 1000)
    search.known_s = 5.0

    def lasting(lasts_s: float) -> tuple[PlanSegment, ...]:
        return (PlanSegment(0, (SimpleNamespace(duration_s=lasts_s),), None),)

    for lasts_s, kept_s in ((6.0, None), (5.0, None), (4.0, 4.0), (4.5, 4.0), (3.0, 3.0)):
        search.keep(lasting(lasts_s))
        assert (None if search.found is None else duration_s(search.found)) == kept_s
