"""The way of empty arms from wherever they are to where a step of a plan begins."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from planner.errors import RequestError, UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.motion.joint_trajectory import Keyframes
from planner.motion.lying_cloth import LyingCloths
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.transit_paths import TransitPaths
from planner.planning.problem import Problem
from planner.task.plan import Plan
from planner.task.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class WayToStep:
    """A search for ways to where a step of a plan begins, in which no cloth is held.

    Attributes:
        names: the arms' joints, arm by arm.
        goal: where they are as the step begins (rad, m).
    """

    names: tuple[str, ...]
    goal: FloatArray
    _problem: Problem
    _step: int
    _plan: Plan

    @staticmethod
    def of(plan: Plan, step: int) -> "WayToStep":
        """Make ready for a step of a plan, counted from 0.

        Raises:
            UnsolvedPlanError: the plan is not solved.
            RequestError: there is no such step, or cloth is held as it begins.
        """
        path = require_beginning(plan, step)
        at_s = plan.steps[step].start_s if plan.steps else 0.0
        return WayToStep(path.arms.names, path.arms.at(at_s), Problem.of(plan.task), step, plan)

    def way(self, joints: Mapping[str, float]) -> Keyframes | None:
        """Return the motion from given joints (rad, m) to the step, from stop to stop at each bend; None without one.

        Nothing touches on it, fingers wide open, and arms stay over the cloth but for their first and last centimetres.
        """
        start = np.array([joints[name] for name in self.names])
        plan, problem, path = self._plan, self._problem, self._plan.trajectory
        assert path is not None
        at_s = plan.steps[self._step].start_s if plan.steps else 0.0
        collisions = OpenedCollisions(problem.robot, problem.context.scene.table, path.torso_m)
        transits = TransitPaths(problem.robot, collisions, path.torso_m)
        cloth = LyingCloths(problem.context, collisions).of(problem.state_of(plan.state_after(self._step - 1)))
        base = path.segment_at(at_s).base_at(at_s)
        found = transits.way(base, start, self.goal, cloth, transits.at_grips)
        return None if found is None else _timed(transits, found)


def require_beginning(plan: Plan, step: int) -> Trajectory:
    """Return a plan's trajectory; raise as `WayToStep.of` does where nothing can begin with that step."""
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    if not 0 <= step < max(len(plan.steps), 1):
        raise RequestError("from_step", f"{step} is not between 0 and {len(plan.steps) - 1}")
    if plan.state_after(step - 1).held:
        free = max((n for n in range(step) if not plan.state_after(n - 1).held), default=None)
        other = "" if free is None else f"; step {free} begins with free grippers"
        raise RequestError("from_step", f"step {step} begins with cloth in the grippers{other}")
    return plan.trajectory


def _timed(transits: TransitPaths, way: FloatArray) -> Keyframes:
    parts: list[Keyframes] = [Keyframes.still(way[0], 0.0)]
    for start, end, lasts_s in _lines(way, transits.needed_s(way)):
        line = transits.eased(start, end, lasts_s)
        parts.append(Keyframes(*(values[1:] for values in line)).later(float(parts[-1].times_s[-1])))
    return Keyframes.joined(parts)


def _lines(way: FloatArray, lasts_s: FloatArray) -> Sequence[tuple[FloatArray, FloatArray, float]]:
    """Return the lines that lead somewhere, and how long each takes (s)."""
    lines = zip(way[:-1], way[1:], lasts_s.tolist(), strict=True)
    return [(start, end, time_s) for start, end, time_s in lines if time_s > 0.0]
