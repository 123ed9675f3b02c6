"""The import of a robot as a job: its archive is checked and its arms are mapped, so that its first plan need not wait.

The archive lies in a folder beside the robots' own, which the job's end removes.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.jobs.job_kind import JobKind, Progress, Stores
from app.searches import read_archive
from planner.json_form import STRICT
from planner.robots.card_file import CardFile
from planner.robots.known_robots import robot_entry
from planner.robots.load_robot import prepare_robot
from planner.robots.own_robots import CARD

_READ_SHARE = 0.1
"""The share of the job that is done once the archive is read."""


@dataclass(frozen=True, slots=True)
class RobotImport:
    """An archive to import.

    Attributes:
        folder: the folder in which it lies, as `RobotRepository.new_folder` has made it.
    """

    __pydantic_config__ = STRICT

    folder: str


def _prepare(stores: Stores, wanted: RobotImport) -> Path:
    return stores.robots.place(wanted.folder)


def _work(folder: Path, progress: Progress) -> tuple[CardFile, Path]:
    """Return the robot's card, and the folder in which it lies unpacked."""
    progress(0.0, "reading")
    unpacked, card = read_archive(folder)
    progress(_READ_SHARE, "mapping the arms")
    prepare_robot(
        str(unpacked / CARD), lambda share: progress(_READ_SHARE + (1.0 - _READ_SHARE) * share, "mapping the arms")
    )
    return card, unpacked


def _finish(stores: Stores, answer: tuple[CardFile, Path]) -> dict[str, Any]:
    card, unpacked = answer
    is_new = stores.robots.take(card.name, unpacked)
    return {"robot": robot_entry(card), "is_new": is_new}


def _release(stores: Stores, folder: Path) -> None:
    stores.robots.discard(folder)


ROBOTS = JobKind(
    name="robots",
    does="Import a robot of one's own.",
    body=RobotImport,
    example={"folder": ".new-abc"},
    prepare=_prepare,
    work=_work,
    finish=_finish,
    release=_release,
)
