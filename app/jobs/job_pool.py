"""Runs jobs in threads: at most as many at once as there are workers, each of them stoppable.

The threads are daemons, so that a job that is slow to stop does not keep the program alive.
"""

import math
import os
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from app.worker.stop import Stop
from planner.errors import FoldingError

Answer = TypeVar("Answer")

PATIENCE_S = 1.5
"""Time to wait for stopped jobs when the server ends (s)."""

_RETRY_S = (1, 60)
"""Range of the wait suggested to a client when the pool is full (s)."""

_NEWS_SHARE = 0.2
"""Weight of the latest job in the moving average of durations."""


@dataclass
class BusyError(FoldingError):
    """There is no room, or no time, for another job.

    Attributes:
        retry_after_s: the time after which to try again (s).
    """

    retry_after_s: int

    def __str__(self) -> str:
        return f"the server is busy; try again in {self.retry_after_s} s"


class Job(Generic[Answer]):
    """A piece of work that is waiting, running or done.

    Attributes:
        future: its answer.
    """

    def __init__(self, work: Callable[[Stop], Answer]) -> None:
        """Take the work, a function that calls its argument from time to time to ask whether to stop."""
        self.future: Future[Answer] = Future()
        self._work = work
        self._stop = Stop()

    def stop(self) -> None:
        """Cancel the job."""
        self._stop.set()
        self.future.cancel()

    def run(self) -> None:
        """Do the work in this thread, unless the job was stopped before."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            self.future.set_result(self._work(self._stop))
        except Exception as error:
            self.future.set_exception(error)


class JobPool:
    """Runs jobs in the order in which they arrive."""

    def __init__(self, workers: int | None = None, waiting_max: int | None = None) -> None:
        """Start no thread before the first job.

        Args:
            workers: the number of jobs to run at once; by default the number of cores.
            waiting_max: the number of jobs that may wait; None for no limit.
        """
        self._workers = workers or os.cpu_count() or 1
        self._waiting_max = waiting_max
        self._jobs: queue.SimpleQueue[Job[Any] | None] = queue.SimpleQueue()
        self._open: dict[Future[Any], Job[Any]] = {}
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()
        self._is_closed = False
        self._mean_s = 0.0
        self._ended = 0

    def start(self, work: Callable[[Stop], Answer]) -> Job[Answer]:
        """Queue a piece of work; raise `BusyError` if the queue is full.

        A closed pool stops the job at once: a new thread would take the end signal meant for another.
        """
        job = Job(work)
        with self._lock:
            if self._is_closed:
                job.stop()
                return job
            self._require_room()
            self._open[job.future] = job
            if len(self._threads) < self._workers:
                thread = threading.Thread(target=self._run, name="job", daemon=True)
                self._threads.append(thread)
                thread.start()
        # A callback that knew the job would be a cycle, which keeps all that the job has to do with.
        job.future.add_done_callback(self._forget)
        self._jobs.put(job)
        return job

    def load(self) -> tuple[int, int, int]:
        """Return how many jobs wait, how many run, and how many have run so far."""
        with self._lock:
            waiting = self._waiting()
            return waiting, len(self._open) - waiting, self._ended

    def require_room(self) -> None:
        """Raise `BusyError` if the queue is full."""
        with self._lock:
            self._require_room()

    def busy(self) -> BusyError:
        """Return the error for a job that must not wait any longer."""
        with self._lock:
            return self._busy()

    def stop(self) -> None:
        """Stop all running and waiting jobs."""
        with self._lock:
            stopped = tuple(self._open.values())
        for job in stopped:
            job.stop()

    def close(self, patience_s: float = PATIENCE_S) -> None:
        """Stop all running and waiting jobs, and wait a little for the threads to end.

        A thread still in compiled code when the interpreter ends could crash it.
        """
        with self._lock:
            self._is_closed = True
            threads, self._threads = self._threads, []
        self.stop()
        for _ in threads:
            self._jobs.put(None)
        deadline = time.monotonic() + patience_s
        for thread in threads:
            thread.join(max(0.0, deadline - time.monotonic()))

    def _require_room(self) -> None:
        if self._waiting_max is not None and self._waiting() >= self._waiting_max:
            raise self._busy()

    def _waiting(self) -> int:
        """Return the number of jobs that no thread has started, without the stopped ones."""
        return sum(1 for future in self._open if not future.running())

    def _busy(self) -> BusyError:
        wait_s = self._mean_s * (self._waiting() + 1) / self._workers
        low, high = _RETRY_S
        return BusyError(min(max(math.ceil(wait_s), low), high))

    def _forget(self, future: Future[Any]) -> None:
        with self._lock:
            self._open.pop(future, None)

    def _run(self) -> None:
        while (job := self._jobs.get()) is not None:
            began_s = time.monotonic()
            job.run()
            with self._lock:
                self._ended += 1
                self._mean_s += _NEWS_SHARE * (time.monotonic() - began_s - self._mean_s)
