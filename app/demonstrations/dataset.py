"""A LeRobot dataset that grows by an episode at a time, whole after each, and knows where to go on."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from app.distribution import installing
from app.files.lerobot_dataset import (
    EPISODES,
    Episode,
    episode_files,
    episode_row,
    has_video,
    meta_files,
    read_episode_rows,
)
from planner.errors import RequestError
from planner.robots.card import RobotCard

_STATE = "demonstrations.json"


@dataclass
class DemonstrationDataset:
    """A dataset in a folder.

    Attributes:
        folder: the folder.
        card: the robot.
        asked: what the demonstrations are of, as JSON: another run must ask for the same to go on.
        next_seed: the first seed that has not been tried.
        as_video: whether pictures are videos.
    """

    folder: Path
    card: RobotCard
    asked: dict[str, Any]
    next_seed: int
    as_video: bool
    _rows: list[dict[str, Any]] = field(default_factory=list)

    @staticmethod
    def opened(
        folder: Path, card: RobotCard, asked: dict[str, Any], seed: int, *, resume: bool, as_video: bool
    ) -> "DemonstrationDataset":
        """Begin a dataset in a new or empty folder, or go on with one, as it began.

        Args:
            folder: the folder.
            card: the robot.
            asked: what the demonstrations are of.
            seed: the first seed.
            resume: whether to go on with what is there.
            as_video: whether pictures can be made videos.

        Raises:
            RequestError: the folder has something else in it, other demonstrations, or videos that cannot be made here.
            OSError: the system refuses to read or write.
        """
        state = folder / _STATE
        if not (resume and state.is_file()):
            if folder.exists() and any(folder.iterdir()):
                raise RequestError("out", f"{folder} is not empty; --resume goes on with demonstrations in it")
            folder.mkdir(parents=True, exist_ok=True)
            dataset = DemonstrationDataset(folder, card, asked, seed, as_video)
            dataset._note()
            return dataset
        kept = json.loads(state.read_text(encoding="utf-8"))
        if kept["asked"] != asked:
            differs = sorted(name for name in asked if kept["asked"].get(name) != asked[name])
            raise RequestError("out", f"{folder} has demonstrations of another {', '.join(differs)}")
        table = folder / EPISODES
        rows = read_episode_rows(table.read_bytes()) if table.is_file() else []
        began_as_video = has_video(rows[0]) if rows else as_video
        if began_as_video and not as_video:
            raise RequestError("out", f"{folder} has videos, which PyAV makes: {installing('video')}")
        return DemonstrationDataset(folder, card, asked, int(kept["next_seed"]), began_as_video, rows)

    @property
    def count(self) -> int:
        """How many episodes it has."""
        return len(self._rows)

    def tried(self, episode: Episode | None) -> None:
        """Note that the next seed was tried, and keep its episode, if it has one."""
        if episode is not None:
            first = int(self._rows[-1]["dataset_to_index"]) if self._rows else 0
            row = episode_row(episode, self.count, first, as_video=self.as_video)
            files = episode_files(episode, self.count, first, as_video=self.as_video)
            for path, data in (files | meta_files(self.card, [*self._rows, row])).items():
                self._write(path, data)
            self._rows.append(row)
        self.next_seed += 1
        self._note()

    def _note(self) -> None:
        kept = {"asked": self.asked, "next_seed": self.next_seed}
        self._write(_STATE, (json.dumps(kept, indent=1) + "\n").encode("ascii"))

    def _write(self, path: str, data: bytes) -> None:
        """Write a file as a whole or not at all."""
        target = self.folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_name(f".{target.name}.part")
        part.write_bytes(data)
        part.replace(target)
