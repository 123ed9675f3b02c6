"""Writes a plan's motion as a LeRobot dataset of one episode (format 3.0), for learning from demonstrations.

A frame's state is where arms, fingers and base are, its action where they are to be at the next frame, as a leader arm
would ask. The motion is the one that a controller is sent. There are no cameras. Names and units are those of LeRobot
for the arms that it drives itself, and otherwise the robot's own (`app.files.lerobot_features`).
"""

import io
import json
import math
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from app.files.folder_file import zipped
from app.files.lerobot_features import Part, parts_of
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.motion_limits import MotionLimits
from planner.motion.motion_values import positions_at
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan

FPS = 30
"""Frames a second."""

_FORMAT = "v3.0"
_FILE = "chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
_FIRST = _FILE.format(chunk_index=0, file_index=0)
_QUANTILES = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}


def lerobot_folder(plan: Plan) -> bytes:
    """Return a solved plan as a zipped LeRobot dataset; raises `UnsolvedPlanError`."""
    card = load_robot(plan.task.robot).card
    parts = parts_of(card)
    states = _states(plan, card, parts)
    count = len(states)
    numbers = np.arange(count)
    columns: dict[str, np.ndarray[Any, Any]] = {
        "observation.state": states.astype(np.float32),
        "action": np.vstack([states[1:], states[-1:]]).astype(np.float32),
        "timestamp": (numbers / FPS).astype(np.float32),
        "frame_index": numbers,
        "episode_index": np.zeros(count, np.int64),
        "index": numbers,
        "task_index": np.zeros(count, np.int64),
    }
    task = f"fold: {plan.garment.title or plan.garment.name}"
    stats = {name: _stats(values) for name, values in columns.items()}
    return zipped(
        {
            "meta/info.json": _json(_info(card, parts, columns)),
            "meta/stats.json": _json(stats),
            "meta/tasks.parquet": _tasks(task),
            f"meta/episodes/{_FIRST}": _parquet(pa.Table.from_pylist([_episode(task, count, stats)])),
            f"data/{_FIRST}": _parquet(pa.table({name: _column(values) for name, values in columns.items()})),
        }
    )


def _states(plan: Plan, card: RobotCard, parts: tuple[Part, ...]) -> FloatArray:
    """Return where the parts are at each frame, shape (frames, parts); a plan without steps has one frame."""
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    limits = MotionLimits.of(card, plan.scene)
    frames_s = np.arange(math.ceil(plan.trajectory.duration_s * FPS - TIME_S) + 1) / FPS
    columns = [limits.names.index(part.source) for part in parts]
    values = positions_at(plan.trajectory, frames_s)[:, columns] - [part.zero for part in parts]
    return np.asarray(values * [part.factor for part in parts])


def _info(card: RobotCard, parts: tuple[Part, ...], columns: dict[str, np.ndarray[Any, Any]]) -> dict[str, Any]:
    count = len(columns["index"])
    moving = {"names": [part.name for part in parts], "units": [part.unit for part in parts]}
    return {
        "codebase_version": _FORMAT,
        "robot_type": card.name,
        "total_episodes": 1,
        "total_frames": count,
        "total_tasks": 1,
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": FPS,
        "splits": {"train": "0:1"},
        "data_path": f"data/{_FILE}",
        "video_path": None,
        "features": {
            name: {
                "dtype": str(values.dtype),
                "shape": list(values.shape[1:]) or [1],
                **(moving if values.ndim > 1 else {"names": None}),
            }
            for name, values in columns.items()
        },
    }


def _episode(task: str, count: int, stats: dict[str, dict[str, list[float]]]) -> dict[str, Any]:
    """Return the row of the only episode: where its frames are, and their statistics."""
    return {
        "episode_index": 0,
        "tasks": [task],
        "length": count,
        "data/chunk_index": 0,
        "data/file_index": 0,
        "dataset_from_index": 0,
        "dataset_to_index": count,
        "meta/episodes/chunk_index": 0,
        "meta/episodes/file_index": 0,
        **{f"stats/{name}/{kind}": row for name, told in stats.items() for kind, row in told.items()},
    }


def _stats(values: np.ndarray[Any, Any]) -> dict[str, list[float]]:
    """Return the statistics of a feature, each a list with a number for each of its parts."""
    rows = values.reshape(len(values), -1).astype(float)
    told = {"min": rows.min(axis=0), "max": rows.max(axis=0), "mean": rows.mean(axis=0), "std": rows.std(axis=0)}
    told |= {name: np.quantile(rows, share, axis=0) for name, share in _QUANTILES.items()}
    return {**{name: row.tolist() for name, row in told.items()}, "count": [len(rows)]}


def _tasks(task: str) -> bytes:
    """Return the table of tasks, in which a task's words are the index, as pandas writes it."""
    table = pa.table({"task_index": pa.array([0], pa.int64()), "task": pa.array([task])})
    columns = [
        {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": stored, "metadata": None}
        for name, kind, stored in (("task_index", "int64", "int64"), ("task", "unicode", "object"))
    ]
    index = {"index_columns": ["task"], "column_indexes": [], "columns": columns, "pandas_version": "2.0.0"}
    return _parquet(table.replace_schema_metadata({"pandas": json.dumps(index)}))


def _column(values: np.ndarray[Any, Any]) -> Any:  # noqa: ANN401
    if values.ndim == 1:
        return pa.array(values)
    return pa.FixedSizeListArray.from_arrays(pa.array(values.reshape(-1)), values.shape[1])


def _parquet(table: Any) -> bytes:  # noqa: ANN401
    written = io.BytesIO()
    pq.write_table(table, written)
    return written.getvalue()


def _json(told: dict[str, Any]) -> bytes:
    return (json.dumps(told, indent=1) + "\n").encode("ascii")
