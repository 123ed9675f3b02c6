"""The poses of a plan's grips, for robots that plan their own motions.

In each step, a hand has up to five poses: before the grasp, the grasp, the highest on the cloth's way, the place where
that ends, and after the retreat. Each is given in the frame of the robot's base, as that stands at this moment (it may
drive while it folds), and in the table's. Each grip has its kind: with one finger under the cloth and one over it, or
with both from above (see `planner.task.world_state.GripKind`). A hand that holds its cloth from the step before has no
pose before its grasp, one that keeps it for the next step has no retreat.
"""

import io
import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from ruamel.yaml import YAML

from app.step_kinds import step_words
from app.ui.rotation import from_matrix
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import DECIMALS, TIME_S
from planner.robots.armed_robot import ArmedRobot
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Trajectory

VERSION = 1

STANDOFF_M = 0.08
"""The tool's distance from its grasp before it, and from its release after it (m), where its path is as long."""

_LOOK_S = 0.02
"""Time between the moments at which the tool is looked at (s)."""

_FRAMES = {
    "table": "origin in the middle of the table's top, x away from the station front, z up",
    "base": "origin on the floor below the robot's base, x ahead, z up",
    "tool": "origin between the fingertips, x where the fingers point; they close along y",
}
_UNITS = {
    "position": "m",
    "quaternion": "x, y, z, w",
    "opening_m": "m, when the pose is left",
    "t_s": "s, plan's clock",
}


def grasp_poses(plan: Plan) -> dict[str, Any]:
    """Return the poses of all grips of a solved plan, step by step, as JSON.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    robot = load_robot(plan.task.robot)
    hands = _Hands(plan, plan.trajectory, robot)
    return {
        "version": VERSION,
        "garment": plan.garment.name,
        "robot": robot.card.name,
        "units": _UNITS,
        "frames": _FRAMES,
        "steps": [hands.step(number) for number in range(len(plan.steps))],
    }


def poses_json(plan: Plan) -> bytes:
    """Return the poses as a JSON file."""
    return (json.dumps(grasp_poses(plan), indent=1) + "\n").encode("ascii")


def poses_yaml(plan: Plan) -> bytes:
    """Return the poses as a YAML file."""
    written = io.BytesIO()
    yaml = YAML(typ="safe", pure=True)
    yaml.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    yaml.dump(grasp_poses(plan), written)
    return written.getvalue()


@dataclass(frozen=True, slots=True)
class _Hold:
    """A time in which one hand holds cloth, from its start to its end (s)."""

    start_s: float
    end_s: float


class _Hands:
    """The hands of a plan's robot."""

    def __init__(self, plan: Plan, path: Trajectory, robot: ArmedRobot) -> None:
        self._plan, self._path, self._robot = plan, path, robot
        counts = [len(arm.joint_names) for arm in robot.card.arms]
        self._spans = [slice(end - n, end) for n, end in zip(counts, np.cumsum(counts).tolist(), strict=True)]
        self._holds = [_holds(path, arm) for arm in range(len(counts))]

    def step(self, number: int) -> dict[str, Any]:
        """Return the poses of the hands that hold cloth in a step."""
        step = self._plan.steps[number]
        grips = []
        for arm, holds in enumerate(self._holds):
            for hold in holds:
                start_s, end_s = max(hold.start_s, step.start_s), min(hold.end_s, step.end_s)
                if end_s - start_s > TIME_S:
                    grips.append(self._grip(step, arm, hold, _Hold(start_s, end_s)))
        return {
            "step": number,
            "kind": step.kind,
            "fold": step.fold,
            "what": step_words(step, self._plan.garment),
            "base_in_table": {"start": step.before.base.pose.to_dict(), "end": step.base.pose.to_dict()},
            "grips": grips,
        }

    def _grip(self, step: PlanStep, arm: int, hold: _Hold, part: _Hold) -> dict[str, Any]:
        """Return the poses of a hand in a step's part of a hold."""
        is_held_before, is_held_after = part.start_s > hold.start_s + TIME_S, part.end_s < hold.end_s - TIME_S
        keyframes = np.array(self._path.arms.times_s)
        within = keyframes[(keyframes > part.start_s) & (keyframes < part.end_s)]
        times = np.concatenate([[part.start_s], within, [part.end_s]])
        heights = [self._tool(arm, t)[0][2] for t in times.tolist()]
        before_s = None if is_held_before else self._away(arm, hold.start_s, self._free_since(arm, hold))
        after_s = None if is_held_after else self._away(arm, hold.end_s, self._free_until(arm, hold))
        moments = {
            "pre_grasp": before_s,
            "grasp": part.start_s,
            "lift": float(times[int(np.argmax(heights))]),
            "place": part.end_s,
            "retreat": after_s,
        }
        name = self._robot.card.arms[arm].name
        return {
            "arm": name,
            "kind": next((grip.kind for grip in step.grips if grip.arm == name), None),
            "held_before": is_held_before,
            "held_after": is_held_after,
            **{name: None if t is None else self._pose(arm, t) for name, t in moments.items()},
        }

    def _free_since(self, arm: int, hold: _Hold) -> float:
        return max((one.end_s for one in self._holds[arm] if one.end_s <= hold.start_s), default=0.0)

    def _free_until(self, arm: int, hold: _Hold) -> float:
        later = (one.start_s for one in self._holds[arm] if one.start_s >= hold.end_s)
        return min(later, default=self._path.duration_s)

    def _away(self, arm: int, near_s: float, far_s: float) -> float | None:
        """Return when on the way between two times the hand is first as far from the first place as it should be.

        None where it never moves; where its way is too short, when it is furthest away.
        """
        times = _between(near_s, far_s)
        places = np.array([self._in_table(self._tool(arm, t)[0], t) for t in times.tolist()])
        distances = np.sqrt(((places - places[0]) ** 2).sum(axis=1))
        far = np.flatnonzero(distances >= STANDOFF_M)
        best = int(far[0]) if len(far) else int(np.argmax(distances))
        return None if best == 0 else float(times[best])

    def _pose(self, arm: int, t_s: float) -> dict[str, Any]:
        """Return a tool's pose at a time in both frames, and its fingers' opening."""
        position, rotation = self._tool(arm, t_s)
        base = self._path.segment_at(t_s).base_at(t_s)
        turned = np.asarray(base.to_outer(rotation.T) - base.to_outer(np.zeros(3))).T
        return {
            "t_s": round(t_s, DECIMALS),
            "in_base": _written(position, rotation),
            "in_table": _written(self._in_table(position, t_s), turned),
            "base_in_table": base.to_dict(),
            "opening_m": round(self._path.grippers[arm].opening_at(t_s), DECIMALS),
        }

    def _tool(self, arm: int, t_s: float) -> tuple[FloatArray, FloatArray]:
        return self._robot.tool_pose(arm, self._path.arms.at(t_s)[self._spans[arm]], self._path.torso_m)

    def _in_table(self, position: FloatArray, t_s: float) -> FloatArray:
        outer = self._path.segment_at(t_s).base_at(t_s).to_outer(position)
        return np.asarray(outer - np.array([0.0, 0.0, self._plan.scene.table.height_m]))


def _holds(path: Trajectory, arm: int) -> list[_Hold]:
    """Return the times in which a hand holds cloth, in order."""
    holds: list[_Hold] = []
    for segment in path.segments:
        hand = segment.phase.hands[arm]
        if hand is None or not hand.is_closed:
            continue
        start_s, end_s = segment.start_s, segment.start_s + segment.duration_s
        if holds and start_s - holds[-1].end_s <= TIME_S:
            holds[-1] = _Hold(holds[-1].start_s, end_s)
        else:
            holds.append(_Hold(start_s, end_s))
    return holds


def _between(start_s: float, end_s: float) -> FloatArray:
    """Return times from one to another (s), in either direction."""
    return np.linspace(start_s, end_s, int(abs(end_s - start_s) / _LOOK_S) + 2)


def _written(position: FloatArray, rotation: FloatArray) -> dict[str, list[float]]:
    w, x, y, z = from_matrix(rotation)
    return {
        "position": [round(float(value), DECIMALS) for value in position],
        "quaternion": [round(value, DECIMALS) for value in (x, y, z, w)],
    }
