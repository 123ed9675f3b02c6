"""Work in threads of their own: never more at once than there are workers, and each can be stopped.

The threads are daemons: work that is slow to notice that it should stop does not keep the program alive.
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

from app.jobs.courtesy import Courtesy
from planner.errors import FoldingError

Answer = TypeVar("Answer")
ShouldStop = Callable[[], bool]

PATIENCE_S = 1.5
"""Wait for jobs that were stopped, when the server ends (s)."""

_RETRY_S = (1, 60)
"""The shortest and the longest wait that is told to whom comes too much (s)."""

_NEWS_SHARE = 0.2
"""Share of the latest job in the mean duration of jobs."""


@dataclass
class BusyError(FoldingError):
    """There is no room, or no time, for one more job.

    Attributes:
        retry_after_s: when there may be (s).
    """

    retry_after_s: int

    def __str__(self) -> str:
        return f"the server is busy; try again in {self.retry_after_s} s"


class Job(Generic[Answer]):
    """A piece of work that waits, runs or is done.

    Attributes:
        future: its answer.
    """

    def __init__(self, work: Callable[[ShouldStop], Answer], courtesy: Courtesy) -> None:
        """Work is given the question whether it should stop, to be asked now and then."""
        self.future: Future[Answer] = Future()
        self._work = work
        self._courtesy = courtesy
        self._stop = threading.Event()

    def stop(self) -> None:
        """Do without the answer."""
        self._stop.set()
        self.future.cancel()

    def run(self) -> None:
        """Do the work in this thread, unless it was stopped before it began."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            self.future.set_result(self._work(self._should_stop))
        except Exception as error:
            self.future.set_exception(error)

    def _should_stop(self) -> bool:
        self._courtesy.give_way()
        return self._stop.is_set()


class JobPool:
    """Takes jobs and does them in the order in which they came."""

    def __init__(
        self, workers: int | None = None, waiting_max: int | None = None, courtesy: Courtesy | None = None
    ) -> None:
        """Start no thread before the first job.

        Args:
            workers: how many jobs run at once; by default as many as there are cores.
            waiting_max: how many may wait for their turn; None: any number.
            courtesy: what the jobs give way to.
        """
        self._workers = workers or os.cpu_count() or 1
        self._waiting_max = waiting_max
        self._courtesy = courtesy or Courtesy()
        self._jobs: queue.SimpleQueue[Job[Any] | None] = queue.SimpleQueue()
        self._open: set[Job[Any]] = set()
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()
        self._is_closed = False
        self._mean_s = 0.0

    def start(self, work: Callable[[ShouldStop], Answer]) -> Job[Answer]:
        """Queue a piece of work; raises `BusyError` when as many wait as may.

        Once the pool is closed the job is stopped at once: a thread begun for it would take another's word to end.
        """
        job = Job(work, self._courtesy)
        with self._lock:
            if self._is_closed:
                job.stop()
                return job
            if self._waiting_max is not None and self._waiting() >= self._waiting_max:
                raise self._busy()
            self._open.add(job)
            if len(self._threads) < self._workers:
                thread = threading.Thread(target=self._run, name="job", daemon=True)
                self._threads.append(thread)
                thread.start()
        job.future.add_done_callback(lambda _: self._forget(job))
        self._jobs.put(job)
        return job

    def busy(self) -> BusyError:
        """Return the error for a job that must not wait any longer."""
        with self._lock:
            return self._busy()

    def stop(self) -> None:
        """Stop all jobs that run or wait."""
        with self._lock:
            stopped = tuple(self._open)
        for job in stopped:
            job.stop()

    def close(self, patience_s: float = PATIENCE_S) -> None:
        """Stop everything that runs or waits, and wait a little for the threads to end.

        A thread that were still in compiled code when the interpreter ends could bring it down.
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

    def _waiting(self) -> int:
        """Return how many jobs nobody works at; those that were stopped meanwhile are none."""
        return sum(1 for job in self._open if not job.future.running())

    def _busy(self) -> BusyError:
        wait_s = self._mean_s * (self._waiting() + 1) / self._workers
        low, high = _RETRY_S
        return BusyError(min(max(math.ceil(wait_s), low), high))

    def _forget(self, job: Job[Any]) -> None:
        with self._lock:
            self._open.discard(job)

    def _run(self) -> None:
        while (job := self._jobs.get()) is not None:
            began_s = time.monotonic()
            job.run()
            with self._lock:
                self._mean_s += _NEWS_SHARE * (time.monotonic() - began_s - self._mean_s)
