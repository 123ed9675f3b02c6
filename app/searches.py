"""The functions that run in workers; their arguments and results are picklable."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.files.import_file import import_file
from app.files.robot_archive import has_card, unpack_robot
from app.files.robot_draft import drafted_alone
from app.files.sketch_garment import Imported
from app.jobs.job_kind import Progress
from app.robot_warnings import warnings_of
from app.store.packed_plan import PackedPlan
from app.store.storage_error import storing
from app.worker.bounded import bounded, one_at_a_time
from app.worker.process import Caller
from planner import make_plan
from planner.deadline import ShouldStop
from planner.errors import RobotError
from planner.explain.suggestion_map import PlacementMap, placement_map
from planner.explain.suggestions import suggestions
from planner.planning.plan_check import require_replay
from planner.robots.card_file import CardFile
from planner.robots.collision.described_parts import described_parts
from planner.robots.collision.link_shapes import require_shown
from planner.robots.described_robot import DescribedRobot
from planner.robots.described_robot import read_robot as read_known
from planner.robots.drafting.draft import Draft
from planner.robots.known_robots import read_card, robot_names
from planner.robots.own_robots import CARD
from planner.task.plan import Plan
from planner.task.task import Task


@dataclass(frozen=True, slots=True)
class Suggested:
    """A suggestion as JSON, and the plan that proves it."""

    body: dict[str, Any]
    plan: Plan


@dataclass(frozen=True, slots=True)
class Tried:
    """A change that is being planned, as JSON."""

    body: dict[str, Any]


_LAST_SHARE = 0.99
"""The share of a search for suggestions that is reported at most before its end."""


def plan(caller: Caller, task: Task) -> PackedPlan:
    """Plan a task, as `make_plan` does, and pack the plan here, so that the server has no work with it."""
    return PackedPlan.of(make_plan(task, should_stop=caller.should_stop))


def read_plan(_: Caller, data: dict[str, Any]) -> Plan:
    """Read a plan file and replay the plan; raise the first error, naming the step."""
    plan = Plan.from_dict(data)
    require_replay(plan)
    return plan


def suggest(caller: Caller, task: Task, known: Plan | None) -> bool:
    """Send None once the request is valid, then each trial and suggestion; return whether all were tried to the end."""
    return _suggest(task, known, caller.tell, caller.should_stop)


def _suggest(
    task: Task,
    known: Plan | None,
    tell: Callable[[Suggested | Tried | None], None],
    should_stop: ShouldStop | None = None,
) -> bool:
    found = suggestions(
        task,
        should_stop=should_stop,
        plan=known,
        on_trial=lambda trial: tell(Tried({"kind": trial.kind, "says": trial.says.to_dict()})),
        other_robots=robot_names(),
    )
    tell(None)
    while True:
        try:
            suggestion = next(found)
        except StopIteration as end:
            return bool(end.value)
        tell(Suggested(suggestion.to_dict(), suggestion.plan))


def all_suggestions(asked: tuple[Task, Plan | None], progress: Progress) -> tuple[list[Suggested], bool]:
    """Return all suggestions, and whether everything was tried; the work of a job.

    The progress is the share of the time limit that has passed: how many changes there are is not known before.
    """
    task, known = asked
    found: list[Suggested] = []
    began_s = time.monotonic()

    def hear(news: Suggested | Tried | None) -> None:
        if isinstance(news, Suggested):
            found.append(news)
        share = (time.monotonic() - began_s) / task.limits.time_limit_s
        progress(min(share, _LAST_SHARE), f"{len(found)} found")

    return found, _suggest(task, known, hear)


def whole_map(asked: tuple[Task, float], progress: Progress) -> dict[str, Any]:
    """Return a map of placements as JSON; the work of a job."""
    task, step_m = asked

    def on_place(known: int, of: int) -> None:
        progress(known / of, f"{known} of {of} places")

    return placement_map(task, step_m=step_m, on_place=on_place).to_dict()


def map_places(caller: Caller, task: Task, step_m: float) -> PlacementMap:
    """Plan for every placement of the garment, as `placement_map` does."""
    return placement_map(task, step_m=step_m, should_stop=caller.should_stop)


def read_file(_: Caller, filename: str, data: bytes, how: Mapping[str, Any]) -> Imported:
    """Read a garment from a file, as `import_file` does with some of its arguments."""
    return import_file(filename, data, **how)


READING_BYTES_MAX, READING_CPU_S = 3 << 29, 120
"""Memory (bytes) and processor time (s) in which the meshes of a robot must be read."""

READING_LIMITS = f"its meshes may take {READING_BYTES_MAX / (1 << 30):g} GiB and {READING_CPU_S} s to be read"

_ARRIVED, _UNPACKED = "archive.zip", "robot"
"""Names in the folder for an archive: the archive itself, and the folder into which it is unpacked."""


def put_archive(data: bytes, folder: Path) -> None:
    """Put an archive into a folder, for `read_archive`."""
    with storing("the robot could not be saved"):
        (folder / _ARRIVED).write_bytes(data)


def read_archive(folder: Path) -> tuple[Path, CardFile]:
    """Return the folder into which an archive is unpacked, and the robot's card; as `read_robot` does."""
    unpacked = folder / _UNPACKED
    with storing("the robot could not be unpacked"):
        unpacked.mkdir()
        data = (folder / _ARRIVED).read_bytes()
    return unpacked, _read_robot(unpacked, data)


@dataclass(frozen=True, slots=True)
class Described:
    """A file that describes a robot, with or without a card."""

    filename: str
    data: bytes


def robot_warnings(_: Caller, name: str) -> list[dict[str, Any]]:
    """Return the warnings about the card of a robot that is known by its name."""
    return warnings_of(read_known(name))


def read_robot(_: Caller, folder: Path, given: bytes | Described | CardFile) -> tuple[CardFile, Draft | None]:
    """Return a robot's card once all that it names is there, as `_read_robot` does, and what was drafted for it.

    It is the card of an archive, or else one drafted of a file.
    """
    if not isinstance(given, Described):
        return _read_robot(folder, given), None
    if has_card(given.data):
        return _read_robot(folder, given.data), None
    with storing("the robot could not be saved"), bounded(READING_BYTES_MAX, READING_CPU_S):
        draft = drafted_alone(given.filename, given.data, folder)
    return _read_robot(folder, draft.card), draft


def _read_robot(folder: Path, given: bytes | CardFile) -> CardFile:
    """Return a robot's card once all that it names is there: that of an archive, unpacked into a folder, or a card.

    Robots are read one at a time. A process that takes more than `READING_CPU_S` is ended by the system.
    """
    if isinstance(given, CardFile):
        card = given
    else:
        with storing("the robot could not be unpacked"):
            unpack_robot(given, folder)
        card = read_card(folder / CARD)
    robot = DescribedRobot.of(card, folder)
    with storing("the robots' folder could not be made"):
        folder.parent.mkdir(parents=True, exist_ok=True)
    try:
        with one_at_a_time(folder.parent), bounded(READING_BYTES_MAX, READING_CPU_S):
            require_shown(robot.urdf)
            described_parts(robot)  # kept for the first plan
    except MemoryError:
        raise RobotError("urdf", f"cannot be read: {READING_LIMITS}") from None
    return card
