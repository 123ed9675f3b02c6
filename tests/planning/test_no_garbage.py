"""Searches leave no reference cycles, which would keep megabytes of each plan for minutes."""

import gc
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import pytest

from bench.growth_cases import tabs
from planner import find_plan, quick_plan
from planner.cloth.garment_files import load_garment
from planner.folds.fold_sequence import fold_dag
from planner.planning.robot_task import default_scene, task_for
from planner.planning.warm_up import compile_kernels


@pytest.fixture
def collected_by_hand() -> Iterator[None]:
    """Keep the garbage collector from working, and keep what it finds."""
    gc.collect()
    gc.disable()
    gc.set_debug(gc.DEBUG_SAVEALL)
    yield
    gc.set_debug(0)
    gc.garbage.clear()
    gc.enable()


def own_garbage() -> Counter[str]:
    """Return how many objects of this project only the garbage collector has found, by their types."""
    gc.collect()
    kinds = (type(one) for one in gc.garbage)
    return Counter(f"{kind.__module__}.{kind.__qualname__}" for kind in kinds if kind.__module__.startswith("planner."))


@pytest.mark.parametrize("name", ["vest", "t-shirt"])
def test_searches_leave_no_garbage(name: str, collected_by_hand: None) -> None:
    compile_kernels()
    task = task_for(load_garment(name))
    (x_m, y_m), *others = task.garment.outline
    moved = task_for(replace(task.garment, outline=((x_m + 0.001, y_m), *others)))
    found = find_plan(task)
    soon = quick_plan(moved, like=[found])
    assert soon is not None and find_plan(moved, known=soon, like=[found]).plan.is_solved
    assert own_garbage() == {}


def test_a_search_that_is_led_by_the_bound_on_driving_leaves_no_garbage(collected_by_hand: None) -> None:
    compile_kernels()
    task = task_for(tabs(13))
    assert fold_dag(task.garment).dag.is_loose
    assert find_plan(task).plan.is_solved
    assert own_garbage() == {}


def test_a_search_without_a_plan_leaves_no_garbage_and_forgets_who_asked(collected_by_hand: None) -> None:
    scene = default_scene("pr2")
    too_high = replace(scene, table=replace(scene.table, height_m=1.9))
    task = task_for(load_garment("vest"), too_high, work_limit_s=2.0)

    def should_stop() -> bool:
        return False

    found = find_plan(task, should_stop=should_stop, with_reasons=True)
    assert not found.plan.is_solved
    assert found.context.deadline.is_over is False
    del task
    assert own_garbage() == {}
    assert gc.get_referrers(should_stop) == [], "what a search asked whether to stop is not kept with its plan"
