"""Cloth that is too large, or has too much rim, is offered in the largest size that can be folded."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from planner import Task, make_plan
from planner.explain.suggestion_size import STEP, sizes
from tests.builders import fold, garment
from tests.explain.proven_search import proven
from tests.planning.provoked import planned_with

ROUND = garment(
    tuple((0.3 + 0.3 * math.cos(math.tau * i / 24), 0.3 + 0.3 * math.sin(math.tau * i / 24)) for i in range(24)),
    fold((0.3, 0.6), (0.3, 0.0)),
)
"""A round cloth of 60 cm: half of its rim, 94 cm, must be held by two hands that hold 25 cm of it each."""


def test_a_round_cloth_is_offered_in_the_largest_size_that_two_hands_can_fold() -> None:
    task = Task.of(ROUND)
    *_, last = proven(sizes(task))
    assert last.says.code == "smaller"
    assert planned_with(last.change, ROUND).cost_s == pytest.approx(last.cost_s, abs=1e-9)
    by = last.says.values["by"]
    assert last.says.values["size_m"] == pytest.approx([0.6 * (1.0 - by)] * 2)
    larger = _outline(ROUND, 1.0 - by + STEP)
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
