"""Restrict a task: every plan for the restricted task is also a plan for the task itself.

A search tries the first few ways to perform a step. With more room there are more ways, and the first few may all be
ways that the arms can hardly follow, so a task that allows more could get a slower plan, or none. Where a plan is not
proven, planning therefore searches restricted tasks as well.
"""

from collections.abc import Iterator
from dataclasses import replace

from planner.planning.problem import Problem

_COMFORTS_M = (0.01, 0.02, 0.03)
"""Larger comfort radii to try (m)."""

_CONES_RAD = (0.0, 0.5, 1.0)
"""Narrower approach cones to try (rad)."""


def with_arms_apart(problem: Problem) -> Iterator[Problem]:
    """Yield the problem with hands only where the other arm at home leaves room, if the robot can check that."""
    if problem.robot.can_mind_arms:
        yield problem.restricted(minds_arms=True)


def with_more_comfort(problem: Problem) -> Iterator[Problem]:
    """Yield the problem with larger comfort radii, the smallest first."""
    return (problem.restricted(comfort_m=more_m) for more_m in _COMFORTS_M if problem.context.reach.comfort_m < more_m)


def with_narrower_cones(problem: Problem) -> Iterator[Problem]:
    """Yield the problem with narrower approach cones, the narrowest first, since it is the quickest to search."""
    scene = problem.context.scene
    narrower = (cone_rad for cone_rad in _CONES_RAD if cone_rad < scene.approach_cone_rad)
    return (problem.restricted(scene=replace(scene, approach_cone_rad=cone_rad)) for cone_rad in narrower)
