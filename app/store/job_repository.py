"""Jobs in the database: each with its request, its progress and its result."""

import json
import math
import time
import uuid
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Literal, TypeAlias

from sqlalchemy import Row, and_, delete, func, not_, select, update

from app.store.database import Database
from app.store.engines import has_ended
from app.store.schema import JobRow
from app.store.storage_error import StorageError
from planner.errors import FoldingError

JobStatus: TypeAlias = Literal["queued", "running", "done", "failed", "cancelled"]

OPEN: tuple[JobStatus, ...] = ("queued", "running")

KEPT_MAX = 1000
"""Number of jobs kept; beyond it the oldest ended ones are dropped."""


@dataclass
class UnknownJobError(FoldingError):
    """No job has this id, or it has been dropped."""

    job_id: str

    def __str__(self) -> str:
        return f"there is no job with the id {self.job_id[:80]!r}"


@dataclass(frozen=True, slots=True)
class StoredJob:
    """A job without its body and its result.

    Attributes:
        id: its id.
        kind: the name of its kind.
        client: who asked for it.
        about: the title of the garment or study that it is about; empty where it is about none.
        status: whether it waits, runs, or how it ended.
        progress: the share that is done, 0..1.
        message: what is being done, or why it failed.
        created_s: when it was asked for (s since the epoch).
        started_s: when it began; None if it has not.
        ended_s: when it ended; None if it has not.
        begun: how often it was begun.
        revision: grows with each change.
    """

    id: str
    kind: str
    client: str
    about: str
    status: JobStatus
    progress: float
    message: str
    created_s: float
    started_s: float | None
    ended_s: float | None
    begun: int
    revision: int

    @property
    def is_open(self) -> bool:
        """Whether it has not ended."""
        return self.status in OPEN


_COLUMNS = [getattr(JobRow, field.name) for field in fields(StoredJob)]

_UNREADABLE = {"progress": 0.0, "created_s": 0.0, "started_s": None, "ended_s": None, "begun": 0, "revision": 0}
"""What the numbers of a job are read as where its row has something else."""


def _job(row: Row[Any]) -> StoredJob:
    """Return the job in a row."""
    values = dict(row._mapping)
    for name, instead in _UNREADABLE.items():
        if not isinstance(values[name], int | float) or not math.isfinite(values[name]):
            values[name] = instead
    return StoredJob(**values)


class JobRepository:
    """The jobs of a database; safe to use from any thread."""

    def __init__(self, database: Database) -> None:
        """Use a database; read nothing yet."""
        self._database = database

    def add(self, kind: str, client: str, about: str, body: object) -> StoredJob:
        """Return a new job, queued; drop the oldest ended ones beyond `KEPT_MAX`."""
        job = StoredJob(uuid.uuid4().hex, kind, client, about, "queued", 0.0, "", time.time(), None, None, 0, 0)
        with self._database.writing("the job could not be saved", is_lasting=False) as session:
            row = JobRow(**_values(job), server=self._database.number, body=json.dumps(body), result=None)
            session.add(row)
            oldest_kept = select(JobRow.number).order_by(JobRow.number.desc()).offset(KEPT_MAX).limit(1)
            number = session.scalar(oldest_kept)
            if number is not None:
                session.execute(delete(JobRow).where(JobRow.number <= number, JobRow.status.not_in(OPEN)))
        return job

    def keep(self, job: StoredJob) -> None:
        """Save how far a job is."""
        self._update(job, {})

    def keep_result(self, job: StoredJob, result: object) -> None:
        """Save the end of a job together with its result."""
        self._update(job, {"result": json.dumps(result, allow_nan=False)})

    def job(self, job_id: str) -> StoredJob:
        """Return a job; raise `UnknownJobError` if there is none."""
        with self._database.reading("the job could not be read") as session:
            row = session.execute(select(*_COLUMNS).where(JobRow.id == job_id)).one_or_none()
        if row is None:
            raise UnknownJobError(job_id)
        return _job(row)

    def body(self, job_id: str) -> Any:  # noqa: ANN401
        """Return the body that a job was asked with."""
        with self._database.reading("the job could not be read") as session:
            return _json(session.scalars(select(JobRow.body).where(JobRow.id == job_id)).one())

    def result(self, job_id: str) -> Any:  # noqa: ANN401
        """Return a job's result; None if it has none."""
        with self._database.reading("the job could not be read") as session:
            text = session.scalar(select(JobRow.result).where(JobRow.id == job_id))
        return None if text is None else _json(text)

    def newest(self, most: int, before: str | None = None, without_cancelled: Sequence[str] = ()) -> list[StoredJob]:
        """Return the newest jobs, or the newest of those older than the job `before`.

        Args:
            most: the most jobs.
            before: the id of a job; None for all.
            without_cancelled: the names of the kinds whose cancelled jobs are left out.
        """
        is_left_out = and_(JobRow.status == "cancelled", JobRow.kind.in_(without_cancelled))
        wanted = select(*_COLUMNS).where(not_(is_left_out)).order_by(JobRow.number.desc()).limit(most)
        with self._database.reading("the jobs could not be read") as session:
            if before is not None:
                number = session.scalar(select(JobRow.number).where(JobRow.id == before))
                if number is None:
                    raise UnknownJobError(before)
                wanted = wanted.where(JobRow.number < number)
            return [_job(row) for row in session.execute(wanted)]

    def interrupted(self) -> list[StoredJob]:
        """Return the jobs that the end of a server interrupted, oldest first; they are this server's from now on."""
        is_open, own = JobRow.status.in_(OPEN), self._database.number
        with self._database.writing("the jobs could not be read", is_lasting=False) as session:
            others = session.scalars(select(JobRow.server).where(is_open).distinct()).all()
            ended = [number for number in others if has_ended(session, number)]
            is_interrupted = is_open, JobRow.server.in_(ended)
            found = session.execute(select(*_COLUMNS).where(*is_interrupted).order_by(JobRow.number)).all()
            session.execute(update(JobRow).where(*is_interrupted).values(server=own))
        return [_job(row) for row in found]

    def open_count(self, client: str) -> int:
        """Return how many of a client's jobs have not ended."""
        wanted = select(func.count()).where(JobRow.client == client, JobRow.status.in_(OPEN))
        with self._database.reading("the jobs could not be read") as session:
            return session.scalar(wanted) or 0

    def _update(self, job: StoredJob, more: dict[str, Any]) -> None:
        with self._database.writing("the job could not be saved", is_lasting=False) as session:
            session.execute(update(JobRow).where(JobRow.id == job.id).values(**_values(job), **more))


def _json(text: str) -> Any:  # noqa: ANN401
    """Return the JSON in a row; raise `StorageError` if it is none."""
    try:
        return json.loads(text)
    except (TypeError, ValueError, RecursionError) as error:
        raise StorageError("the job could not be read", f"its row has no JSON: {error}") from None


def _values(job: StoredJob) -> dict[str, Any]:
    return {field.name: getattr(job, field.name) for field in fields(job)}
