"""A planning problem with some obstacles removed, and the interface for trying it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.planning.problem import Problem
from planner.planning.trial import Trial
from planner.primitives.context import Context
from planner.task.scene import Scene


@dataclass(frozen=True, slots=True, eq=False)
class RelaxedProblem:
    """A planning problem with some causes removed.

    Attributes:
        problem: the problem, with all changes that a request can express.
        change: the fields of the request that changed; None where no request can express the change.
        has_long_arms: whether every place is in reach.
        more_hands: the number of hands beyond the robot's; with any, all hands reach every place.
        may_collide: whether the arms may pass through anything.
    """

    problem: Problem
    change: Mapping[str, Any] | None
    has_long_arms: bool = False
    more_hands: int = 0
    may_collide: bool = False

    @staticmethod
    def of(problem: Problem) -> "RelaxedProblem":
        """Return a problem as it is."""
        return RelaxedProblem(problem, {})

    @property
    def context(self) -> Context:
        """The planning context."""
        return self.problem.context

    @property
    def searched(self) -> Problem:
        """The problem to search, with nothing computed yet."""
        return self.problem.with_long_arms(self.more_hands) if self.has_long_arms else self.problem.varied()

    def with_garment(self, garment: Garment) -> "RelaxedProblem":
        """Replace the garment; raise `FoldError` if a fold of it is not legal."""
        return self._varied(self.problem.varied(garment=garment), {"garment": garment.to_dict()})

    def with_scene(self, scene: Scene) -> "RelaxedProblem":
        """Replace the scene; raise `SceneError` if the robot cannot be as it says."""
        return self._varied(self.problem.varied(scene=scene), {"scene": scene.to_dict()})

    def with_placement(self, placement: Pose2) -> "RelaxedProblem":
        """Place the article elsewhere on the table."""
        return self._varied(self.problem.varied(placement=placement), {"placement": placement.to_dict()})

    def with_comfort(self, comfort_m: float) -> "RelaxedProblem":
        """Replace the comfort radius (m)."""
        return self._varied(self.problem.varied(comfort_m=comfort_m), {"comfort_radius_m": comfort_m})

    def with_reach_behind(self, behind_m: float) -> "RelaxedProblem":
        """Allow carrying cloth that reaches this far behind a line's extension (m)."""
        return replace(self, problem=self.problem.varied(behind_max_m=behind_m), change=None)

    def with_long_arms(self) -> "RelaxedProblem":
        """Put every place in reach; since such arms belong to no robot, collisions are ignored."""
        return replace(self, change=None, has_long_arms=True, may_collide=True)

    def with_more_hands(self, number: int) -> "RelaxedProblem":
        """Add hands; since they belong to no robot, all hands reach every place."""
        return replace(self.with_long_arms(), more_hands=number)

    def with_grips_nearer(self, apart_m: float) -> "RelaxedProblem":
        """Allow hands to be as near to each other as this (m)."""
        return replace(self, problem=self.problem.varied(grips_apart_m=apart_m), change=None)

    def with_collisions_ignored(self) -> "RelaxedProblem":
        """Let the arms pass through anything."""
        return replace(self, change=None, may_collide=True)

    def _varied(self, problem: Problem, fields: Mapping[str, Any]) -> "RelaxedProblem":
        return replace(self, problem=problem, change=None if self.change is None else {**self.change, **fields})


Ask = Callable[[RelaxedProblem, int], Trial]
"""Tries whether some folds of a relaxed problem, a bit mask, can be done."""
