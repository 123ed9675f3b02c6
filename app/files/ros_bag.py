"""Writes a plan's motion as a ROS 2 bag: one MCAP file, or the folder that `ros2 bag` makes, with SQLite inside.

The definitions of the messages are inside, so that Foxglove and other readers need no ROS.
"""

import json
import tempfile
from pathlib import Path
from typing import Final

from rosbags.rosbag2 import StoragePlugin, Writer

from app.files.folder_file import zipped
from app.files.ros_messages import RosMotion, message_types, ros_motion
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan

_BAG_VERSION: Final = 8
"""The oldest form of a bag's metadata that the library writes: the more versions of ROS 2 read it."""


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
