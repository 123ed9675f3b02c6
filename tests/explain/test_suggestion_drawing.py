"""Changes to the drawing: lines shifted or flipped, another order, one more fold, a smaller garment."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from planner import FoldSequence, Garment, Scene, Task, find_plan, load_garment, make_plan
from planner.explain.suggestion import Search
from planner.explain.suggestion_drawing import (
    SIZE_STEP,
    chord,
    flips,
    fold_lines,
    halvings,
    orders,
    redrawn,
    sizes,
    splits,
    with_fold_before,
)
from planner.geometry.pose import Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from tests.builders import fold, garment, rectangle_points
from tests.explain.proven_search import asked, proven, towel, tried_in_vain
from tests.planning.provoked import planned_with

APRON = ((0, 0), (0.7, 0), (0.7, 0.5), (0.56, 0.58), (0.5, 0.9), (0.35, 0.88), (0.2, 0.9), (0.14, 0.58), (0, 0.5))

"""Nine corners; halved lengthwise, three corners far from each other must be held."""

ROUND = garment(
    tuple((0.3 + 0.3 * math.cos(math.tau * i / 24), 0.3 + 0.3 * math.sin(math.tau * i / 24)) for i in range(24)),
    fold((0.3, 0.6), (0.3, 0.0)),
)

"""A round cloth of 60 cm: half of its rim, 94 cm, must be held by two hands that hold 25 cm of it each."""


@pytest.mark.long
def test_two_folds_that_are_both_out_of_reach_are_told_to_be_shifted_together() -> None:
    # The table is so high that neither end of the strip can be lifted as far as it is to its line.
    lines = fold((0.235, 0.0), (0.235, 0.1), name="left end"), fold((0.725, 0.1), (0.725, 0.0), name="right end")
    strip = garment(rectangle_points(0.96, 0.1), *lines, placement=Pose2(-0.6, 0.48, -math.pi / 2))
    high = Scene(table=Table(height_m=1.35))
    known = make_plan(strip, high, time_limit_s=60.0)
    assert {reason.fold for reason in known.reasons} == {0, 1}
    wish = next(proven(fold_lines(asked(strip, high), (0, 1))))
    assert wish.says.code == "shift_folds"
    assert [shift["fold"] for shift in wish.says.values["shifts"]] == [0, 1]
    assert planned_with(wish.change, strip, high).is_solved


@pytest.mark.long
def test_where_the_other_part_could_move_at_the_same_line_that_is_suggested() -> None:
    # Drawn the wrong way round: all of the cloth but a strip would move.
    line = fold((0.0, 0.1), (0.9, 0.1))
    cloth = garment(rectangle_points(0.9, 0.7), line, placement=Pose2(-0.75, 0.45, -math.pi / 2))
    task = asked(cloth)
    assert not find_plan(task).plan.is_solved
    found = next(proven(flips(task, (0,))))
    (flipped,) = found.change["garment"]["folds"]
    assert (flipped["start"], flipped["end"]) == ([0.9, 0.1], [0.0, 0.1])
    assert found.message.startswith("Fold the other side of the cloth at fold 0")
    assert planned_with(found.change, cloth, task.scene).is_solved


def test_a_fold_whose_other_part_would_leave_the_others_in_the_air_is_not_flipped() -> None:
    folds = (fold((0.2, 0.3), (0.2, 0.0)), fold((0.1, 0.3), (0.1, 0.0)))
    cloth = garment(rectangle_points(0.3, 0.3), *folds)
    with pytest.raises(StopIteration):
        next(proven(flips(asked(cloth), (0,))))


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
    trials = list(tried_in_vain(orders(asked(shipped))))
    assert trials
    for trial in trials:
        changed = trial.task.garment
        assert changed.folds != shipped.folds
        assert sorted(f.name for f in changed.folds) == sorted(f.name for f in shipped.folds)
        found = FoldSequence.of(changed).final.silhouette
        assert found.difference(wanted).area + wanted.difference(found).area < 1e-5


@pytest.fixture(scope="module")
def apron() -> Garment:
    cloth = garment(APRON, fold((0.35, 0.0), (0.35, 0.88)))
    assert not FoldSequence.of(cloth).covers(0, 0.0873, 2).is_holdable
    return cloth


@pytest.mark.parametrize(("search", "code"), [(splits, "split_fold"), (halvings, "halve_first")])
def test_an_apron_halved_lengthwise_first_is_done_with_one_more_fold(
    apron: Garment, search: Callable[[Task, Sequence[int]], Search], code: str
) -> None:
    found = next(proven(search(Task.of(apron), (0,))))
    assert found.says.code == code
    assert len(found.change["garment"]["folds"]) == 2
    assert planned_with(found.change, apron).cost_s == pytest.approx(found.cost_s, abs=1e-9)


def test_a_split_fold_leaves_the_same_cloth_on_the_side_that_stays(apron: Garment) -> None:
    found = next(proven(splits(Task.of(apron), (0,))))
    before = FoldSequence.of(apron).final.silhouette
    after = FoldSequence.of(Garment.from_dict(found.change["garment"])).final.silhouette
    assert after.difference(before).is_sliver


def test_a_fold_before_another_cuts_later_lines_to_the_cloth_as_it_is_then() -> None:
    cloth = garment(rectangle_points(0.6, 0.4), fold((0.3, 0.0), (0.3, 0.4)))
    changed = with_fold_before(cloth, 0, Segment((0.6, 0.2), (0.0, 0.2)))
    assert changed is not None
    ends = [[*one.start, *one.end] for one in changed.folds]
    assert np.allclose(ends, [[0.6, 0.2, 0.0, 0.2], [0.3, 0.2, 0.3, 0.4]], atol=1e-4)


def test_where_the_line_misses_the_cloth_no_fold_is_added() -> None:
    cloth = garment(rectangle_points(0.6, 0.4), fold((0.3, 0.0), (0.3, 0.4)))
    assert with_fold_before(cloth, 0, Segment((2.0, 0.0), (2.0, 0.4))) is None


def test_a_round_cloth_is_offered_in_the_largest_size_that_two_hands_can_fold() -> None:
    task = Task.of(ROUND)
    *_, last = proven(sizes(task))
    assert last.says.code == "smaller"
    assert planned_with(last.change, ROUND).cost_s == pytest.approx(last.cost_s, abs=1e-9)
    by = last.says.values["by"]
    assert last.says.values["size_m"] == pytest.approx([0.6 * (1.0 - by)] * 2)
    larger = _outline(ROUND, 1.0 - by + SIZE_STEP)
    assert make_plan(Task.of(larger)).status != "solved"


def test_the_edge_near_the_robot_stays_where_it_is() -> None:
    task = Task.of(ROUND)
    found = next(proven(sizes(task)))
    before = task.start.placement.to_outer(np.array(ROUND.outline))
    changed = replace(ROUND, outline=tuple(map(tuple, found.change["garment"]["outline"])), folds=())
    pose = replace(task.start.placement, **found.change["placement"])
    after = pose.to_outer(np.array(changed.outline))
    assert after[:, 0].min() == pytest.approx(before[:, 0].min())
    assert np.ptp(after, axis=0) == pytest.approx((1.0 - found.says.values["by"]) * np.ptp(before, axis=0))


def _outline(cloth: Any, share: float) -> Any:
    """Return a garment with all its lengths multiplied by a share."""
    points = tuple((share * x, share * y) for x, y in cloth.outline)
    folds = tuple(
        replace(one, start=(share * one.start[0], share * one.start[1]), end=(share * one.end[0], share * one.end[1]))
        for one in cloth.folds
    )
    return replace(cloth, outline=points, folds=folds)
