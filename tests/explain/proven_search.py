"""Small tasks without a plan, and how a search for suggestions of one kind is run to its end."""

import math
from collections.abc import Iterator
from types import SimpleNamespace
from typing import cast

from planner import Garment, Scene, Task
from planner.explain.suggestion import Search, Suggestion, SuggestionTrial
from planner.geometry.pose import Pose2
from planner.task.plan import Plan
from tests.builders import fold, garment, rectangle_points
from tests.planning.provoked import FRONT, plan_of

FRONT_ONLY = Scene(stations=FRONT)
FAR = Pose2(0.4, 0.15, -math.pi / 2)

IN_VAIN = cast(Plan, SimpleNamespace(cost_s=None))
"""The answer to a trial that does not help."""


def towel(placement: Pose2 | None = None) -> Garment:
    """Return a towel, 40 cm along the robot's arms and 30 cm deep, folded once away from the robot."""
    half = fold((0.3, 0.2), (0.0, 0.2))
    return garment(rectangle_points(0.3, 0.4), half, placement=placement or Pose2(-0.7, 0.15, -math.pi / 2))


def asked(cloth: Garment, scene: Scene | None = None) -> Task:
    return Task.of(cloth, scene, max_expanded=1000)


def proven(search: Search) -> Iterator[Suggestion]:
    """Yield the suggestions of a search of which every wish for a plan is granted, whatever time that takes."""
    plan: Plan | None = None
    while True:
        try:
            wish = search.send(plan)
        except StopIteration:
            return
        plan = None
        if isinstance(wish, Suggestion):
            yield wish
        else:
            plan = plan_of(wish.task)


def tried_in_vain(search: Search) -> Iterator[SuggestionTrial]:
    """Yield all trials of a search in which none gives a plan."""
    plan: Plan | None = None
    while True:
        try:
            wish = search.send(plan)
        except StopIteration:
            return
        assert isinstance(wish, SuggestionTrial)
        yield wish
        plan = IN_VAIN
