"""A robot's motion as ROS 2 messages, read back by the readers of MCAP and of bags."""

import io
import json
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from app.files.folder_file import unpack
from app.files.ros_bag import TABLE_FRAME, mcap_file, ros_motion, rosbag2_folder
from tests.small_plan import CARD, one_armed, small_plan

JOINT_TOPICS = {
    **{f"/{arm.name}_arm_controller/joint_trajectory": arm.joint_names for arm in CARD.arms},
    **{f"/{arm.name}_gripper_controller/joint_trajectory": (arm.gripper.joint_name,) for arm in CARD.arms},
    "/lift_controller/joint_trajectory": (CARD.lift_joint,),
}


def seconds(time: Any) -> float:
    return float(time.sec + 1e-9 * time.nanosec)


@pytest.fixture(scope="module")
def mcap() -> bytes:
    return mcap_file(small_plan())


@pytest.fixture(scope="module")
def messages(mcap: bytes) -> dict[str, list[Any]]:
    read: dict[str, list[Any]] = {}
    decoding = make_reader(io.BytesIO(mcap), decoder_factories=[DecoderFactory()])
    for _, channel, _, message in decoding.iter_decoded_messages():
        read.setdefault(channel.topic, []).append(message)
    return read


@pytest.fixture(scope="module")
def about(mcap: bytes) -> dict[str, Any]:
    (metadata,) = make_reader(io.BytesIO(mcap)).iter_metadata()
    told: dict[str, Any] = json.loads(yaml.safe_load(metadata.metadata["serialized_metadata"])["custom_data"]["pleat"])
    return told


def test_there_is_a_message_for_each_step_and_controller(messages: dict[str, list[Any]]) -> None:
    assert set(messages) == {*JOINT_TOPICS, "/base_path"}
    assert all(len(read) == len(small_plan().steps) for read in messages.values())
    for topic, joints in JOINT_TOPICS.items():
        assert [tuple(message.joint_names) for message in messages[topic]] == [joints] * len(small_plan().steps)


def test_every_joint_trajectory_begins_at_once_and_the_bag_has_the_plans_clock(
    mcap: bytes, about: dict[str, Any]
) -> None:
    decoding = make_reader(io.BytesIO(mcap), decoder_factories=[DecoderFactory()])
    starts_s = [step["start_s"] for step in about["steps"]]
    logged_s: dict[str, list[float]] = {}
    for _, channel, logged, message in decoding.iter_decoded_messages():
        assert logged.log_time == logged.publish_time
        logged_s.setdefault(channel.topic, []).append(1e-9 * logged.log_time)
        if channel.topic in JOINT_TOPICS:
            assert (message.header.stamp.sec, message.header.stamp.nanosec) == (0, 0)
    assert len(starts_s) > 1
    for times_s in logged_s.values():
        assert times_s == pytest.approx(starts_s)


def test_times_grow_from_the_beginning_of_the_step(messages: dict[str, list[Any]], about: dict[str, Any]) -> None:
    for topic in JOINT_TOPICS:
        for message, step in zip(messages[topic], about["steps"], strict=True):
            times = np.array([seconds(point.time_from_start) for point in message.points])
            assert times[0] == 0.0 and np.all(np.diff(times) > 0.0)
            assert times[-1] == pytest.approx(step["duration_s"])


def test_the_arms_go_from_where_the_plan_begins_a_step_to_where_it_ends_it(messages: dict[str, list[Any]]) -> None:
    path = small_plan().trajectory
    assert path is not None
    for topic, joints in JOINT_TOPICS.items():
        for message, step in zip(messages[topic], small_plan().steps, strict=True):
            for point, t_s in ((message.points[0], step.start_s), (message.points[-1], step.end_s)):
                planned = path.joints_at(t_s)
                np.testing.assert_allclose(point.positions, [planned[str(name)] for name in joints], atol=1e-6)
                np.testing.assert_allclose(point.velocities, 0.0, atol=1e-9)


def test_velocities_lead_from_point_to_point_within_the_limits(
    messages: dict[str, list[Any]], about: dict[str, Any]
) -> None:
    for topic, joints in JOINT_TOPICS.items():
        if topic.startswith("/lift"):
            continue
        for message in messages[topic]:
            times = np.array([seconds(point.time_from_start) for point in message.points])
            positions, velocities, accelerations = (
                np.array([getattr(point, name) for point in message.points])
                for name in ("positions", "velocities", "accelerations")
            )
            gaps = np.diff(times)[:, None]
            led = positions[:-1] + gaps * (velocities[1:] + velocities[:-1]) / 2
            assert np.abs(led - positions[1:]).max() < 2e-3
            assert np.all(np.abs(velocities) <= [1.001 * about["speeds"][name] for name in joints])
            assert np.all(np.abs(accelerations) <= [1.02 * about["accelerations"][name] for name in joints])


def test_the_base_goes_from_stop_to_stop(messages: dict[str, list[Any]]) -> None:
    for message, step in zip(messages["/base_path"], small_plan().steps, strict=True):
        assert message.header.frame_id == TABLE_FRAME
        stamps = [seconds(pose.header.stamp) for pose in message.poses]
        assert np.all(np.diff(stamps) > 0.0) and stamps[0] == pytest.approx(seconds(message.header.stamp))
        for stamped, base in ((message.poses[0], step.before.base), (message.poses[-1], step.base)):
            at, turn = stamped.pose.position, stamped.pose.orientation
            assert (at.x, at.y, at.z) == pytest.approx((base.x_m, base.y_m, -small_plan().scene.table.height_m))
            assert 2.0 * np.arctan2(turn.z, turn.w) == pytest.approx(base.yaw_rad)
    assert min(stamped.pose.position.x for stamped in messages["/base_path"][0].poses) < -0.99, "it backs off"


def test_a_bag_has_the_same_messages_and_says_what_they_are(messages: dict[str, list[Any]], tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    unpack(rosbag2_folder(small_plan()), folder)
    types = get_typestore(Stores.ROS2_JAZZY)
    with Reader(folder) as bag:
        read = [
            (connection.topic, types.deserialize_cdr(data, connection.msgtype))
            for connection, _, data in bag.messages()
        ]
    metadata = yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    told = json.loads(metadata["custom_data"]["pleat"])
    assert told["duration_s"] == small_plan().cost_s
    assert [(one["start_s"], one["duration_s"]) for one in told["steps"]] == [
        (step.start_s, step.duration_s) for step in small_plan().steps
    ]
    assert len(read) == sum(len(one) for one in messages.values())
    name = f"/{CARD.arms[0].name}_arm_controller/joint_trajectory"
    for mine, same in zip([message for topic, message in read if topic == name], messages[name], strict=True):
        np.testing.assert_array_equal(mine.points[7].positions, same.points[7].positions)  # type: ignore[attr-defined]
    with sqlite3.connect(next(folder.glob("*.db3"))) as database:
        definitions = dict(database.execute("SELECT topic_type, encoded_message_definition FROM message_definitions"))
    assert "JointTrajectoryPoint[] points" in definitions["trajectory_msgs/msg/JointTrajectory"]


def test_a_robot_with_one_arm_and_a_fixed_base_has_its_two_controllers() -> None:
    plan, card = one_armed()
    topics = {message.topic for message in ros_motion(plan, card).messages}
    assert topics == {"/left_arm_controller/joint_trajectory", "/left_gripper_controller/joint_trajectory"}
