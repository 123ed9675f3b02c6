"""Writes a plan's motion as a ROS 2 bag: one MCAP file, or the folder that `ros2 bag` makes, with SQLite inside.

The definitions of the messages are inside, so that Foxglove and other readers need no ROS. For each step there is one
message for each controller: arms, grippers and the lift get a `trajectory_msgs/JointTrajectory`, the message of
`joint_trajectory_controller`. A base that moves gets a `nav_msgs/Path`: Nav2 follows it, RViz and Foxglove draw it, and
its poses are stamped one by one, so that whoever wants a series of `PoseStamped` has it too.
"""

import json
import math
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from app.files.folder_file import zipped
from app.files.joint_motion import JointMotion, controller_name, controllers
from app.step_kinds import step_words
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.motion.motion_values import BASE_NAMES, MotionLimits
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Trajectory

_BAG_VERSION: Final = 8
"""The oldest form of a bag's metadata that the library writes: the more versions of ROS 2 read it."""

TABLE_FRAME = "table"
"""The frame of the base's path: the middle of the table's top, z up."""

_VERSION = 3
_TRAJECTORY, _PATH = "trajectory_msgs/msg/JointTrajectory", "nav_msgs/msg/Path"
_STATE = "sensor_msgs/msg/JointState"
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


@cache
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
    writer = _Writer(plan, plan.trajectory, card, JointMessages(message_types()))
    messages = tuple(message for step in plan.steps for message in writer.messages(step))
    return RosMotion(messages, _about(plan, card, MotionLimits.of(card, plan.scene)))


class _Writer:
    """Writes the messages of one plan."""

    def __init__(self, plan: Plan, path: Trajectory, card: RobotCard, messages: "JointMessages") -> None:
        self._plan, self._motion, self._card, self._messages = plan, path, card, messages

    def messages(self, step: PlanStep) -> Iterator[RosMessage]:
        """Yield the messages of a step."""
        motion = JointMotion.of(self._motion, step, self._card, self._plan.scene)
        stamp_ns = _ns(step.start_s)
        yield from self._messages.trajectories(motion, self._card, stamp_ns)
        if self._card.lift_joint is not None:
            still, none = np.full((2, 1), self._motion.torso_m), np.zeros((2, 1))
            resting = JointMotion((self._card.lift_joint,), motion.times_s[[0, -1]], still, none, none)
            yield self._messages.trajectory("lift", resting, stamp_ns)
        if not self._card.is_fixed:
            yield self._path(step, motion.times_s, motion.of_joints(BASE_NAMES).positions)

    def _path(self, step: PlanStep, times: FloatArray, poses: FloatArray) -> RosMessage:
        types = message_types().types
        floor_m = -self._plan.scene.table.height_m
        stamped = [
            types["geometry_msgs/msg/PoseStamped"](
                self._messages.header(_ns(step.start_s) + _ns(t), TABLE_FRAME),
                types["geometry_msgs/msg/Pose"](
                    types["geometry_msgs/msg/Point"](x, y, floor_m),
                    types["geometry_msgs/msg/Quaternion"](0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)),
                ),
            )
            for t, (x, y, yaw) in zip(times.tolist(), poses.tolist(), strict=True)
        ]
        message = types[_PATH](self._messages.header(_ns(step.start_s), TABLE_FRAME), stamped)
        return self._messages.written("/base_path", _PATH, _ns(step.start_s), message)


class JointMessages:
    """Writes what controllers are sent and what joints are read as ROS messages."""

    def __init__(self, types: Typestore) -> None:
        """Take the definitions of the messages."""
        self._types = types

    def trajectories(self, motion: JointMotion, card: RobotCard, stamp_ns: int) -> Iterator[RosMessage]:
        """Yield a message for the controller of each arm and of each gripper of which the motion has the joints."""
        for name, joints in controllers(card):
            if all(joint in motion.names for joint in joints):
                yield self.trajectory(name, motion.of_joints(joints), stamp_ns)

    def trajectory(self, name: str, motion: JointMotion, stamp_ns: int) -> RosMessage:
        """Return a message for the controller of all joints of a motion: positions, velocities and accelerations."""
        point = self._types.types["trajectory_msgs/msg/JointTrajectoryPoint"]
        duration = self._types.types["builtin_interfaces/msg/Duration"]
        orders = (motion.positions, motion.velocities, motion.accelerations)
        points = [
            point(*(np.ascontiguousarray(row) for row in rows), np.empty(0), duration(*divmod(_ns(t), _NS)))
            for t, *rows in zip(motion.times_s.tolist(), *orders, strict=True)
        ]
        message = self._types.types[_TRAJECTORY](self.header(_NOW, ""), list(motion.names), points)
        return self.written(f"/{controller_name(name)}/joint_trajectory", _TRAJECTORY, stamp_ns, message)

    def state(self, joints: Mapping[str, float], stamp_ns: int) -> RosMessage:
        """Return the message of joints as they were read."""
        found = np.array(list(joints.values()))
        message = self._types.types[_STATE](self.header(stamp_ns, ""), list(joints), found, np.empty(0), np.empty(0))
        return self.written("/joint_states", _STATE, stamp_ns, message)

    def written(self, topic: str, type_name: str, stamp_ns: int, message: Any) -> RosMessage:  # noqa: ANN401
        """Return a message in its CDR form."""
        return RosMessage(topic, type_name, stamp_ns, bytes(self._types.serialize_cdr(message, type_name)))

    def header(self, stamp_ns: int, frame: str) -> Any:  # noqa: ANN401
        """Return a header."""
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


def mcap_file(plan: Plan) -> bytes:
    """Return a solved plan's motion as an MCAP file; raises `UnsolvedPlanError`."""
    return mcap_of(_motion(plan))


def mcap_of(motion: RosMotion) -> bytes:
    """Return messages as an MCAP file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "motion"
        _write(motion, path, StoragePlugin.MCAP)
        return next(path.glob("*.mcap")).read_bytes()


def rosbag2_folder(plan: Plan) -> bytes:
    """Return a solved plan's motion as a zipped rosbag2 folder; raises `UnsolvedPlanError`."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "motion"
        _write(_motion(plan), path, StoragePlugin.SQLITE3)
        return zipped({file.name: file.read_bytes() for file in sorted(path.iterdir())})


def _motion(plan: Plan) -> RosMotion:
    return ros_motion(plan, load_robot(plan.task.robot).card)


def _write(motion: RosMotion, path: Path, storage: StoragePlugin) -> None:
    types = message_types()
    with Writer(path, version=_BAG_VERSION, storage_plugin=storage) as bag:
        bag.set_custom_data("pleat", json.dumps(motion.about))
        topics = {message.topic: message.type_name for message in motion.messages}
        connections = {topic: bag.add_connection(topic, kind, typestore=types) for topic, kind in topics.items()}
        for message in motion.messages:
            bag.write(connections[message.topic], message.stamp_ns, message.data)
