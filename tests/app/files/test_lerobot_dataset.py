"""A plan as a LeRobot dataset, read back as the format's description says."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from app.files.folder_file import unpack
from app.files.lerobot_dataset import FPS, lerobot_folder
from planner.motion.motion_limits import MotionLimits
from planner.motion.motion_values import positions_at
from tests.small_plan import CARD, small_plan


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
):
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


def test_frames_come_at_the_rate_and_actions_are_the_next_states(frames: dict[str, np.ndarray]):
    np.testing.assert_allclose(frames["timestamp"], np.arange(len(frames["index"])) / FPS, rtol=1e-6)
    np.testing.assert_array_equal(frames["action"][:-1], frames["observation.state"][1:])
    np.testing.assert_array_equal(frames["frame_index"], frames["index"])


def test_states_are_those_of_the_motion_that_is_sent(info: dict[str, Any], frames: dict[str, np.ndarray]):
    limits = MotionLimits.of(CARD, small_plan().scene)
    assert tuple(info["features"]["observation.state"]["names"]) == limits.names
    plan = small_plan()
    assert plan.trajectory is not None
    assert frames["timestamp"][-1] == pytest.approx(small_plan().cost_s, abs=1.0 / FPS)
    wanted = positions_at(
        small_plan().trajectory, np.append(frames["timestamp"][:-1].astype(float), small_plan().cost_s)
    )
    np.testing.assert_allclose(frames["observation.state"], wanted, atol=1e-5)


def test_the_episode_and_its_task_are_told(folder: Path, info: dict[str, Any], frames: dict[str, np.ndarray]):
    (episode,) = pq.read_table(folder / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    count = len(frames["index"])
    assert (episode["dataset_from_index"], episode["dataset_to_index"], episode["length"]) == (0, count, count)
    tasks = pq.read_table(folder / "meta/tasks.parquet")
    assert tasks["task"].to_pylist() == episode["tasks"] == ["fold: Small towel folded like a letter"]
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]
    assert info["total_episodes"] == info["total_tasks"] == 1


def test_statistics_are_those_of_the_frames(folder: Path, frames: dict[str, np.ndarray]):
    stats = json.loads((folder / "meta/stats.json").read_text())
    assert set(stats) == set(frames)
    for name, values in frames.items():
        rows = values.reshape(len(values), -1)
        np.testing.assert_allclose(stats[name]["mean"], rows.mean(axis=0), atol=1e-6)
        np.testing.assert_allclose(stats[name]["max"], rows.max(axis=0), atol=1e-6)
        assert stats[name]["count"] == [len(values)]
