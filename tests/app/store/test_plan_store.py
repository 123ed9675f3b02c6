"""Plans stored by id: the newest can be read and played, after a restart too, and only a few of them use memory."""

import gc
import threading
import weakref
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from sqlalchemy import func, select

from app.store.database import Database
from app.store.packed_plan import PackedPlan
from app.store.plan_store import LIVE_MAX, PASSING_MAX, PlanStore, UnknownPlanError
from app.store.schema import PlanRow
from planner import Plan
from planner.motion.timeline import Timeline
from tests.app.refused import refused
from tests.replay.planned import shipped_plan
from tests.small_plan import unsolved


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("hand-towel")


@pytest.fixture
def copies(plan: Plan) -> Iterator[Plan]:
    """Return plans that differ in the number of expanded states."""
    return (replace(plan, statistics=replace(plan.statistics, expanded=number)) for number in range(10_000))


def number_of(store: PlanStore, plan_id: str) -> int:
    number: int = store.plan(plan_id).to_dict()["statistics"]["expanded"]
    return number


def row_count(database: Database) -> int:
    with database.reading("count") as session:
        return session.scalar(select(func.count()).select_from(PlanRow)) or 0


def test_after_a_restart_a_plan_is_told_and_played_as_it_was(plan: Plan, database: Database) -> None:
    store = PlanStore(database)
    first, no_plan = store.add(plan), store.add(unsolved())
    again = PlanStore(database)
    kept = again.plan(first)
    assert kept is not plan
    assert kept == plan and kept.to_dict() == plan.to_dict()
    frames, expected = Timeline.of(kept).samples(10.0), Timeline.of(plan).samples(10.0)
    assert [frame.to_dict() for frame in frames] == [frame.to_dict() for frame in expected]
    assert again.plan(no_plan).status == "infeasible"
    for unknown in ("unknown", "", "\0", "x" * 1000):
        with pytest.raises(UnknownPlanError):
            again.plan(unknown)


def test_a_plan_that_was_packed_elsewhere_is_unpacked_when_it_is_asked_for(plan: Plan, database: Database) -> None:
    store, gone = PlanStore(database), PackedPlan.of(plan)
    plan_id = store.add_packed(gone)
    found = store.plan(plan_id)
    assert found == plan and store.plan(plan_id) is found
    assert PlanStore(database).plan(plan_id) == plan


def test_a_plan_that_was_read_is_unpacked_once_while_it_is_among_the_newest(plan: Plan, database: Database) -> None:
    plan_id = PlanStore(database).add(plan)
    again = PlanStore(database)
    first = again.plan(plan_id)
    assert again.plan(plan_id) is first
    again.drop(plan_id)
    with pytest.raises(UnknownPlanError):
        again.plan(plan_id)


def test_packed_plans_are_no_objects_in_memory(plan: Plan, database: Database) -> None:
    def plans() -> int:
        gc.collect()
        return sum(isinstance(one, Plan) for one in gc.get_objects())

    store, packed, before = PlanStore(database), PackedPlan.of(plan), plans()
    for _ in range(LIVE_MAX):
        store.add_packed(packed)
    assert plans() == before


def test_the_newest_can_be_read_and_older_ones_are_gone(copies: Iterator[Plan], database: Database) -> None:
    store = PlanStore(database, capacity=5)
    made = [store.add(next(copies)) for _ in range(15)]
    assert [number_of(store, plan_id) for plan_id in made[10:]] == list(range(10, 15))
    for gone in made[:10]:
        with pytest.raises(UnknownPlanError):
            store.plan(gone)


def test_no_more_bytes_are_kept_than_are_allowed(copies: Iterator[Plan], database: Database) -> None:
    PlanStore(database, capacity=100).add(next(copies))
    with database.reading("look") as session:
        one = session.scalar(select(PlanRow.size)) or 0
    store = PlanStore(database, capacity=100, capacity_bytes=4 * one + one // 2)
    for _ in range(2 * LIVE_MAX):
        store.add(next(copies))
    assert row_count(database) == 4


@pytest.mark.parametrize("is_passing", [True, False])
def test_plans_that_were_added_and_not_read_are_no_objects_in_memory(
    copies: Iterator[Plan], tmp_path: Path, *, is_passing: bool
) -> None:
    store, alive = PlanStore(Database(tmp_path / "pleat.db")), []
    for _ in range(LIVE_MAX):
        plan = next(copies)
        alive.append(weakref.ref(plan))
        plan_id = store.add(plan, is_passing=is_passing)
        store.keep(plan_id)
    del plan
    gc.collect()
    assert not any(one() for one in alive)
    assert number_of(store, plan_id) == LIVE_MAX - 1


def test_of_many_plans_that_were_read_only_a_few_stay_in_memory(copies: Iterator[Plan], tmp_path: Path) -> None:
    store = PlanStore(Database(tmp_path / "pleat.db"))
    alive = [weakref.ref(store.plan(plan_id)) for plan_id in [store.add(next(copies)) for _ in range(30)]]
    gc.collect()
    assert sum(one() is not None for one in alive) == LIVE_MAX


def test_a_plan_that_was_dropped_is_gone_wherever_it_was(copies: Iterator[Plan], database: Database) -> None:
    store = PlanStore(database)
    made = [store.add(next(copies)) for _ in range(LIVE_MAX + 4)]
    passing = store.add(next(copies), is_passing=True)
    for plan_id in (made[0], made[-1], made[-1], passing, "unknown"):
        store.drop(plan_id)
    for plan_id in (made[0], made[-1], passing):
        with pytest.raises(UnknownPlanError):
            store.plan(plan_id)
    assert number_of(store, made[1]) == 1


def test_a_plan_in_passing_is_written_only_if_it_stays(copies: Iterator[Plan], tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db")
    store = PlanStore(database)
    made = [store.add(next(copies), is_passing=True) for _ in range(PASSING_MAX)]
    assert row_count(database) == 0
    made += [store.add(next(copies), is_passing=True) for _ in range(2)]
    assert row_count(database) == 2
    assert [number_of(store, plan_id) for plan_id in made] == list(range(PASSING_MAX + 2))
    database.close()


def test_a_plan_that_was_let_go_is_read_while_it_is_new_and_never_written(
    copies: Iterator[Plan], database: Database
) -> None:
    store = PlanStore(database)
    first, second = (store.add(next(copies), is_passing=True) for _ in range(2))
    store.let_go(first)
    assert number_of(store, first) == 0
    for _ in range(PASSING_MAX):
        store.add(next(copies), is_passing=True)
    assert row_count(database) == 1
    assert number_of(store, second) == 1
    with pytest.raises(UnknownPlanError):
        store.plan(first)


def test_a_plan_in_passing_that_is_kept_is_written_once(copies: Iterator[Plan], database: Database) -> None:
    store = PlanStore(database)
    made = store.add(next(copies), is_passing=True)
    for _ in range(2):
        store.keep(made)
    store.keep("unknown")
    assert row_count(database) == 1
    assert number_of(PlanStore(database), made) == 0
    store.drop(made)
    assert row_count(database) == 0


def test_a_full_disk_loses_none_of_the_newest_plans(
    copies: Iterator[Plan], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    database = Database(tmp_path / "pleat.db")
    store = PlanStore(database)
    store.add(next(copies))
    with refused(monkeypatch, tmp_path, "ENOSPC"):
        made = [store.add(next(copies)) for _ in range(LIVE_MAX)]
    assert [number_of(store, plan_id) for plan_id in made] == list(range(1, LIVE_MAX + 1))
    database.close()


def test_many_threads_may_add_read_and_drop(copies: Iterator[Plan], database: Database) -> None:
    store, faults = PlanStore(database), []
    plans = [next(copies) for _ in range(40)]

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
