"""Takes jobs, has them done, and reports their progress; all of it outlives the server.

A job is a row of the database from the moment it is accepted. While it is open its progress is in memory as well, so
that the database is written once a second at most. Jobs that the end of a server interrupted are begun anew at the next
start where their kind allows that, and are marked as failed otherwise.
"""

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import wait
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from app.jobs.job_kind import AnyKind, Progressed, Stores, do_job
from app.jobs.job_pool import Job, JobPool
from app.jobs.limits import TooManyError
from app.store.job_repository import JobRepository, JobStatus, StoredJob
from app.store.storage_error import StorageError
from app.worker.stop import Stop, StoppedError
from app.worker.template import LostProcessError
from app.worker.workers import Workers
from planner.errors import FoldingError

OPEN_OF_CLIENT_MAX = 16
"""Largest number of open jobs of one client."""

BEGUN_MAX = 3
"""Times that a job is begun at most; without a limit, a job that crashes the server would do so at every start."""

_SAVE_EVERY_S = 1.0
"""Least time between two writes of a job's progress (s)."""

_CANCEL_WITHIN_S = 1.0
"""Time for which `cancel` waits for the job's end (s)."""

_SERVER_STOPPED = "the server stopped"
_CRASHED = "its process ended before the work did, perhaps for want of memory"
_BUG = "the server failed on this job; its log says why"

_log = logging.getLogger(__name__)


@dataclass
class ForeignJobError(FoldingError):
    """A job is done by another server on the same database."""

    job_id: str

    def __str__(self) -> str:
        return f"the job {self.job_id!r} is done by another server; cancel it there"


@dataclass
class _OpenJob:
    """A job that this server has not seen end."""

    stored: StoredJob
    job: Job[None] | None = None
    is_cancelled: bool = False
    saved_s: float = 0.0
    release: Callable[[], None] = lambda: None
    listeners: list[Callable[[], None]] = field(default_factory=list)
    found: list[dict[str, Any]] = field(default_factory=list)


class JobDesk:
    """The jobs of a server; safe to use from any thread."""

    def __init__(
        self, kinds: Mapping[str, AnyKind], stores: Stores, repository: JobRepository, pool: JobPool, workers: Workers
    ) -> None:
        """Take up no job before `resume`."""
        self._kinds = kinds
        self._stores = stores
        self._repository = repository
        self._pool = pool
        self._workers = workers
        self._open: dict[str, _OpenJob] = {}
        self._lock = threading.RLock()

    def resume(self) -> None:
        """Begin the jobs anew that the end of a server interrupted, or mark them as failed."""
        for stored in self._repository.interrupted():
            kind = self._kinds.get(stored.kind)
            if kind is None or not kind.may_begin_anew or stored.begun >= BEGUN_MAX:
                self._repository.keep(_ended(stored, "failed", _SERVER_STOPPED))
                continue
            try:
                asked = kind.prepare(self._stores, kind.form.read(self._repository.body(stored.id)))
                self._begin(kind, asked, replace(stored, status="queued", progress=0.0, message=""))
            except FoldingError as error:
                self._repository.keep(_ended(stored, "failed", f"{_SERVER_STOPPED}, and then: {error}"))

    def submit(
        self, kind: AnyKind, data: object, client: str, naming: Callable[[], AbstractContextManager[None]] = nullcontext
    ) -> StoredJob:
        """Take a job and return it; it is in the database by then.

        Args:
            kind: its kind.
            data: the body of the request, as JSON.
            client: who asks.
            naming: a context that names the fields of the body in what `prepare` raises.

        Raises:
            FoldingError: the request is bad.
            TooManyError: the client has too many open jobs.
            BusyError: the queue is full.
            StorageError: the database refuses.
        """
        body = kind.form.read(data)
        with naming():
            asked = kind.prepare(self._stores, body)
        with self._lock:
            if self._repository.open_count(client) >= OPEN_OF_CLIENT_MAX:
                retry_after_s = self._pool.busy().retry_after_s
                raise TooManyError(f"there are {OPEN_OF_CLIENT_MAX} open jobs of yours already", retry_after_s)
            self._pool.require_room()
            stored = self._repository.add(kind.name, client, kind.about(asked), data)
            self._begin(kind, asked, stored)
        return self.job(stored.id)

    def job(self, job_id: str) -> StoredJob:
        """Return a job as it is now; raise `UnknownJobError` if there is none."""
        with self._lock:
            if job_id in self._open:
                return self._open[job_id].stored
        return self._repository.job(job_id)

    def result(self, job_id: str) -> Any:  # noqa: ANN401
        """Return a job's result; None if it has none."""
        return self._repository.result(job_id)

    def found(self, job_id: str) -> Sequence[dict[str, Any]]:
        """Return what a job has found so far, as JSON, which grows as it finds more; empty once it has ended."""
        with self._lock:
            return self._open[job_id].found if job_id in self._open else ()

    def newest(self, most: int, before: str | None = None) -> list[StoredJob]:
        """Return the newest jobs that are listed, or the newest of those older than the job `before`."""
        unlisted = [kind.name for kind in self._kinds.values() if not kind.is_listed_cancelled]
        found = self._repository.newest(most, before, unlisted)
        with self._lock:
            return [self._open[job.id].stored if job.id in self._open else job for job in found]

    def cancel(self, job_id: str) -> StoredJob:
        """Cancel a job unless it has ended; return it. Its process is killed.

        Raises:
            UnknownJobError: there is no such job.
            ForeignJobError: another server does it.
        """
        with self._lock:
            found = self._open.get(job_id)
            if found is None or found.job is None:
                job = self.job(job_id)
                if found is None and job.is_open:
                    raise ForeignJobError(job_id)
                return job
            found.is_cancelled = True
            found.job.stop()
            if found.job.future.cancelled():
                self._end(job_id, "cancelled", "")
        wait([found.job.future], _CANCEL_WITHIN_S)
        return self.job(job_id)

    def subscribe(self, job_id: str, listener: Callable[[], None]) -> Callable[[], None]:
        """Call a function after each change of a job, from any thread; return the function that ends this."""
        with self._lock:
            found = self._open.get(job_id)
            if found is None:
                return lambda: None
            found.listeners.append(listener)

        def unsubscribe() -> None:
            with self._lock, suppress(ValueError):
                found.listeners.remove(listener)

        return unsubscribe

    def _begin(self, kind: AnyKind, asked: object, stored: StoredJob) -> None:
        with self._lock:
            release = partial(kind.release, self._stores, asked)
            found = self._open[stored.id] = _OpenJob(stored, release=release)
            try:
                found.job = self._pool.start(partial(self._run, stored.id, kind, asked))
            except BaseException:
                del self._open[stored.id]
                raise

    def _run(self, job_id: str, kind: AnyKind, asked: object, stop: Stop) -> None:
        """Have a job done in a process of its own, and keep its end."""
        try:
            begun = self._open[job_id].stored.begun + 1
            self._change(job_id, is_saved=True, status="running", started_s=time.time(), begun=begun)
            answer = self._workers.run_alone(do_job, stop, partial(self._hear, job_id, kind), kind.work, asked)
            self._end(job_id, "done", "", kind.finish(self._stores, answer))
        except StoppedError:
            if self._open[job_id].is_cancelled:
                self._end(job_id, "cancelled", "")
            # otherwise the server is stopping: the row stays open, for its next start
        except LostProcessError:
            self._end(job_id, "failed", _CRASHED)
        except FoldingError as error:
            self._end(job_id, "failed", str(error))
        except Exception:
            _log.exception("job %s (%s) failed", job_id, kind.name)
            self._end(job_id, "failed", _BUG)

    def _hear(self, job_id: str, kind: AnyKind, news: Progressed) -> None:
        if news.found is not None:
            self._open[job_id].found.append(kind.tell(self._stores, news.found))
        is_saved = time.monotonic() - self._open[job_id].saved_s >= _SAVE_EVERY_S
        try:
            self._change(job_id, is_saved=is_saved, progress=news.share, message=news.message)
        except StorageError as error:
            _log.warning("%s", error)

    def _change(self, job_id: str, *, is_saved: bool, **changes: Any) -> None:  # noqa: ANN401
        with self._lock:
            found = self._open[job_id]
            found.stored = replace(found.stored, revision=found.stored.revision + 1, **changes)
            if is_saved:
                found.saved_s = time.monotonic()
                self._repository.keep(found.stored)
        _tell(found)

    def _end(self, job_id: str, status: JobStatus, message: str, result: object = None) -> None:
        """Keep how a job ended; where the database refuses, say so in memory at least."""
        with self._lock:
            found = self._open[job_id]
            ended = _ended(found.stored, status, message)
            try:
                self._repository.keep_result(ended, result)
            except FoldingError as error:
                _log.error("the end of job %s could not be saved: %s", job_id, error)
                found.stored = _ended(found.stored, "failed", str(error))
            else:
                del self._open[job_id]
        found.release()
        _tell(found)


def _tell(found: _OpenJob) -> None:
    for listener in tuple(found.listeners):
        listener()


def _ended(job: StoredJob, status: JobStatus, message: str) -> StoredJob:
    progress = 1.0 if status == "done" else job.progress
    revision = job.revision + 1
    return replace(job, status=status, progress=progress, message=message, ended_s=time.time(), revision=revision)
