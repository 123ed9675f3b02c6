"""The workers of a program: processes that have loaded the planner, kept for the next piece of work.

Threads share one interpreter: two searches at once take half as long again in total, and everything else waits for
them. Processes do not, and can be killed at any point.
"""

import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Any, Concatenate, ParamSpec, Self, TypeVar

from app.worker.process import Caller, Hear, Worker
from app.worker.stop import Stop, StoppedError

P = ParamSpec("P")
Answer = TypeVar("Answer")


class Workers:
    """Keeps as many idle workers as there are cores; safe to use from any thread.

    How many work at once is for the callers to limit: who finds no idle worker gets a new one.
    """

    def __init__(self, kept: int | None = None, niceness: int = 0) -> None:
        """Start no process before there is work.

        Args:
            kept: the number of idle workers to keep; by default the number of cores.
            niceness: how much less right to the processor they have than others.
        """
        self._kept = kept or os.cpu_count() or 1
        self._niceness = niceness
        self._changed = threading.Condition()
        self._idle: list[Worker] = []
        self._count = 0
        self._busy: set[str | None] = set()
        self._served: dict[str, Worker] = {}
        self._served_s: dict[Worker, float] = {}
        self._is_closed = False

    def __enter__(self) -> Self:
        """Return these workers."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End them."""
        self.close()

    def run(
        self,
        work: Callable[Concatenate[Caller, P], Answer],
        stop: Stop,
        on_news: Hear,
        *arguments: P.args,
        **options: P.kwargs,
    ) -> Answer:
        """Return the result of work done in a worker.

        Args:
            work: a module-level function. Its first argument is the `Caller`.
            stop: stops the work: it is asked to end, and killed if it does not within a second.
            on_news: called with the news that the work tells; no more once it is stopped.
            arguments: the further positional arguments of the work; they must be picklable, and so must its answer.
            options: its keyword arguments.

        Raises:
            StoppedError: the work was stopped.
            PlannerNotLoadedError: no process has the planner; the next work tries again.
            LostProcessError: its process ended before it did.
            Exception: whatever the work raises.
        """
        return self._run(None, work, stop, on_news, arguments, options)

    def run_for(
        self,
        key: str,
        work: Callable[Concatenate[Caller, P], Answer],
        stop: Stop,
        on_news: Hear,
        *arguments: P.args,
        **options: P.kwargs,
    ) -> Answer:
        """Return the result of work done, if possible, in the worker that did the last work for the same key.

        While that one is busy with earlier work for the key, wait for it. Arguments and errors are those of `run`.
        """
        return self._run(key, work, stop, on_news, arguments, options)

    def run_alone(
        self,
        work: Callable[Concatenate[Caller, P], Answer],
        stop: Stop,
        on_news: Hear,
        *arguments: P.args,
        **options: P.kwargs,
    ) -> Answer:
        """Return the result of work done in a process of its own, which ends with it, and with all that it started.

        For work that may leave something behind: files of other people, programs, much memory. It is killed as soon as
        it is stopped. Arguments and errors are those of `run`.
        """
        worker = Worker(stop, self._niceness, yield_s=0.0)
        try:
            return worker.run(work, stop, on_news, arguments, options)
        finally:
            worker.end()

    def forget(self, key: str) -> None:
        """Forget which worker worked for a key."""
        with self._changed:
            self._served.pop(key, None)

    def end_idle(self) -> None:
        """End the workers that have nothing to do."""
        with self._changed:
            ended = tuple(self._idle)
            for worker in ended:
                self._drop(worker)
        for worker in ended:
            worker.end()

    def close(self) -> None:
        """End the idle workers now, and the others as soon as they have done their work."""
        with self._changed:
            self._is_closed = True
        self.end_idle()

    def _run(
        self,
        key: str | None,
        work: Callable[..., Answer],
        stop: Stop,
        on_news: Hear,
        arguments: tuple[Any, ...],
        options: dict[str, Any],
    ) -> Answer:
        worker = self._taken(key, stop)
        try:
            return worker.run(work, stop, on_news, arguments, options)
        finally:
            self._release(worker, key)

    def _taken(self, key: str | None, stop: Stop) -> Worker:
        """Return a worker for work, busy from now on; a key is busy before its worker is there."""
        forget = stop.then(self._notify)
        try:
            with self._changed:
                while key in self._busy:
                    if stop():
                        raise StoppedError
                    self._changed.wait()
                found = self._chosen(key)
                if found is None:
                    self._count += 1
                if key is not None:
                    self._busy.add(key)
        finally:
            forget()
        try:
            worker = found or Worker(stop, self._niceness)
        except BaseException:
            with self._changed:
                self._count -= 1
                self._busy.discard(key)
                self._changed.notify_all()
            raise
        if key is not None:
            with self._changed:
                self._served[key] = worker
                self._served_s[worker] = time.monotonic()
        return worker

    def _chosen(self, key: str | None) -> Worker | None:
        """Return an idle worker; None for a new one.

        A worker that has worked for a key is left to it, while there may be others.
        """
        for worker in [one for one in self._idle if not one.is_alive]:
            self._drop(worker)
            worker.end()
        found = None if key is None else self._served.get(key)
        if found not in self._idle:
            found = min(self._idle, key=self._last_served_s, default=None)
            if found is not None and self._last_served_s(found) > 0.0 and self._count < self._kept:
                return None
        if found is not None:
            self._idle.remove(found)
        return found

    def _release(self, worker: Worker, key: str | None) -> None:
        """Keep a worker for more work if it can do more; end one if there are too many."""
        with self._changed:
            self._busy.discard(key)
            ended: Worker | None = worker
            if worker.is_idle and not self._is_closed:
                self._idle.append(worker)
                ended = None if self._count <= self._kept else min(self._idle, key=self._last_served_s)
            if ended is not None:
                self._drop(ended)
            self._changed.notify_all()
        if ended is not None:
            ended.end()

    def _drop(self, worker: Worker) -> None:
        """Forget a worker that ends."""
        self._count -= 1
        if worker in self._idle:
            self._idle.remove(worker)
        self._served_s.pop(worker, None)
        self._served = {key: one for key, one in self._served.items() if one is not worker}

    def _last_served_s(self, worker: Worker) -> float:
        """Return when a worker last worked for a key; 0 if it never has."""
        return self._served_s.get(worker, 0.0)

    def _notify(self) -> None:
        with self._changed:
            self._changed.notify_all()


class Team(Workers):
    """Workers, and as many threads that wait for them; closing it sets `stop`, with which all of its work is to run."""

    def __init__(self, count: int) -> None:
        """Start no process before there is work, and at most so many."""
        super().__init__(kept=count)
        self.stop, self._threads = Stop(), ThreadPoolExecutor(count)

    def start(self, act: Callable[P, Answer], *arguments: P.args, **options: P.kwargs) -> Future[Answer]:
        """Call a function that waits for a worker, such as `run`, in a thread."""
        return self._threads.submit(act, *arguments, **options)

    def close(self) -> None:
        """Stop all work, wait for it to end, and end the workers."""
        self.stop.set()
        self._threads.shutdown(cancel_futures=True)
        super().close()
