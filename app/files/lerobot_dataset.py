"""LeRobot datasets (format 3.0), for learning from demonstrations: of one plan, or of many episodes with pictures.

A frame's state is where arms, fingers and base are, its action where they are to be at the next frame, as a leader arm
would ask. The motion is the one that a controller is sent. Names and units are those of LeRobot for the arms that it
drives itself, and otherwise the robot's own (`app.files.lerobot_features`). Each episode is a file; pictures are JPEGs
in its rows, or a video beside it.
"""

import io
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from PIL import Image

from app.files.folder_file import zipped
from app.files.lerobot_features import Part, parts_of
from app.files.video import CODEC, PIXELS, mp4_video
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.motion_values import MotionLimits, positions_at
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan

FPS = 30
"""Frames a second."""

CAMERAS = "observation.images."
"""What the features of pictures begin with; a camera's name ends them."""

EPISODES = "meta/episodes/chunk-000/file-000.parquet"
"""The table of all episodes."""

_FORMAT = "v3.0"
_FILE = "chunk-{chunk_index:03d}/file-{file_index:03d}"
_DATA_PATH = f"data/{_FILE}.parquet"
_VIDEO_PATH = "videos/{video_key}/" + f"{_FILE}.mp4"
_FILES_A_CHUNK = 1000
_SIZE = "pictures/size_px/"
"""What the columns begin with that have the width and height of a camera's pictures."""
_QUANTILES = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}

Stats = Mapping[str, Any]
"""Statistics of a feature by their names, each a list with a number for each of its parts, or lists of them."""


@dataclass(frozen=True, slots=True, eq=False)
class Pictures:
    """The pictures that a camera took of an episode.

    Attributes:
        jpegs: one for each frame.
        size_px: their width and height.
        stats: the statistics of their colours, 0 to 1, shape (3, 1, 1) each.
    """

    jpegs: tuple[bytes, ...]
    size_px: tuple[int, int]
    stats: Stats


@dataclass(frozen=True, slots=True, eq=False)
class Episode:
    """A performed plan as frames.

    Attributes:
        task: what is done, in words.
        states: where the robot's parts are at each frame, shape (frames, parts).
        pictures: what was seen, by the names of cameras.
    """

    task: str
    states: FloatArray
    pictures: Mapping[str, Pictures] = field(default_factory=dict)

    @staticmethod
    def of(plan: Plan, card: RobotCard, pictures: Mapping[str, Pictures] | None = None) -> "Episode":
        """Return the episode of a plan; raises `UnsolvedPlanError`."""
        task = f"fold: {plan.garment.title or plan.garment.name}"
        return Episode(task, _states(plan, card, parts_of(card)), pictures or {})


def frame_times_s(plan: Plan) -> FloatArray:
    """Return when the frames of a plan's episode are (s); a plan without steps has one frame."""
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    return np.arange(math.ceil(plan.trajectory.duration_s * FPS - TIME_S) + 1) / FPS


def lerobot_folder(plan: Plan) -> bytes:
    """Return a solved plan as a zipped LeRobot dataset of one episode; raises `UnsolvedPlanError`."""
    card = load_robot(plan.task.robot).card
    episode = Episode.of(plan, card)
    row = episode_row(episode, 0, 0)
    return zipped({**episode_files(episode, 0, 0), **meta_files(card, [row])})


def _video(pictures: Pictures) -> bytes:
    """Return pictures as a video of which every second frame is whole: learning reads frames in any order."""
    opened = (Image.open(io.BytesIO(jpeg)) for jpeg in pictures.jpegs)
    return mp4_video(opened, pictures.size_px, FPS, whole_every=2)


def episode_files(episode: Episode, number: int, first: int, *, as_video: bool = False) -> dict[str, bytes]:
    """Return an episode's files by path: its frames, and its videos.

    Args:
        episode: the episode.
        number: its number in the dataset.
        first: how many frames the episodes before it have.
        as_video: whether its pictures are videos beside the frames, for which PyAV must be installed.
    """
    table = {name: _column(values) for name, values in _columns(episode, number, first).items()}
    files, place = dict[str, bytes](), _place(number)
    for name, pictures in episode.pictures.items():
        jpegs, feature = pictures.jpegs, CAMERAS + name
        if as_video:
            files[_VIDEO_PATH.format(video_key=feature, **place)] = _video(pictures)
            continue
        parts = [pa.array(jpegs, pa.binary()), pa.array([None] * len(jpegs), pa.string())]
        table[feature] = pa.StructArray.from_arrays(parts, ["bytes", "path"])
    return {_DATA_PATH.format(**place): _parquet(pa.table(table)), **files}


def _place(number: int) -> dict[str, int]:
    return {"chunk_index": number // _FILES_A_CHUNK, "file_index": number % _FILES_A_CHUNK}


def has_video(row: Mapping[str, Any]) -> bool:
    """Return whether an episode has videos, from its row."""
    return any(name.startswith("videos/") for name in row)


def episode_row(episode: Episode, number: int, first: int, *, as_video: bool = False) -> dict[str, Any]:
    """Return the row that says where an episode's frames are, with their statistics; see `episode_files`."""
    stats = {name: _stats(values) for name, values in _columns(episode, number, first).items()}
    ends = {"from_timestamp": 0.0, "to_timestamp": len(episode.states) / FPS}
    seen: dict[str, Any] = {}
    for name, pictures in episode.pictures.items():
        stats[CAMERAS + name] = dict(pictures.stats)
        seen[f"{_SIZE}{CAMERAS}{name}"] = list(pictures.size_px)
        if as_video:
            seen |= {f"videos/{CAMERAS}{name}/{key}": value for key, value in (_place(number) | ends).items()}
    return {
        "episode_index": number,
        "tasks": [episode.task],
        "length": len(episode.states),
        **{f"data/{name}": index for name, index in _place(number).items()},
        "dataset_from_index": first,
        "dataset_to_index": first + len(episode.states),
        "meta/episodes/chunk_index": 0,
        "meta/episodes/file_index": 0,
        **seen,
        **{f"stats/{name}/{kind}": row for name, rows in stats.items() for kind, row in rows.items()},
    }


def read_episode_rows(data: bytes) -> list[dict[str, Any]]:
    """Return the rows of a dataset's table of episodes."""
    rows: list[dict[str, Any]] = pq.read_table(io.BytesIO(data)).to_pylist()
    return rows


def meta_files(card: RobotCard, rows: Sequence[Mapping[str, Any]]) -> dict[str, bytes]:
    """Return what a dataset says of itself, by path, from the rows of all of its episodes, which have one task."""
    return {
        "meta/info.json": _json(_info(card, rows)),
        "meta/stats.json": _json(_joined_stats(rows)),
        "meta/tasks.parquet": _tasks(rows[0]["tasks"][0]),
        EPISODES: _parquet(pa.Table.from_pylist([dict(row) for row in rows])),
    }


def _columns(episode: Episode, number: int, first: int) -> dict[str, np.ndarray[Any, Any]]:
    states, numbers = episode.states, np.arange(len(episode.states))
    return {
        "observation.state": states.astype(np.float32),
        "action": np.vstack([states[1:], states[-1:]]).astype(np.float32),
        "timestamp": (numbers / FPS).astype(np.float32),
        "frame_index": numbers,
        "episode_index": np.full(len(states), number),
        "index": first + numbers,
        "task_index": np.zeros(len(states), np.int64),
    }


def _states(plan: Plan, card: RobotCard, parts: tuple[Part, ...]) -> FloatArray:
    """Return where the parts are at each frame, shape (frames, parts)."""
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    limits = MotionLimits.of(card, plan.scene)
    columns = [limits.names.index(part.source) for part in parts]
    values = positions_at(plan.trajectory, frame_times_s(plan))[:, columns] - [part.zero for part in parts]
    return np.asarray(values * [part.factor for part in parts])


def _info(card: RobotCard, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    parts = parts_of(card)
    count = int(rows[-1]["dataset_to_index"])
    columns = _columns(Episode("", np.zeros((1, len(parts)))), 0, 0)
    moving = {"names": [part.name for part in parts], "units": [part.unit for part in parts]}
    features: dict[str, Any] = {
        name: {
            "dtype": str(values.dtype),
            "shape": list(values.shape[1:]) or [1],
            **(moving if values.ndim > 1 else {"names": None}),
        }
        for name, values in columns.items()
    }
    for key in (key for key in rows[0] if key.startswith(_SIZE)):
        feature, (width, height) = key.removeprefix(_SIZE), rows[0][key]
        features[feature] = {"dtype": "image", "shape": [height, width, 3], "names": ["height", "width", "channels"]}
        if has_video(rows[0]):
            features[feature] |= {"dtype": "video", "info": _video_info(width, height)}
    return {
        "codebase_version": _FORMAT,
        "robot_type": card.name,
        "total_episodes": len(rows),
        "total_frames": count,
        "total_tasks": 1,
        "chunks_size": _FILES_A_CHUNK,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": FPS,
        "splits": {"train": f"0:{len(rows)}"},
        "data_path": _DATA_PATH,
        "video_path": _VIDEO_PATH if has_video(rows[0]) else None,
        "features": features,
    }


def _video_info(width_px: int, height_px: int) -> dict[str, Any]:
    features = {"height": height_px, "width": width_px, "channels": 3, "codec": CODEC, "pix_fmt": PIXELS, "fps": FPS}
    return {f"video.{name}": value for name, value in features.items()} | {
        "video.is_depth_map": False,
        "has_audio": False,
    }


def _stats(values: np.ndarray[Any, Any]) -> dict[str, Any]:
    """Return the statistics of a feature, each a list with a number for each of its parts."""
    rows = values.reshape(len(values), -1).astype(float)
    return {name: row.tolist() for name, row in _figures(rows, 0).items()} | {"count": [len(rows)]}


def picture_stats(colours: FloatArray, count: int) -> Stats:
    """Return the statistics of pictures from some of their colours, 0 to 1, shape (n, 3), and how many they are."""
    return {name: row.reshape(3, 1, 1).tolist() for name, row in _figures(colours, 0).items()} | {"count": [count]}


def _figures(rows: FloatArray, axis: int) -> dict[str, FloatArray]:
    statistics = {"min": rows.min(axis), "max": rows.max(axis), "mean": rows.mean(axis), "std": rows.std(axis)}
    return statistics | {name: np.quantile(rows, share, axis) for name, share in _QUANTILES.items()}


def _joined_stats(rows: Sequence[Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Return the statistics of all episodes; quantiles are the means of theirs, as LeRobot has it."""
    names = [key.split("/")[1] for key in rows[0] if key.startswith("stats/") and key.endswith("/count")]
    return {name: _joined([_stats_in(row, name) for row in rows]) for name in names}


def _stats_in(row: Mapping[str, Any], feature: str) -> dict[str, np.ndarray[Any, Any]]:
    start = f"stats/{feature}/"
    return {key.removeprefix(start): np.array(value) for key, value in row.items() if key.startswith(start)}


def _joined(parts: Sequence[Mapping[str, np.ndarray[Any, Any]]]) -> dict[str, Any]:
    weights = np.array([float(one["count"][0]) for one in parts])

    def mean(values: Sequence[np.ndarray[Any, Any]]) -> np.ndarray[Any, Any]:
        return np.asarray(np.average(np.array(values), axis=0, weights=weights))

    middle = mean([one["mean"] for one in parts])
    spread = np.sqrt(mean([one["std"] ** 2 + (one["mean"] - middle) ** 2 for one in parts]))
    joined = {
        "min": np.min([one["min"] for one in parts], axis=0),
        "max": np.max([one["max"] for one in parts], axis=0),
        "mean": middle,
        "std": spread,
        **{name: mean([one[name] for one in parts]) for name in _QUANTILES},
    }
    return {**{name: values.tolist() for name, values in joined.items()}, "count": [int(weights.sum())]}


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


def _json(content: dict[str, Any]) -> bytes:
    return (json.dumps(content, indent=1) + "\n").encode("ascii")
