"""Kinds of jobs for tests, and a desk that does them."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

from app.jobs.job_desk import JobDesk
from app.jobs.job_kind import AnyKind, JobKind, Progress, Stores, as_it_is
from app.jobs.job_pool import JobPool
from app.searches import Tried, suggest
from app.store.database import Database
from app.store.garment_repository import GarmentRepository
from app.store.job_repository import JobRepository, StoredJob
from app.store.plan_store import PlanStore
from app.store.robot_repository import RobotRepository
from app.store.study_store import StudyStore
from app.store.trace_store import TraceStore
from app.worker.process import Caller
from app.worker.workers import Workers
from planner.errors import RequestError
from planner.strict_model import StrictModel
from planner.task.plan import Plan
from planner.task.task import Task
from tests.patience import FOR_EVER_S, wait_until


class Number(StrictModel):
    """The body of the kinds here."""

    number: int


def _number(_: Stores, body: Number) -> int:
    if body.number < 0:
        raise RequestError("number", "is below zero")
    return body.number


def halve(number: int, progress: Progress) -> float:
    progress(0.5, f"halving {number}")
    return number / 2


def fail(number: int, _: Progress) -> None:
    raise RequestError("number", f"{number} does not please")


def crash(_: int, __: Progress) -> None:
    os._exit(7)


def wait_with_a_child(_: int, progress: Progress) -> None:
    """Start a process, tell its id, and wait for it for ever."""
    child = subprocess.Popen([sys.executable, "-c", f"import time; time.sleep({FOR_EVER_S})"])
    progress(0.25, str(child.pid))
    child.wait()


def not_json(_: int, __: Progress) -> float:
    return float("nan")


def suggest_with_own_robot(caller: Caller, task: Task, known: Plan | None) -> bool:
    """Look for suggestions as `app.searches.suggest` does, but with no other robot: to load one takes many seconds."""
    with patch("app.searches.robot_names", lambda: ()):
        return suggest(caller, task, known)


def suggest_and_hang(caller: Caller, _: Task, __: Plan | None) -> bool:
    """Look for suggestions as `app.searches.suggest` does, and never come to an end over the first change."""
    caller.tell(None)
    caller.tell(Tried({"kind": "robot", "says": {"code": "other_robot", "robot": "pr2", "title": "PR2"}}))
    time.sleep(FOR_EVER_S)
    return True


def kind(name: str, work: object, **traits: bool) -> AnyKind:
    return JobKind(name, "", Number, {"number": 1}, _number, work, as_it_is, **traits)  # type: ignore[arg-type]


KINDS: Mapping[str, AnyKind] = {
    one.name: one
    for one in (
        kind("halve", halve, may_begin_anew=True),
        kind("fail", fail),
        kind("crash", crash),
        kind("wait", wait_with_a_child),
        kind("look", wait_with_a_child, is_listed_cancelled=False),
        kind("not-json", not_json),
    )
}


@contextmanager
def desk(folder: Path, *, workers: int = 2, waiting_max: int | None = None) -> Iterator[JobDesk]:
    """Open a desk on the database of a folder, as a server does; at the end it stops as a server does."""
    pool, database = JobPool(workers, waiting_max), Database(folder / "pleat.db")
    studies, robots = StudyStore(folder / "studies", database), RobotRepository(folder / "robots", database)
    stores = Stores(GarmentRepository(database), PlanStore(database), studies, TraceStore(database), robots)
    try:
        yield JobDesk(KINDS, stores, JobRepository(database), pool, Workers())
    finally:
        pool.close()
        database.close()


def submitted(jobs: JobDesk, name: str, number: int = 1, client: str = "me") -> StoredJob:
    return jobs.submit(KINDS[name], {"number": number}, client)


def ended(jobs: JobDesk, job: StoredJob) -> StoredJob:
    """Wait for the end of a job and return it."""
    return _until(jobs, job, lambda now: not now.is_open)


def told(jobs: JobDesk, job: StoredJob) -> StoredJob:
    """Wait until a job has told its progress and return it."""
    return _until(jobs, job, lambda now: now.message != "")


def _until(jobs: JobDesk, job: StoredJob, holds: Callable[[StoredJob], bool]) -> StoredJob:
    wait_until(lambda: holds(jobs.job(job.id)))
    return jobs.job(job.id)
