"""A plan's motion as ROS 2 messages: for each step, one for each controller.

Arms, grippers and the lift get a `trajectory_msgs/JointTrajectory`, the message of `joint_trajectory_controller`. A
base that moves gets a `nav_msgs/Path`: Nav2 follows it, RViz and Foxglove draw it, and its poses are stamped one by
one, so that whoever wants a series of `PoseStamped` has it too.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from app.step_kinds import step_words
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.motion_limits import BASE_NAMES, MotionLimits
from planner.motion.motion_values import accelerations_at, positions_at, velocities_at
from planner.robots.card import RobotCard
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep
from planner.task.trajectory import Trajectory

RATE_HZ = 50.0
"""Points a second of each message."""

TABLE_FRAME = "table"
"""The frame of the base's path: the middle of the table's top, z up."""

_VERSION = 3
_TRAJECTORY, _PATH = "trajectory_msgs/msg/JointTrajectory", "nav_msgs/msg/Path"
_NS = 1_000_000_000

_NOW = 0
"""The stamp of every joint trajectory (ns): to begin at once. A controller rejects a trajectory whose end is past."""


@dataclass(frozen=True, slots=True)
class RosMessage:
    """A message on its way into a bag.

    Attributes:
        topic: its topic.
        type_name: its type.
        stamp_ns: when it is sent on the plan's clock, which is the bag's: the start of its step (ns).
        data: its CDR form.
    """

    topic: str
    type_name: str
    stamp_ns: int
    data: bytes


@dataclass(frozen=True, slots=True)
class RosMotion:
    """A plan's motion.

    Attributes:
        messages: the messages, step by step.
        about: what they are, as JSON: the limits, and when each step of the plan begins.
    """

    messages: tuple[RosMessage, ...]
    about: dict[str, Any]


def message_types() -> Typestore:
    """Return the definitions of all messages that are used."""
    return get_typestore(Stores.ROS2_HUMBLE)


def ros_motion(plan: Plan, card: RobotCard) -> RosMotion:
    """Return a plan's motion for a robot.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    limits = MotionLimits.of(card, plan.scene)
    writer = _Writer(plan, plan.trajectory, card, limits, message_types())
    messages = tuple(message for step in plan.steps for message in writer.messages(step))
    return RosMotion(messages, _about(plan, card, limits))


class _Writer:
    """Writes the messages of one plan."""

    def __init__(self, plan: Plan, path: Trajectory, card: RobotCard, limits: MotionLimits, types: Typestore) -> None:
        self._plan, self._motion, self._card, self._limits, self._types = plan, path, card, limits, types

    def messages(self, step: PlanStep) -> Iterator[RosMessage]:
        """Yield the messages of a step."""
        times = np.linspace(0.0, step.duration_s, max(math.ceil(step.duration_s * RATE_HZ - TIME_S), 1) + 1)
        path, at = self._motion, step.start_s + times
        orders = [positions_at(path, at), velocities_at(path, at), accelerations_at(path, at, step.end_s)]
        for arm in self._card.arms:
            for part, joints in (("arm", arm.joint_names), ("gripper", (arm.gripper.joint_name,))):
                yield self._trajectory(f"{arm.name}_{part}", step, times, joints, self._columns(orders, joints))
        if self._card.lift_joint is not None:
            still = np.full((2, 1), path.torso_m)
            resting = [still, np.zeros((2, 1)), np.zeros((2, 1))]
            yield self._trajectory("lift", step, times[[0, -1]], (self._card.lift_joint,), resting)
        if not self._card.is_fixed:
            yield self._path(step, times, self._columns(orders, BASE_NAMES)[0])

    def _columns(self, orders: list[FloatArray], names: tuple[str, ...]) -> list[FloatArray]:
        which = [self._limits.names.index(name) for name in names]
        return [values[:, which] for values in orders]

    def _trajectory(
        self, name: str, step: PlanStep, times: FloatArray, joints: tuple[str, ...], orders: list[FloatArray]
    ) -> RosMessage:
        """Return a message for the controller of some joints: their positions, velocities and accelerations."""
        point = self._types.types["trajectory_msgs/msg/JointTrajectoryPoint"]
        duration = self._types.types["builtin_interfaces/msg/Duration"]
        points = [
            point(*(np.ascontiguousarray(row) for row in rows), np.empty(0), duration(*divmod(_ns(t), _NS)))
            for t, *rows in zip(times.tolist(), *orders, strict=True)
        ]
        topic = f"/{_ros_name(name)}_controller/joint_trajectory"
        message = self._types.types[_TRAJECTORY](self._header(_NOW, ""), list(joints), points)
        return self._message(topic, _TRAJECTORY, step, message)

    def _path(self, step: PlanStep, times: FloatArray, poses: FloatArray) -> RosMessage:
        types = self._types.types
        floor_m = -self._plan.scene.table.height_m
        stamped = [
            types["geometry_msgs/msg/PoseStamped"](
                self._header(_ns(step.start_s) + _ns(t), TABLE_FRAME),
                types["geometry_msgs/msg/Pose"](
                    types["geometry_msgs/msg/Point"](x, y, floor_m),
                    types["geometry_msgs/msg/Quaternion"](0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)),
                ),
            )
            for t, (x, y, yaw) in zip(times.tolist(), poses.tolist(), strict=True)
        ]
        message = types[_PATH](self._header(_ns(step.start_s), TABLE_FRAME), stamped)
        return self._message("/base_path", _PATH, step, message)

    def _message(self, topic: str, type_name: str, step: PlanStep, message: Any) -> RosMessage:  # noqa: ANN401
        data = bytes(self._types.serialize_cdr(message, type_name))
        return RosMessage(topic, type_name, _ns(step.start_s), data)

    def _header(self, stamp_ns: int, frame: str) -> Any:  # noqa: ANN401
        time = self._types.types["builtin_interfaces/msg/Time"](*divmod(stamp_ns, _NS))
        return self._types.types["std_msgs/msg/Header"](time, frame)


def _about(plan: Plan, card: RobotCard, limits: MotionLimits) -> dict[str, Any]:
    """Return what a reader must know besides the messages."""
    return {
        "version": _VERSION,
        "garment": plan.garment.name,
        "robot": card.name,
        "clock": "the bag's is the plan's: each step goes from rest to rest, with bounded speeds and accelerations",
        "duration_s": plan.cost_s,
        "speeds": dict(zip(limits.names, limits.speeds.tolist(), strict=True)),
        "accelerations": dict(zip(limits.names, limits.accelerations.tolist(), strict=True)),
        "steps": [
            {
                "step": number,
                "kind": step.kind,
                "what": step_words(step, plan.garment),
                "start_s": step.start_s,
                "duration_s": step.duration_s,
            }
            for number, step in enumerate(plan.steps)
        ],
    }


def _ns(time_s: float) -> int:
    return round(time_s * _NS)


def _ros_name(name: str) -> str:
    """Return a name that ROS allows in a topic."""
    allowed = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
    return allowed if allowed[:1].isalpha() else f"arm_{allowed}"
