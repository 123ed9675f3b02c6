"""Plans stored by id: the newest thousand can be read and played, and only a few of them use memory."""

import gc
import threading
import weakref
from collections.abc import Iterator
from dataclasses import replace

import pytest

from app.store.plan_store import LIVE_MAX, PlanStore, UnknownPlanError
from planner import Plan, load_garment, make_plan
from planner.motion.timeline import Timeline


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_garment("hand-towel"))


@pytest.fixture
def copies(plan: Plan) -> Iterator[Plan]:
    """Return plans that differ in the number of expanded states."""
    return (replace(plan, statistics=replace(plan.statistics, expanded=number)) for number in range(10_000))


def number_of(store: PlanStore, plan_id: str) -> int:
    number: int = store.plan(plan_id).to_dict()["statistics"]["expanded"]
    return number


def test_a_plan_put_away_is_told_and_played_as_it_was(plan: Plan, copies: Iterator[Plan]) -> None:
    store = PlanStore()
    first, no_plan = store.add(plan), store.add(make_plan(load_garment("scarf-halved")))
    for _ in range(2 * LIVE_MAX):
        store.add(next(copies))
    kept = store.plan(first)
    assert kept is not plan, "else it was not put away"
    assert kept == plan and kept.to_dict() == plan.to_dict()
    frames, expected = Timeline.of(kept).samples(10.0), Timeline.of(plan).samples(10.0)
    assert [frame.to_dict() for frame in frames] == [frame.to_dict() for frame in expected]
    assert store.plan(no_plan).status == "infeasible"


def test_the_newest_can_be_read_and_older_ones_are_gone(copies: Iterator[Plan]) -> None:
    store = PlanStore(capacity=50)
    made = [store.add(next(copies)) for _ in range(70)]
    assert [number_of(store, plan_id) for plan_id in made[20:]] == list(range(20, 70))
    for gone in made[:20]:
        with pytest.raises(UnknownPlanError):
            store.plan(gone)


def test_of_many_plans_only_a_few_stay_in_memory(copies: Iterator[Plan]) -> None:
    store, alive = PlanStore(), []
    for _ in range(60):
        plan = next(copies)
        alive.append(weakref.ref(plan))
        store.add(plan)
    del plan
    gc.collect()
    assert sum(one() is not None for one in alive) == LIVE_MAX


def test_a_plan_that_was_dropped_is_gone_wherever_it_was(copies: Iterator[Plan]) -> None:
    store = PlanStore()
    made = [store.add(next(copies)) for _ in range(2 * LIVE_MAX)]
    for plan_id in (made[0], made[-1], made[-1], "unknown"):
        store.drop(plan_id)
    for plan_id in (made[0], made[-1]):
        with pytest.raises(UnknownPlanError):
            store.plan(plan_id)
    assert number_of(store, made[1]) == 1


def test_a_full_disk_loses_no_plan(copies: Iterator[Plan]) -> None:
    store = PlanStore()
    store._stored._database.execute("PRAGMA max_page_count = 40")
    made = [store.add(next(copies)) for _ in range(3 * LIVE_MAX)]
    assert [number_of(store, plan_id) for plan_id in made] == list(range(3 * LIVE_MAX))


def test_a_plan_that_cannot_be_put_away_is_kept_and_others_are_put_away(
    plan: Plan, copies: Iterator[Plan], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(self: Plan) -> None:
        raise RuntimeError("it cannot be pickled")

    store = PlanStore()
    monkeypatch.setattr(Plan, "__getstate__", fail)
    bad = store.add(plan)
    for _ in range(LIVE_MAX):
        store.add(next(copies))
    monkeypatch.undo()
    made = [store.add(next(copies)) for _ in range(LIVE_MAX)]
    assert store.plan(bad).status == "solved"
    assert number_of(store, made[0]) == LIVE_MAX


def test_many_threads_may_add_read_and_drop(copies: Iterator[Plan]) -> None:
    store, faults = PlanStore(capacity=40), []
    plans = [next(copies) for _ in range(120)]

    def work(mine: list[Plan]) -> None:
        try:
            for number, plan in enumerate(mine):
                plan_id = store.add(plan)
                assert store.plan(plan_id).to_dict()["statistics"] == plan.statistics.to_dict()
                if number % 3 == 0:
                    store.drop(plan_id)
        except Exception as error:
            faults.append(error)

    threads = [threading.Thread(target=work, args=(plans[first::4],)) for first in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert faults == []
