"""Quick plans, adapted from one for a slightly different garment, pass the independent checker."""

import math
from dataclasses import replace
from typing import Any

import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from planner import Garment, Scene, Task, find_plan, load_garment, make_plan, quick_plan
from planner.cloth.garment import DrawnFold
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.motion.timeline import Timeline
from planner.planning.found_plan import FoundPlan
from tests.builders import fold, garment, rectangle_points
from tests.planning.found import found_plan
from tests.replay.checker import check
from tests.replay.joints import require_clear, require_speeds
from tests.replay.planned import IMPOSSIBLE, SOLVABLE, each_solvable, planned, shipped_plan
from tests.required import required
from tests.sweep import sweep

CENTIMETRE = ((0.01, 0.0), (0.0, 0.01), (-0.01, 0.0), (0.0, -0.01))


def moved(name: str, vertex: int, by: tuple[float, float]) -> Garment:
    """Return a shipped garment with a vertex pulled; its folds follow the cloth that they are tied to."""
    drawing = solve(drawing_of(load_garment(name))).drawing
    outline = list(drawing.outline)
    x, y = outline[vertex].point
    outline[vertex] = replace(outline[vertex], point=(x + by[0], y + by[1]))
    found = solve(replace(drawing, outline=tuple(outline))).garment
    assert found is not None, f"{name}: vertex {vertex} moved by {by} makes a fold illegal"
    return found


def free_vertices(cloth: Garment) -> list[int]:
    """Return the vertices at which no fold begins or ends."""
    ends = [end for drawn in cloth.folds for end in (drawn.start, drawn.end)]
    return [i for i, corner in enumerate(cloth.outline) if all(math.dist(corner, end) > 1e-6 for end in ends)]


def soon(cloth: Garment, known: FoundPlan) -> FoundPlan | None:
    """Return the quick plan for a garment, from a known plan."""
    return quick_plan(Task.of(cloth), like=[known])


def unhurried(found: FoundPlan) -> dict[str, Any]:
    """Return a plan as if the joints kept up everywhere: the checker infers the base's way from the time."""
    said, now = found.plan.to_dict(), 0.0
    steps = [step for plan_segment in found.plan_segments for step in plan_segment.steps]
    for primitive, step in zip(said["primitives"], steps, strict=True):
        assert primitive["duration_s"] >= step.duration_s - 1e-9
        primitive.update(start_s=now, duration_s=step.duration_s)
        now += step.duration_s
    return {**said, "cost_s": now}


HALF = fold((0.3, 0.15), (0.0, 0.15), name="half")
QUARTER = fold((0.15, 0.15), (0.15, 0.3), name="quarter")


def napkin(*folds: DrawnFold) -> Garment:
    return garment(rectangle_points(0.3, 0.3), *folds, placement=Pose2(-0.75, 0.15, -math.pi / 2))


def way(found: FoundPlan) -> list[tuple[object, ...]]:
    """Return the primitives in order, with their stations."""
    return [(step.kind, step.fold, step.base.station) for step in found.plan.steps]


@each_solvable
def test_adapted_to_the_garment_it_is_for_a_plan_is_what_it_was(name: str) -> None:
    before = planned(name)
    after = soon(load_garment(name), before.found)
    assert after is not None and after.plan.cost_s == pytest.approx(before.found.plan.cost_s, abs=1e-9)
    assert after.plan.to_dict()["primitives"] == before.found.plan.to_dict()["primitives"]
    assert after.plan.steps == before.found.plan.steps


@each_solvable
def test_what_is_adapted_to_a_garment_with_a_vertex_moved_by_a_centimetre_replays(name: str) -> None:
    before, adapted = planned(name).found, []
    for vertex in free_vertices(before.plan.garment)[::2]:
        # None of these leaves a sliver narrower than a millimetre, which the checker would not follow.
        cloth = moved(name, vertex, CENTIMETRE[(vertex // 2 + 1) % 4])
        after = soon(cloth, before)
        if after is not None:
            check(cloth.to_dict(), Scene().to_dict(), unhurried(after))
            assert required(after.plan.statistics.bound_s) <= required(after.plan.cost_s)
            adapted.append(after)
    assert adapted, "each garment has a vertex that may be pulled without another plan"


@sweep("name", SOLVABLE, ("scarf",))
def test_the_arms_can_follow_what_is_adapted_again_and_again(name: str) -> None:
    # A centimetre, millimetre by millimetre: each plan's joints are near to those of the plan before.
    found = planned(name).found
    vertex = free_vertices(found.plan.garment)[-1]
    for number in range(1, 11):
        found = soon(moved(name, vertex, (0.0, 0.001 * number)), found) or found
    assert found.plan.garment.outline != shipped_plan(name).garment.outline
    timeline = Timeline.of(found.plan)
    require_speeds(timeline)
    require_clear(timeline, Table(), every_s=1.7)


def test_most_centimetres_ask_for_no_other_plan() -> None:
    before = planned("t-shirt").found
    moves = [(vertex, CENTIMETRE[vertex % 4]) for vertex in range(len(before.plan.garment.outline))]
    after = [soon(moved("t-shirt", *move), before) for move in moves]
    assert sum(found is not None and way(found) == way(before) for found in after) >= 0.8 * len(moves)


def test_what_more_is_to_be_folded_is_folded_after_what_is_known() -> None:
    once, twice = napkin(HALF), napkin(HALF, QUARTER)
    known = found_plan(once)
    found = required(soon(twice, known))
    check(twice.to_dict(), Scene().to_dict(), unhurried(found))
    assert way(found)[: len(way(known))] == way(known)
    assert required(found.plan.cost_s) >= required(make_plan(twice).cost_s) - 1e-9


def test_what_is_not_to_be_folded_any_more_is_left_out() -> None:
    once, twice = napkin(HALF), napkin(HALF, QUARTER)
    found = required(soon(once, found_plan(twice)))
    assert way(found) == way(found_plan(once))


def test_a_plan_whose_hands_let_go_does_not_do_for_folds_between_which_they_hold_on() -> None:
    over, back = fold((0.3, 0.12), (0.0, 0.12), name="over"), fold((0.0, 0.2), (0.3, 0.2), "red", name="back")
    red, blue = napkin(over, back), napkin(over, replace(back, kind="blue"))
    for cloth, other in ((red, blue), (blue, red)):
        found = required(soon(cloth, found_plan(other)))
        check(cloth.to_dict(), Scene().to_dict(), unhurried(found))
        folds = [step for step in found.plan.steps if step.kind == "fold"]
        assert [step.details["holds"] for step in folds] == [cloth is red, False]
        assert [bool(step.after.held) for step in folds] == [cloth is red, False]


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_where_there_is_no_plan_none_is_found_soon(name: str) -> None:
    assert soon(load_garment(name), planned(name.removesuffix("-halved")).found) is None


def test_a_plan_that_is_known_is_the_answer_if_none_is_quicker() -> None:
    known = required(soon(moved("jeans", 2, (0.0, 0.01)), planned("jeans").found))
    after = find_plan(known.plan.task, known=known).plan
    plainly = make_plan(known.plan.task)
    quickest_s = min(required(known.plan.cost_s), required(plainly.cost_s))
    assert after.is_solved and after.cost_s == pytest.approx(quickest_s, abs=1e-9)
    assert after.statistics.bound_s == pytest.approx(after.cost_s, abs=1e-9), "that is proved now"


def test_a_plan_that_is_known_is_the_answer_when_time_runs_out() -> None:
    jeans = load_garment("jeans")
    known = required(soon(jeans, planned("jeans").found))
    task = Task.of(jeans, max_expanded=1)
    after = find_plan(task, known=known).plan
    assert after.is_solved and after.cost_s == known.plan.cost_s
    assert after.task == task, "it answers what was asked now"
    assert required(after.statistics.bound_s) < required(after.cost_s), "whether it is the quickest is not known"


def test_a_slower_plan_that_is_known_gives_way_to_the_quickest() -> None:
    towel = load_garment("hand-towel")
    slow = found_plan(towel, start_station="left")
    assert find_plan(Task.of(towel), known=slow).plan.cost_s == pytest.approx(
        shipped_plan("hand-towel").cost_s, abs=1e-9
    )
