"""A plan as a LeRobot dataset, read back as the format's description says."""

import json
import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from app.files.folder_file import unpack
from app.files.lerobot_dataset import FPS, lerobot_folder
from planner import Plan, make_plan
from planner.motion.motion_values import MotionLimits, positions_at
from planner.robots.load_robot import load_robot
from tests.builders import garment
from tests.required import required
from tests.small_plan import CARD, napkin_plan, small_plan


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("lerobot") / "dataset"
    unpack(lerobot_folder(small_plan()), path)
    return path


@pytest.fixture(scope="module")
def info(folder: Path) -> dict[str, Any]:
    told: dict[str, Any] = json.loads((folder / "meta/info.json").read_text())
    return told


@pytest.fixture(scope="module")
def frames(folder: Path, info: dict[str, Any]) -> dict[str, np.ndarray]:
    table = pq.read_table(folder / info["data_path"].format(chunk_index=0, file_index=0))
    return {name: np.array(table[name].to_pylist()) for name in table.column_names}


def test_every_feature_has_the_shape_and_the_type_that_it_is_told_with(
    folder: Path, info: dict[str, Any], frames: dict[str, np.ndarray]
) -> None:
    assert (info["codebase_version"], info["fps"], info["robot_type"]) == ("v3.0", FPS, "pr2")
    assert set(info["features"]) == set(frames)
    schema = pq.read_schema(folder / info["data_path"].format(chunk_index=0, file_index=0))
    for name, told in info["features"].items():
        assert list(frames[name].shape[1:] or (1,)) == told["shape"]
        assert len(frames[name]) == info["total_frames"]
        wanted = {"float32": "float", "int64": "int64"}[told["dtype"]]
        stored = schema.field(name).type
        assert str(stored.value_type if frames[name].ndim > 1 else stored) == wanted
    assert len(info["features"]["action"]["names"]) == info["features"]["action"]["shape"][0]


def test_frames_come_at_the_rate_and_actions_are_the_next_states(frames: dict[str, np.ndarray]) -> None:
    np.testing.assert_allclose(frames["timestamp"], np.arange(len(frames["index"])) / FPS, rtol=1e-6)
    np.testing.assert_array_equal(frames["action"][:-1], frames["observation.state"][1:])
    np.testing.assert_array_equal(frames["frame_index"], frames["index"])


def test_states_are_those_of_the_motion_that_is_sent(info: dict[str, Any], frames: dict[str, np.ndarray]) -> None:
    limits = MotionLimits.of(CARD, small_plan().scene)
    state = info["features"]["observation.state"]
    assert tuple(state["names"]) == limits.names
    assert state["units"] == ["rad"] * (len(limits.names) - 3) + ["m", "m", "rad"]
    plan = small_plan()
    assert plan.trajectory is not None
    assert frames["timestamp"][-1] == pytest.approx(plan.cost_s, abs=1.0 / FPS)
    times_s = np.append(frames["timestamp"][:-1].astype(float), required(plan.cost_s))
    wanted = positions_at(plan.trajectory, times_s)
    np.testing.assert_allclose(frames["observation.state"], wanted, atol=1e-5)


def test_the_episode_and_its_task_are_told(folder: Path, info: dict[str, Any], frames: dict[str, np.ndarray]) -> None:
    (episode,) = pq.read_table(folder / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    count = len(frames["index"])
    assert (episode["dataset_from_index"], episode["dataset_to_index"], episode["length"]) == (0, count, count)
    tasks = pq.read_table(folder / "meta/tasks.parquet")
    assert tasks["task"].to_pylist() == episode["tasks"] == ["fold: Small towel folded like a letter"]
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]
    assert info["total_episodes"] == info["total_tasks"] == 1


def test_statistics_are_those_of_the_frames(folder: Path, frames: dict[str, np.ndarray]) -> None:
    stats = json.loads((folder / "meta/stats.json").read_text())
    assert set(stats) == set(frames)
    for name, values in frames.items():
        rows = values.reshape(len(values), -1)
        np.testing.assert_allclose(stats[name]["mean"], rows.mean(axis=0), atol=1e-6)
        np.testing.assert_allclose(stats[name]["max"], rows.max(axis=0), atol=1e-6)
        assert stats[name]["count"] == [len(values)]


def written(plan: Plan, folder: Path) -> tuple[dict[str, Any], np.ndarray]:
    """Return what a dataset says of itself, and its actions."""
    unpack(lerobot_folder(plan), folder)
    table = pq.read_table(folder / "data/chunk-000/file-000.parquet")
    return json.loads((folder / "meta/info.json").read_text()), np.array(table["action"].to_pylist())


def test_so_101_arms_have_the_names_and_units_of_lerobots_own_driver(tmp_path: Path) -> None:
    info, actions = written(napkin_plan(), tmp_path / "dataset")
    joints = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper")
    feature = info["features"]["action"]
    assert feature["names"] == [f"{arm}_{joint}.pos" for arm in ("left", "right") for joint in joints]
    assert feature["units"] == [*["deg"] * 5, "0..100"] * 2
    assert info["robot_type"] == "so101-pair"
    path = napkin_plan().trajectory
    assert path is not None
    count = len(actions)
    for column, joint in enumerate(path.arms.names):
        name = f"{joint}.pos"
        wanted = [math.degrees(path.arms.at(min((n + 1) / FPS, path.duration_s))[column]) for n in range(count)]
        np.testing.assert_allclose(actions[:, feature["names"].index(name)], wanted, atol=1e-3)
    for track, arm in zip(path.grippers, load_robot("so101-pair").card.arms, strict=True):
        shares = actions[:, feature["names"].index(f"{track.joint}.pos")]
        opened = [track.opening_at(min((n + 1) / FPS, path.duration_s)) for n in range(count)]
        np.testing.assert_allclose(shares, 100.0 * np.array(opened) / arm.gripper.opening_max_m, atol=0.5)
        assert shares.min() >= -1e-3 and shares.max() <= 100.0 + 1e-3


def test_the_type_of_a_robot_is_the_name_on_its_card_wherever_the_card_lies(tmp_path: Path) -> None:
    card = Path(load_robot.__code__.co_filename).parent / "cards" / "so101-pair.json"
    shutil.copy(card, tmp_path / "bench.json")
    napkin = garment([(0.0, 0.0), (0.2, 0.0), (0.2, 0.16), (0.0, 0.16)])
    plan = make_plan(napkin, robot=str(tmp_path / "bench.json"), time_limit_s=60.0)
    info, _ = written(plan, tmp_path / "dataset")
    assert info["robot_type"] == "so101-pair"
