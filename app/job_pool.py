"""Searches in threads of their own: never more at once than the machine has cores, each can be stopped.

The threads are daemons: a search that is slow to notice that it should stop does not keep the program alive.
"""

import os
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Generic, TypeVar

Answer = TypeVar("Answer")
ShouldStop = Callable[[], bool]


class Job(Generic[Answer]):
    """A piece of work that waits, runs or is done.

    Attributes:
        future: its answer.
    """

    def __init__(self, work: Callable[[ShouldStop], Answer]) -> None:
        """Work is given the question whether it should stop, to be asked now and then."""
        self.future: Future[Answer] = Future()
        self._work = work
        self._stop = threading.Event()

    def stop(self) -> None:
        """Nobody wants the answer any more."""
        self._stop.set()
        self.future.cancel()

    def run(self) -> None:
        """Do the work in this thread, unless it was stopped before it began."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            self.future.set_result(self._work(self._stop.is_set))
        except Exception as error:
            self.future.set_exception(error)


class JobPool:
    """Takes jobs and does them in the order in which they came."""

    def __init__(self, workers: int | None = None) -> None:
        """So many at once; by default as many as there are cores. Threads start with the first job."""
        self._workers = workers or os.cpu_count() or 1
        self._jobs: queue.SimpleQueue[Job[Any] | None] = queue.SimpleQueue()
        self._open: set[Job[Any]] = set()
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()

    def start(self, work: Callable[[ShouldStop], Answer]) -> Job[Answer]:
        """Queue a piece of work."""
        job = Job(work)
        with self._lock:
            self._open.add(job)
            if len(self._threads) < self._workers:
                thread = threading.Thread(target=self._run, name="search", daemon=True)
                self._threads.append(thread)
                thread.start()
        self._jobs.put(job)
        return job

    def close(self, patience_s: float = 1.5) -> None:
        """Stop everything that runs or waits, and wait a little for the threads to end.

        A thread that were still in compiled code when the interpreter ends could bring it down.
        """
        with self._lock:
            for job in self._open:
                job.stop()
            threads, self._threads = self._threads, []
        for _ in threads:
            self._jobs.put(None)
        deadline = time.monotonic() + patience_s
        for thread in threads:
            thread.join(max(0.0, deadline - time.monotonic()))

    def _run(self) -> None:
        while (job := self._jobs.get()) is not None:
            job.run()
            with self._lock:
                self._open.discard(job)
