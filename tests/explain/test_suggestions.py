import math
import time
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from planner import FoldSequence, Garment, Scene, Task, find_plan, load_garment, make_plan
from planner.errors import FoldError, RequestError
from planner.explain.suggestion import Suggestion
from planner.explain.suggestion_assumption import comforts, frictions, grip_radii
from planner.explain.suggestion_flip import flips
from planner.explain.suggestion_fold_line import chord, fold_lines, redrawn
from planner.explain.suggestion_grid import Room, turned_in_place
from planner.explain.suggestion_map import placement_map
from planner.explain.suggestion_order import orders
from planner.explain.suggestion_station import stations
from planner.explain.suggestion_together import together
from planner.explain.suggestion_trial import Proof, Search, SuggestionTrial, narrowed
from planner.explain.suggestions import Suggestions, suggestions
from planner.geometry.pose import Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from planner.message import Message
from planner.task.plan import Plan
from planner.task.task import TaskOptions
from tests.builders import fold, garment, rectangle_points
from tests.planning.provoked import FRONT, planned_with
from tests.replay.planned import planned

FRONT_ONLY = Scene(stations=FRONT)
FAR = Pose2(0.4, 0.15, -math.pi / 2)


def towel(placement: Pose2 | None = None) -> Garment:
    """Return a towel, 40 cm along the robot's arms and 30 cm deep, folded once away from the robot."""
    half = fold((0.3, 0.2), (0.0, 0.2))
    return garment(rectangle_points(0.3, 0.4), half, placement=placement or Pose2(-0.7, 0.15, -math.pi / 2))


def asked(cloth: Garment, scene: Scene | None = None) -> Task:
    return Task.of(cloth, scene, max_expanded=1000)


@pytest.mark.long
@pytest.mark.parametrize("name", ["tie-halved", "scarf-halved"])
def test_an_article_that_cannot_be_halved_is_told_to_be_folded_nearer_its_end(name: str) -> None:
    cloth = load_garment(name)
    known = planned(name).answer
    found = next(s for s in suggestions(Task.of(cloth, time_limit_s=60.0), plan=known) if s.kind == "fold_line")
    assert f"{found.cost_s:.1f} s" in found.message
    assert "towards the robot" in found.message
    plan = planned_with(found.change, cloth)
    # It was found with a share of the work that a plan by itself may take.
    assert plan.cost_s is not None and plan.cost_s <= found.cost_s + 1e-9 and found.cost_s == found.plan.cost_s


def test_a_garment_out_of_reach_is_told_to_be_moved_where_it_can_be_folded() -> None:
    cloth = towel(FAR)
    assert not make_plan(cloth, FRONT_ONLY).is_solved
    found = next(
        s for s in suggestions(Task.of(cloth, FRONT_ONLY, work_limit_s=5.0, time_limit_s=60.0)) if s.kind == "placement"
    )
    assert "towards the robot" in found.message
    assert planned_with(found.change, cloth, FRONT_ONLY).cost_s == pytest.approx(found.cost_s, abs=1e-9)


def test_every_suggestion_is_proven_by_its_change_and_there_are_three_of_a_kind_at_most() -> None:
    cloth = towel(FAR)
    found = list(suggestions(Task.of(cloth, FRONT_ONLY, work_limit_s=4.0, time_limit_s=60.0)))
    assert len({s.kind for s in found}) > 1
    for kind in {s.kind for s in found}:
        assert len([s for s in found if s.kind == kind]) <= 3
    for one in found:
        assert planned_with(one.change, cloth, FRONT_ONLY).cost_s == pytest.approx(one.cost_s, abs=1e-9)


def test_a_garment_that_slips_off_the_edge_is_told_to_be_moved_no_further_than_it_must() -> None:
    # Of a strip 1 m long .49 m hang over the near edge; with a friction of .7 no more than .4118 m may.
    line = fold((0.0, 0.75), (0.2, 0.75))
    strip = garment(rectangle_points(0.2, 1.0), line, placement=Pose2(-1.29, 0.1, -math.pi / 2))
    task = Task.of(strip, Scene(friction=0.7), work_limit_s=10.0, time_limit_s=60.0)
    search = suggestions(task)
    found = next(one for one in search if one.kind == "placement")
    assert found.size == pytest.approx(0.08, abs=1e-6)
    assert "8 cm away from the robot" in found.message


def test_the_smallest_change_with_a_plan_is_suggested_and_the_smallest_with_one_as_quick() -> None:
    trial = SuggestionTrial("size", Message.plain("by"), {}, 0.0, asked(towel()))
    solved = make_plan(towel())
    costs = {4: 20.0, 3: 20.0, 2: 30.0}

    def at(amount: float) -> SuggestionTrial:
        return replace(trial, size=round(amount))

    def plan_of(size: float) -> Plan:
        cost_s = costs.get(round(size))
        last = replace(solved.steps[-1], start_s=0.0, duration_s=cost_s or 0.0)
        return replace(solved, status="infeasible" if cost_s is None else "solved", steps=(last,))

    proof = Proof(at(4), plan_of(4), 20.0)
    search, told, sent = narrowed(at, 0.0, 4.0, proof, 1.0), [], None
    with suppress(StopIteration):
        while True:
            wish = search.send(sent)
            sent = plan_of(wish.size) if isinstance(wish, SuggestionTrial) else None
            told += [] if isinstance(wish, SuggestionTrial) else [(wish.size, wish.cost_s)]
    assert told == [(2, 30.0), (3, 20.0)]


@pytest.mark.long
def test_a_garment_that_can_be_folded_is_told_of_nothing_but_a_better_place() -> None:
    cloth = towel(FAR)
    known = make_plan(cloth)
    assert known.cost_s is not None
    found = list(suggestions(Task.of(cloth, work_limit_s=5.0, time_limit_s=60.0)))
    assert [s.kind for s in found] == ["placement"]
    assert found[0].cost_s < known.cost_s - 1.0


@pytest.mark.long
def test_two_folds_that_are_both_out_of_reach_are_told_to_be_shifted_together() -> None:
    # The table is so high that neither end of the strip can be lifted as far as it is to its line.
    lines = fold((0.235, 0.0), (0.235, 0.1), name="left end"), fold((0.725, 0.1), (0.725, 0.0), name="right end")
    strip = garment(rectangle_points(0.96, 0.1), *lines, placement=Pose2(-0.6, 0.48, -math.pi / 2))
    high = Scene(table=Table(height_m=1.35))
    known = make_plan(strip, high, time_limit_s=60.0)
    assert {reason.fold for reason in known.reasons} == {0, 1}
    wish = least_of(fold_lines(asked(strip, high), (0, 1)))
    assert wish.says.code == "shift_folds"
    assert [shift["fold"] for shift in wish.says.values["shifts"]] == [0, 1]
    assert planned_with(wish.change, strip, high).is_solved


def least_of(search: Search) -> Suggestion:
    """Return the final suggestions of a search without a time limit."""
    wish = next(search)
    while isinstance(wish, SuggestionTrial):
        task = replace(wish.task, limits=replace(wish.task.limits, time_limit_s=60.0))
        wish = search.send(find_plan(task, with_reasons=False).plan)
    return wish


def test_the_friction_that_is_suggested_is_the_least_in_hundredths() -> None:
    # Folded over x = 0.3 of 1.2 m across the table, 0.11 m hang and 1.09 m of layers lie: 0.1009 would do.
    strip = garment(rectangle_points(1.2, 0.2), fold((0.3, 0.0), (0.3, 0.2)), placement=Pose2(-0.6, 0.6, -math.pi / 2))
    smooth = Scene(friction=0.0)
    for reasons in (make_plan(strip, smooth, time_limit_s=60.0).reasons, ()):
        found = least_of(frictions(asked(strip, smooth), reasons))
        assert found.change["scene"]["friction"] == pytest.approx(0.11)
        assert found.plan.is_solved


def test_the_grip_radius_that_is_suggested_is_the_least_in_whole_millimetres() -> None:
    # The corners of a ribbon's end are 0.05 m apart, too near for two hands; one between them needs 0.025 m.
    line = fold((0.05, 0.15), (0.0, 0.15), radius_m=0.01)
    ribbon = garment(rectangle_points(0.05, 0.3), line, placement=Pose2(-0.7, 0.21, -math.pi / 2))
    known = make_plan(ribbon, time_limit_s=60.0)
    for reasons in (known.reasons, ()):
        found = least_of(grip_radii(asked(ribbon), (0,), reasons))
        assert found.change["garment"]["folds"][0]["grip_radius_m"] == pytest.approx(0.025)


@pytest.mark.long
def test_where_the_other_part_could_move_at_the_same_line_that_is_suggested() -> None:
    # Drawn the wrong way round: all of the cloth but a strip would move.
    line = fold((0.0, 0.1), (0.9, 0.1))
    cloth = garment(rectangle_points(0.9, 0.7), line, placement=Pose2(-0.75, 0.45, -math.pi / 2))
    task = asked(cloth)
    assert not find_plan(task).plan.is_solved
    found = least_of(flips(task, (0,)))
    (flipped,) = found.change["garment"]["folds"]
    assert (flipped["start"], flipped["end"]) == ([0.9, 0.1], [0.0, 0.1])
    assert found.message.startswith("Fold the other side of the cloth at fold 0")
    assert planned_with(found.change, cloth, task.scene).is_solved


def test_a_fold_whose_other_part_would_leave_the_others_in_the_air_is_not_flipped() -> None:
    folds = (fold((0.2, 0.3), (0.2, 0.0)), fold((0.1, 0.3), (0.1, 0.0)))
    cloth = garment(rectangle_points(0.3, 0.3), *folds)
    with pytest.raises(StopIteration):
        least_of(flips(asked(cloth), (0,)))


def test_assumptions_that_are_enough_only_together_are_suggested_together_each_the_least() -> None:
    # A ribbon that hangs over the table's edge, and whose corners are too near for two hands.
    line = fold((0.3, 0.0), (0.3, 0.05), radius_m=0.01)
    ribbon = garment(rectangle_points(1.2, 0.05), line, placement=Pose2(-0.6, 0.6, -math.pi / 2))
    task = asked(ribbon, Scene(friction=0.0))
    for alone in (comforts(task), frictions(task, ()), grip_radii(task, (0,), ())):
        with pytest.raises(StopIteration):
            least_of(alone)
    found = least_of(together(task, (0,)))
    assert found.is_assumption
    assert found.change["scene"]["friction"] == pytest.approx(0.11)
    assert found.change["garment"]["folds"][0]["grip_radius_m"] == pytest.approx(0.025)
    assert "comfort_radius_m" not in found.change
    assert found.message.startswith("Assume a friction coefficient of 0.11, not 0 and assume that one grip holds")
    assert planned_with(found.change, ribbon, task.scene).is_solved


def test_assumptions_of_which_one_is_enough_are_not_suggested_together() -> None:
    line = fold((0.05, 0.15), (0.0, 0.15), radius_m=0.01)
    ribbon = garment(rectangle_points(0.05, 0.3), line, placement=Pose2(-0.7, 0.21, -math.pi / 2))
    with pytest.raises(StopIteration):
        least_of(together(asked(ribbon), (0,)))


def test_what_is_planned_already_is_not_planned_again() -> None:
    cloth = towel(FAR)
    known = make_plan(cloth, FRONT_ONLY)
    assert list(suggestions(Task.of(cloth, FRONT_ONLY), plan=known, should_stop=lambda: True)) == []


def test_a_search_that_is_told_to_stop_does_so_within_a_second() -> None:
    cloth = towel(FAR)
    is_unwanted = False
    found = suggestions(Task.of(cloth, FRONT_ONLY, time_limit_s=60.0), should_stop=lambda: is_unwanted)
    next(found)
    is_unwanted = True
    started = time.perf_counter()
    assert list(found) == []
    assert time.perf_counter() - started < 1.0


@pytest.mark.parametrize("options", [{"time_limit_s": 0.0}, {"start_station": "roof"}, {"heuristic": "magic"}])
def test_a_wrong_option_is_refused_before_the_first_suggestion(options: dict[str, Any]) -> None:
    with pytest.raises(RequestError) as caught:
        suggestions(Task.of(towel(), **options))
    assert caught.value.field == next(iter(options))


def test_an_illegal_fold_is_refused_before_the_first_suggestion() -> None:
    with pytest.raises(FoldError):
        suggestions(Task.of(garment(rectangle_points(0.3, 0.4), fold((1.0, 0.2), (2.0, 0.2)))))


def test_a_shifted_line_runs_from_edge_to_edge_and_later_lines_follow_the_cloth() -> None:
    # A triangle, 1 m wide at the bottom and 1 m high: at height y it is 1 - y wide.
    first, second = fold((0.9, 0.2), (0.1, 0.2)), fold((0.5, 0.2), (0.5, 1.0))
    cloth = garment([(0.0, 0.0), (1.0, 0.0), (0.5, 1.0)], first, second)
    changed = redrawn(cloth, 0, Segment((0.9, 0.3), (0.1, 0.3)))
    assert changed is not None
    assert changed.folds[0].start == pytest.approx((0.85, 0.3), abs=1e-4)
    assert changed.folds[0].end == pytest.approx((0.15, 0.3), abs=1e-4)
    assert changed.folds[1].start == pytest.approx((0.5, 0.3), abs=1e-4)


def test_a_line_shifted_off_the_cloth_is_none() -> None:
    assert redrawn(towel(), 0, Segment((0.3, 0.5), (0.0, 0.5))) is None


def test_of_several_stretches_the_one_where_the_line_was_is_taken() -> None:
    # Two towers on a base: at y = 0.8 the whole line meets both.
    towers = [(0, 0), (1, 0), (1, 1), (0.7, 1), (0.7, 0.5), (0.3, 0.5), (0.3, 1), (0, 1)]
    line = chord(Region.polygon(towers), Segment((0.95, 0.8), (0.75, 0.8)))
    assert line is not None
    assert line.start == pytest.approx((1.0, 0.8), abs=1e-4)
    assert line.end == pytest.approx((0.7, 0.8), abs=1e-4)


@pytest.mark.parametrize("name", ["shirt", "hand-towel"])
def test_another_order_ends_in_the_same_outline(name: str) -> None:
    shipped = load_garment(name)
    wanted = FoldSequence.of(shipped).final.silhouette
    trials = all_trials(asked(shipped))
    assert trials
    for trial in trials:
        changed = trial.task.garment
        assert changed.folds != shipped.folds
        assert sorted(f.name for f in changed.folds) == sorted(f.name for f in shipped.folds)
        found = FoldSequence.of(changed).final.silhouette
        assert found.difference(wanted).area + wanted.difference(found).area < 1e-5


def all_trials(task: Task) -> list[SuggestionTrial]:
    """Return all orders that the search would try if none worked."""
    trials, search = [], orders(task)
    unsolved = make_plan(towel(FAR), FRONT_ONLY)
    wish = next(search, None)
    try:
        while isinstance(wish, SuggestionTrial):
            trials.append(wish)
            wish = search.send(unsolved)
    except StopIteration:
        pass
    return trials


def test_no_station_is_proposed_that_is_there_already() -> None:
    scene = replace(Scene(), stations=(*Scene().stations, ("far", Pose2(0.95, 0.0, math.pi))))
    first = next(stations(asked(towel(), scene)))
    assert isinstance(first, SuggestionTrial)
    assert [name for name, _ in first.task.scene.stations][-1] == "middle_left"


def test_turned_in_place_the_middle_stays() -> None:
    cloth = towel()
    middle = np.array([0.15, 0.2])
    for quarters in range(4):
        turned = turned_in_place(cloth, cloth.placement, quarters)
        assert turned.to_outer(middle) == pytest.approx(cloth.placement.to_outer(middle))


def test_the_room_of_a_garment_ends_where_its_edge_meets_the_tables() -> None:
    # At yaw -90 degrees the towel reaches from x = -0.7 to -0.3 and from y = -0.15 to 0.15; the table is 1.6 x 0.98 m.
    room = Room.of(towel(), Pose2(-0.7, 0.15, -math.pi / 2), Scene().table)
    assert room.low == pytest.approx((-0.1, -0.34))
    assert room.high == pytest.approx((1.1, 0.34))
    assert room.nearest == (0.0, 0.0)
    assert len(list(room.moves(0.1))) == 13 * 7


def test_a_garment_larger_than_the_table_has_no_room() -> None:
    room = Room.of(garment(rectangle_points(2.0, 2.0)), Pose2(0.0, 0.0, 0.0), Scene().table)
    assert room.is_none
    assert not list(room.moves(0.1))


def test_a_map_has_a_cell_for_each_place_and_its_best_is_the_cheapest() -> None:
    found = placement_map(Task.of(towel(), FRONT_ONLY, time_limit_s=60.0), step_m=0.3)
    assert found.is_complete
    assert len(found.cells) == 4 * 3  # the room above, in steps of 0.3 m
    costs = [cell.cost_s for cell in found.cells if cell.cost_s is not None]
    assert found.best is not None
    assert found.best.cost_s == min(costs)
    assert len(costs) < len(found.cells)
    best = make_plan(towel(), FRONT_ONLY, placement=found.best.placement)
    assert best.cost_s == pytest.approx(found.best.cost_s, abs=1e-9)


def test_a_map_cut_short_says_so() -> None:
    for limits in (TaskOptions(work_limit_s=0.2), TaskOptions(time_limit_s=0.2)):
        found = placement_map(Task.of(towel(), **limits), step_m=0.02)
        assert not found.is_complete
        assert found.to_dict()["complete"] is False


def is_complete(found: Suggestions) -> bool:
    """Return the last answer of a search: whether it is complete."""
    while True:
        try:
            next(found)
        except StopIteration as end:
            return bool(end.value)


def test_a_search_says_whether_it_has_tried_everything() -> None:
    # A single fold, done from where it lies: only better placements are looked for, and the table leaves room for few.
    cloth = towel(Pose2(-0.2, 0.15, -math.pi / 2))
    small = Scene(table=Table(0.5, 0.5), stations=(("front", Pose2(-0.4, 0.0, 0.0)),))
    assert make_plan(cloth, small).is_solved
    assert is_complete(suggestions(Task.of(cloth, small, time_limit_s=60.0)))
    assert not is_complete(suggestions(Task.of(cloth, small, time_limit_s=60.0), should_stop=lambda: True))
    for limits in (TaskOptions(work_limit_s=0.01), TaskOptions(time_limit_s=0.01)):
        assert not is_complete(suggestions(Task.of(towel(FAR), FRONT_ONLY, **limits)))


def test_a_trial_that_was_cut_off_before_its_answer_is_not_taken_for_a_no() -> None:
    # Two folds take two states to expand, so none of the trials comes to an answer.
    once = towel(Pose2(-0.2, 0.15, -math.pi / 2))
    cloth = replace(once, folds=(*once.folds, fold((0.15, 0.2), (0.15, 0.4))))
    small = Scene(table=Table(0.5, 0.5), stations=(("front", Pose2(-0.4, 0.0, 0.0)),))
    known = make_plan(cloth, small)
    cut_off = Task.of(cloth, small, max_expanded=1, time_limit_s=60.0)
    assert find_plan(cut_off, with_reasons=False).plan.status == "budget_exceeded"
    assert not is_complete(suggestions(cut_off, plan=known))


def slow() -> bool:
    """Return a question whether to stop that a slow machine answers slowly."""
    time.sleep(0.001)
    return False


@pytest.mark.long
@pytest.mark.parametrize("work_s", [0.4, 1.0])
def test_on_a_slow_machine_the_same_changes_are_suggested(work_s: float) -> None:
    limits = TaskOptions(work_limit_s=work_s, time_limit_s=60.0)
    quick, slowly = (
        [one.to_dict() for one in suggestions(Task.of(towel(FAR), FRONT_ONLY, **limits), should_stop=should_stop)]
        for should_stop in (None, slow)
    )
    assert slowly == quick != []


def test_on_a_slow_machine_the_map_has_the_same_cells() -> None:
    limits = TaskOptions(work_limit_s=0.4, time_limit_s=60.0)
    quick, slowly = (
        placement_map(Task.of(towel(), FRONT_ONLY, **limits), should_stop=should_stop) for should_stop in (None, slow)
    )
    assert slowly == quick
    assert quick.cells and not quick.is_complete
