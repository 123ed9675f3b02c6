"""Simulated demonstrations as a LeRobot dataset."""

import io
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from PIL import Image
from typer.testing import CliRunner

from app.cli import cli
from app.cli import demonstrate as command
from app.demonstrations import demonstrate as demonstrations
from app.demonstrations.dataset import DemonstrationDataset
from app.demonstrations.demonstrate import demonstrate
from app.demonstrations.episode import PLACE_M, TURN_RAD, Variation, demonstration
from app.files import lerobot_dataset
from app.files.lerobot_dataset import CAMERAS, FPS, Episode, Pictures, picture_stats
from app.worker.stop import Stop, StoppedError
from app.worker.workers import Workers
from planner import Task
from planner.errors import RequestError
from planner.robots.load_robot import load_robot
from tests.app.rehearsal.towel import COARSE, COARSER, towel_plan
from tests.required import required

CAMERA = f"{CAMERAS}table"
FEW_PER_S = 2


def task() -> Task:
    return towel_plan().task


def test_seeds_vary_place_cloth_look_and_cameras_within_bounds() -> None:
    worlds = [Variation.of(task(), seed) for seed in range(40)]
    assert Variation.of(task(), 3) == worlds[3]
    assert list(Variation.of(task(), 3, has_wrists=False).cameras) == ["table"]
    lies = task().start.placement
    for world in worlds:
        placed = world.task.start.placement
        assert abs(placed.x_m - lies.x_m) <= PLACE_M and abs(placed.y_m - lies.y_m) <= PLACE_M
        assert abs(placed.yaw_rad - lies.yaw_rad) <= TURN_RAD
    varieties: Sequence[Sequence[object]] = [
        [world.task.start.placement for world in worlds],
        [world.fabric for world in worlds],
        [world.fabric.friction for world in worlds],
        [world.look for world in worlds],
        *([world.cameras[name] for world in worlds] for name in ("table", "left_wrist", "right_wrist")),
    ]
    for varied in varieties:
        assert len({repr(one) for one in varied}) == len(worlds)


@pytest.fixture(scope="module")
def found() -> Episode:
    """Return a demonstration with few pictures: a thousand of them take longer than the simulation."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lerobot_dataset, "FPS", FEW_PER_S)
        return required(demonstration(task(), 1, lambda: False, COARSE))


@pytest.mark.slow
@pytest.mark.parametrize("camera", ["table", "left_wrist", "right_wrist"])
def test_a_demonstration_has_a_picture_of_each_camera_and_a_state_for_each_frame(found: Episode, camera: str) -> None:
    pictures = found.pictures[camera]
    assert len(pictures.jpegs) == len(found.states) > 5 * FEW_PER_S
    first, last = (np.asarray(Image.open(io.BytesIO(pictures.jpegs[at])), float) for at in (0, -1))
    assert first.shape == (pictures.size_px[1], pictures.size_px[0], 3)
    assert np.abs(first - last).mean() > 2.0, "the towel is folded, and the robot has moved"
    assert np.abs(np.diff(found.states, axis=0)).max() * FEW_PER_S < 5.0, "no joint jumps"


def test_what_does_not_hold_is_no_demonstration() -> None:
    assert demonstration(task(), 1, lambda: False, COARSER) is None, "rows 5 cm apart do not fold on the line"
    with pytest.raises(StoppedError):
        demonstration(task(), 1, lambda: True, COARSE)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Make demonstrations at once, of odd seeds alone; return the seeds that were tried."""
    tried: list[int] = []
    card = load_robot("pr2").card

    def make(
        _self: object, work: Callable[..., Any], stop: Stop, _news: object, given: Task, seed: int, *_: object
    ) -> Any:
        tried.append(seed)
        if seed % 2 == 0:
            return None
        plain = Episode.of(towel_plan(), card)
        count = len(plain.states)
        buffer = io.BytesIO()
        Image.new("RGB", (32, 24), (seed, 0, 0)).save(buffer, "JPEG")
        stats = picture_stats(np.full((4, 3), seed / 255.0), count)
        pictures = Pictures((buffer.getvalue(),) * count, (32, 24), stats)
        return Episode(plain.task, plain.states + seed, {"table": pictures, "left_wrist": pictures})

    monkeypatch.setattr(Workers, "run", make)
    return tried


def opened(folder: Path, *, resume: bool = False, robot: str = "pr2", as_video: bool = False) -> DemonstrationDataset:
    card = load_robot("pr2").card
    return DemonstrationDataset.opened(folder, card, {"robot": robot}, 0, resume=resume, as_video=as_video)


def read(folder: Path, path: str) -> Any:
    return json.loads((folder / path).read_text())


def test_a_dataset_has_the_episodes_that_held_in_the_order_of_their_seeds(tmp_path: Path, made: list[int]) -> None:
    assert demonstrate(task(), opened(tmp_path / "set"), 3, 2, lambda _count, _tried: None)
    assert sorted(made)[:6] == [0, 1, 2, 3, 4, 5]
    info = read(tmp_path / "set", "meta/info.json")
    assert (info["total_episodes"], info["splits"]) == (3, {"train": "0:3"})
    told = {name: one["shape"] for name, one in info["features"].items() if one["dtype"] == "image"}
    assert told == {CAMERA: [24, 32, 3], f"{CAMERAS}left_wrist": [24, 32, 3]}
    rows = pq.read_table(tmp_path / "set" / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    frames = 0
    for number, row in enumerate(rows):
        place = info["data_path"].format(chunk_index=row["data/chunk_index"], file_index=row["data/file_index"])
        table = pq.read_table(tmp_path / "set" / place)
        assert table.num_rows == row["length"]
        assert table["index"].to_pylist() == list(range(frames, frames + row["length"]))
        assert set(table["episode_index"].to_pylist()) == {number} and row["episode_index"] == number
        picture = Image.open(io.BytesIO(table[CAMERA][0]["bytes"].as_py()))
        assert picture.size == (32, 24)
        assert np.asarray(picture)[0, 0, 0] == pytest.approx(2 * number + 1, abs=2)
        frames += row["length"]
    assert info["total_frames"] == frames == rows[-1]["dataset_to_index"]


def test_statistics_are_those_of_all_episodes(tmp_path: Path, made: list[int]) -> None:
    demonstrate(task(), opened(tmp_path / "set"), 3, 1, lambda _count, _tried: None)
    tables = [pq.read_table(path) for path in sorted((tmp_path / "set").glob("data/*/*.parquet"))]
    states = np.vstack([np.array(table["observation.state"].to_pylist()) for table in tables])
    stats = read(tmp_path / "set", "meta/stats.json")
    for name, wanted in (
        ("min", states.min(0)),
        ("max", states.max(0)),
        ("mean", states.mean(0)),
        ("std", states.std(0)),
    ):
        np.testing.assert_allclose(stats["observation.state"][name], wanted, atol=1e-4)
    assert stats["observation.state"]["count"] == [len(states)]
    assert np.shape(stats[CAMERA]["mean"]) == (3, 1, 1)


def test_a_run_that_was_stopped_goes_on_as_if_it_had_not_been(tmp_path: Path, made: list[int]) -> None:
    demonstrate(task(), opened(tmp_path / "whole"), 3, 1, lambda _count, _tried: None)

    def stop(count: int, _tried: int) -> None:
        if count == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        demonstrate(task(), opened(tmp_path / "parts"), 3, 1, stop)
    assert read(tmp_path / "parts", "meta/info.json")["total_episodes"] == 2
    assert demonstrate(task(), opened(tmp_path / "parts", resume=True), 3, 1, lambda _count, _tried: None)
    for path in (tmp_path / "whole").rglob("*.*"):
        if path.is_file():
            assert (tmp_path / "parts" / path.relative_to(tmp_path / "whole")).read_bytes() == path.read_bytes()


def test_with_pyav_the_pictures_of_an_episode_are_a_video(tmp_path: Path, made: list[int]) -> None:
    av = pytest.importorskip("av")
    demonstrate(task(), opened(tmp_path, as_video=True), 2, 1, lambda _count, _tried: None)
    info = read(tmp_path, "meta/info.json")
    feature = info["features"][CAMERA]
    assert (feature["dtype"], feature["shape"]) == ("video", [24, 32, 3])
    for number, row in enumerate(pq.read_table(tmp_path / "meta/episodes/chunk-000/file-000.parquet").to_pylist()):
        place = {name: row[f"videos/{CAMERA}/{name}"] for name in ("chunk_index", "file_index")}
        with av.open(str(tmp_path / info["video_path"].format(video_key=CAMERA, **place))) as video:
            stream = video.streams.video[0]
            told = {name: feature["info"][f"video.{name}"] for name in ("height", "width", "codec", "pix_fmt", "fps")}
            assert told == {
                "height": stream.height,
                "width": stream.width,
                "codec": stream.codec.canonical_name,
                "pix_fmt": stream.pix_fmt,
                "fps": stream.base_rate,
            }
            frames = list(video.decode(stream))
        assert [frame.time for frame in frames] == pytest.approx([n / FPS for n in range(row["length"])])
        assert row[f"videos/{CAMERA}/to_timestamp"] == pytest.approx(row["length"] / FPS)
        assert frames[-1].to_ndarray(format="rgb24").mean(axis=(0, 1)) == pytest.approx((2 * number + 1, 0, 0), abs=6)
        table = pq.read_table(tmp_path / info["data_path"].format(chunk_index=0, file_index=number))
        assert CAMERA not in table.column_names and table.num_rows == row["length"]
    assert len(list(tmp_path.glob(f"videos/{CAMERAS}left_wrist/*/*.mp4"))) == 2
    with pytest.raises(RequestError, match=r"has videos, which PyAV makes: .*pip install .*\[video\]"):
        opened(tmp_path, resume=True)
    assert not (opened(tmp_path / "images").as_video or opened(tmp_path / "images", resume=True).as_video)


@pytest.mark.parametrize("is_installed", (False, True))
def test_images_instead_of_videos_are_said_once(
    tmp_path: Path, made: list[int], monkeypatch: pytest.MonkeyPatch, is_installed: bool
) -> None:
    if is_installed:
        pytest.importorskip("av")
    monkeypatch.setattr(command, "is_installed", lambda _: is_installed)
    arguments = ["demonstrate", "letter-towel", "--episodes", "2", "--out", str(tmp_path), "--workers", "1"]
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 0 and result.stderr.count("PyAV") == (0 if is_installed else 1)
    kind = read(tmp_path, "meta/info.json")["features"][CAMERA]["dtype"]
    assert kind == ("video" if is_installed else "image")


def test_another_folder_and_other_demonstrations_are_left_alone(tmp_path: Path, made: list[int]) -> None:
    demonstrate(task(), opened(tmp_path / "set"), 1, 1, lambda _count, _tried: None)
    with pytest.raises(RequestError, match="is not empty; --resume"):
        opened(tmp_path / "set")
    with pytest.raises(RequestError, match="of another robot"):
        opened(tmp_path / "set", resume=True, robot="baxter")


def test_too_few_that_hold_are_status_3_and_enough_are_0(
    tmp_path: Path, made: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments = ["demonstrate", "letter-towel", "--episodes", "2", "--out", str(tmp_path / "set"), "--workers", "1"]
    monkeypatch.setattr(demonstrations, "TRIES_MAX", 1)
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 3 and "Only 1 of 2 held" in result.stderr
    assert CliRunner().invoke(cli, arguments).exit_code == 2
    result = CliRunner().invoke(cli, [*arguments, "--resume"])
    assert result.exit_code == 3, "the next seed is even"
    result = CliRunner().invoke(cli, [*arguments, "--resume"])
    assert result.exit_code == 0 and "2 episodes of 4 that were tried" in result.stdout
