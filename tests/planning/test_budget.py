"""A search ends by the work it has done, so that its answer does not depend on how busy the machine is."""

import math
from collections.abc import Iterator

import pytest

from planner import Plan, Task, deadline, load_garment, make_plan, plans
from planner.planning import plan_search
from planner.planning.budget import Budget
from planner.planning.events import Event
from planner.planning.problem import Problem
from planner.plans import plan
from tests.clocks import FastClock, slow_machine
from tests.replay.planned import shipped_plan
from tests.required import required

SEARCH_S = 0.08
"""Work for a part of the T-shirt's search (s), whatever its duration."""


def what_matters(answer: Plan) -> tuple[object, ...]:
    found = answer.statistics
    steps = [(p.kind, p.duration_s) for p in answer.primitives]
    return (
        answer.status,
        answer.cost_s,
        steps,
        found.expanded,
        found.explored,
        found.ik_queries,
        found.bound_s,
        found.ways,
    )


@pytest.mark.parametrize("work_s", [SEARCH_S, 10.0])
def test_on_a_slow_machine_the_same_request_has_the_same_answer(work_s: float, monkeypatch: pytest.MonkeyPatch) -> None:
    quick = make_plan(load_garment("t-shirt"), work_limit_s=work_s, time_limit_s=60.0)
    busy = slow_machine(monkeypatch)
    slow = make_plan(load_garment("t-shirt"), work_limit_s=work_s, time_limit_s=60.0, should_stop=busy)
    assert what_matters(slow) == what_matters(quick)
    assert (quick.status == "solved") == (work_s > SEARCH_S)


def test_and_falls_back_on_the_same_plan_at_the_same_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan_search, "GREEDY_AFTER_S", 0.5 * SEARCH_S)
    answers = []
    task = Task.of(load_garment("t-shirt"), work_limit_s=4.0 * SEARCH_S, time_limit_s=60.0)
    for should_stop in (None, slow_machine(monkeypatch)):
        *found, end = (event.found.plan for event in plan(task, should_stop=should_stop))
        answers.append((end, found))
    (quick, quickly_found), (slow, slowly_found) = answers
    assert what_matters(slow) == what_matters(quick)
    assert [found.cost_s for found in slowly_found] == [found.cost_s for found in quickly_found] != []


def test_half_of_the_work_is_left_for_looser_hands_where_no_firm_ones_are_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def vain(problem: Problem, budget: Budget, hints: plan_search.Hints) -> Iterator[Event]:
        if problem.context.is_firm:
            budget.beside_s += budget.work_limit_s
        return plan_search.quickest(problem, budget, hints)

    monkeypatch.setattr(plans, "quickest", vain)
    towel = load_garment("hand-towel")
    assert make_plan(towel, work_limit_s=1.0, time_limit_s=60.0).is_solved
    monkeypatch.setattr(plans, "FIRM_SHARE", 1.0)
    assert make_plan(towel, work_limit_s=1.0, time_limit_s=60.0).status == "budget_exceeded"


@pytest.mark.long
def test_a_firm_plan_may_take_all_of_the_work_to_be_improved(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = make_plan(load_garment("tie"), work_limit_s=10.0, time_limit_s=60.0)
    monkeypatch.setattr(plans, "FIRM_SHARE", 0.3)
    part = make_plan(load_garment("tie"), work_limit_s=10.0, time_limit_s=60.0)
    assert what_matters(part) == what_matters(whole) and not whole.statistics.is_cut_short


def test_the_clock_ends_a_search_that_has_work_left() -> None:
    answer = make_plan(load_garment("t-shirt"), work_limit_s=60.0, time_limit_s=0.01)
    assert answer.status == "budget_exceeded"


def test_time_in_which_the_process_has_no_processor_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another program, or whatever else stalls the thread, takes ten times the limit."""
    task = Task.of(load_garment("tie"), work_limit_s=0.5 * SEARCH_S, time_limit_s=0.3)
    make_plan(task)  # kernels are loaded
    wall = FastClock(monkeypatch, "wall_clock_s")

    def stalled() -> bool:
        wall.ahead_s = 3.0
        return False

    answer = make_plan(task, should_stop=stalled)
    assert wall.ahead_s == 3.0
    assert answer.statistics.ways == make_plan(task).statistics.ways > 0


def test_whoever_waits_gets_an_answer_from_a_search_that_stalls_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    wall = FastClock(monkeypatch, "wall_clock_s")
    task = Task.of(load_garment("t-shirt"), work_limit_s=60.0, time_limit_s=10.0)

    def stalled() -> bool:
        wall.ahead_s += 50.0
        return False

    assert make_plan(task, should_stop=stalled).status == "budget_exceeded"


def test_more_work_is_looked_at_more_ways() -> None:
    few, more = (make_plan(load_garment("tie"), work_limit_s=share * SEARCH_S) for share in (0.5, 1.0))
    assert few.status == more.status == "budget_exceeded"
    assert 0 < few.statistics.ways < more.statistics.ways
    assert required(few.statistics.bound_s) <= required(more.statistics.bound_s)


def test_what_is_asked_of_every_problem_watched_is_counted() -> None:
    problem = Problem.of(Task.of(load_garment("vest")))
    budget = Budget.of(math.inf, 60.0)
    assert budget.spent_s == 0.0
    budget.watch(problem)
    problem.maker.path_requests += 1
    tried = budget.spent_s
    budget.looks += 1
    assert 0.0 < tried < budget.spent_s
    assert budget.ways == 1


def test_a_deadline_that_is_over_stays_so_and_asks_nobody_any_more() -> None:
    answers = iter((False, True))
    whole = Budget.endless(lambda: next(answers))
    part = whole.part(1.0)
    assert [part.is_over, whole.is_over, part.is_over, whole.is_over] == [False, True, True, True]


def test_a_deadline_that_is_forgotten_limits_nothing() -> None:
    limit = deadline.Deadline(-1.0, lambda: True)
    assert (limit.is_over, limit.is_long_over) == (True, True)
    limit.forget()
    assert (limit.is_over, limit.is_long_over) == (False, False)


def test_time_that_is_left_out_does_not_bring_a_deadline_nearer(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [0.0]
    monkeypatch.setattr(deadline, "clock_s", lambda: now_s[0])
    monkeypatch.setattr("planner.deadline.time.thread_time", lambda: now_s[0])
    limit = deadline.Deadline(2.0)
    with deadline.left_out():
        now_s[0] += 10.0
    assert limit.left_s == pytest.approx(2.0)
    now_s[0] += 3.0
    assert limit.is_over


def test_a_plan_is_not_improved_beyond_the_work_for_that() -> None:
    task = Task.of(load_garment("scarf"))
    first, end = (event.found.plan.cost_s for event in plan(task, improving_s=0.0))
    assert end == first
    assert required(end) > required(shipped_plan("scarf").cost_s)
