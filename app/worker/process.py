"""One process that does pieces of work, one after the other, and tells news on the way.

It keeps what they have in common: robots, reach, cloth. Work that is stopped is first asked to end; work that does not
within `YIELD_S` is killed with its process, even inside a library. Whoever waits for an answer waits on the pipe, on
the end of the process and on the stop at once.
"""

import contextlib
import math
import multiprocessing
import multiprocessing.connection
import os
import pickle
import signal
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Protocol, TypeVar

from app.worker.stop import Stop, StoppedError
from app.worker.template import LostProcessError, become_worker, started, starting
from planner.robots.own_robots import robots_folder, use_robots_folder

YIELD_S = 1.0
"""Time after which stopped work is killed unless it has ended (s)."""

_NEWS, _ANSWER, _ERROR = "news", "answer", "error"

Answer = TypeVar("Answer")
Hear = Callable[[Any], None]


class Caller(Protocol):
    """The caller of a piece of work, as the work sees it."""

    def tell(self, news: object) -> None:
        """Send news on the way to the answer."""

    def should_stop(self) -> bool:
        """Return whether nobody wants the answer any more."""


def ignore(_: object) -> None:
    """Ignore news."""


@dataclass(frozen=True, slots=True)
class _Order:
    """A piece of work, numbered from 1 in each worker, and the folder of one's own robots."""

    number: int
    robots: Path
    work: Callable[..., Any]
    arguments: tuple[Any, ...]
    options: dict[str, Any]


class Worker:
    """A process that does one piece of work at a time.

    Attributes:
        is_idle: whether it has done its work and can be given more.
    """

    def __init__(self, stop: Stop, niceness: int = 0, yield_s: float = YIELD_S) -> None:
        """Start the process; raises as `started` does.

        Args:
            stop: stops the wait for the planner to be loaded.
            niceness: how much less right to the processor it has than others.
            yield_s: the time after which stopped work is killed unless it has ended (s).
        """
        self.is_idle = True
        self._yield_s = yield_s
        self._number = 0
        self._pipe, theirs = multiprocessing.Pipe()
        stops, self._stops = multiprocessing.Pipe(duplex=False)
        self._woken, self._waking = multiprocessing.Pipe(duplex=False)
        try:
            self._process = started(_serve, stop, theirs, stops, niceness)
        except BaseException:
            self._close()
            raise
        finally:
            theirs.close()
            stops.close()

    @property
    def is_alive(self) -> bool:
        """Whether the process is alive; only for an idle one, whose pipe has nothing to read but its end."""
        with starting:
            return self._process.is_alive() and not self._pipe.poll()

    def run(
        self,
        work: Callable[..., Answer],
        stop: Stop,
        on_news: Hear,
        arguments: tuple[Any, ...],
        options: dict[str, Any],
    ) -> Answer:
        """Return the result of a piece of work; see `Workers.run`."""
        if stop():
            raise StoppedError
        self._number += 1
        data = pickle.dumps(_Order(self._number, robots_folder(), work, arguments, options))
        self.is_idle = False
        forget = stop.then(self._wake)
        try:
            self._pipe.send_bytes(data)
            answer: Answer = self._answer(stop, on_news)
            return answer
        except (EOFError, ConnectionError):
            with starting:
                self._process.join(YIELD_S)
                raise LostProcessError(f"exit code {self._process.exitcode}") from None
        finally:
            forget()

    def end(self) -> None:
        """End the process, and those that its work has started."""
        with starting:
            self._process.kill()
            if self._process.pid is not None:
                with contextlib.suppress(ProcessLookupError, PermissionError):  # it has ended, or never led a group
                    os.killpg(self._process.pid, signal.SIGKILL)
            self._process.join()
            self._process.close()
        self._close()

    def _answer(self, stop: Stop, on_news: Hear) -> Any:  # noqa: ANN401
        ends_s = math.inf
        while True:
            if stop() and math.isinf(ends_s):
                ends_s = time.monotonic() + self._yield_s
                self._stops.send(self._number)
            left_s = None if math.isinf(ends_s) else max(0.0, ends_s - time.monotonic())
            ready = multiprocessing.connection.wait((self._pipe, self._process.sentinel, self._woken), left_s)
            if self._woken in ready:
                self._woken.recv_bytes()
            if self._pipe in ready:
                kind, value = self._pipe.recv()
                if kind == _NEWS:
                    if not stop():
                        on_news(value)
                    continue
                self.is_idle = True
                if stop():
                    raise StoppedError
                if kind == _ERROR:
                    raise value
                return value
            if self._process.sentinel in ready:
                raise EOFError  # its children may still hold the pipe open
            if not ready:
                raise StoppedError

    def _wake(self) -> None:
        with contextlib.suppress(OSError):  # it has ended meanwhile
            self._waking.send_bytes(b"")

    def _close(self) -> None:
        for connection in (self._pipe, self._stops, self._woken, self._waking):
            connection.close()


class _Asking:
    """The caller of a piece of work, at the other end of a pipe."""

    def __init__(self, pipe: Connection, number: int, stopped: "_Stopped") -> None:
        self._pipe, self._number, self._stopped = pipe, number, stopped

    def tell(self, news: object) -> None:
        self._pipe.send((_NEWS, news))

    def should_stop(self) -> bool:
        return self._stopped.number >= self._number


class _Stopped:
    """The number of the last piece of work that was stopped; ends this process as soon as the program has ended."""

    def __init__(self, stops: Connection) -> None:
        self.number = 0
        self._stops = stops
        threading.Thread(target=self._watch, name="stops", daemon=True).start()

    def _watch(self) -> None:
        parent = multiprocessing.parent_process()
        assert parent is not None
        with contextlib.suppress(EOFError, ConnectionError):
            while parent.sentinel not in multiprocessing.connection.wait([parent.sentinel, self._stops]):
                self.number = self._stops.recv()
        os.killpg(0, signal.SIGKILL)


def _serve(pipe: Connection, stops: Connection, niceness: int) -> None:
    """Do what comes through a pipe; runs in the worker, which leads a group of its own.

    Processes that the work starts belong to the group, and so end with it.
    """
    os.setpgid(0, 0)
    os.nice(niceness)
    multiprocessing.current_process().daemon = False  # only processes that are no daemons may start others
    become_worker()
    stopped = _Stopped(stops)
    with contextlib.suppress(EOFError, ConnectionError):
        while True:
            _do(pipe, pipe.recv_bytes(), stopped)


def _do(pipe: Connection, data: bytes, stopped: _Stopped) -> None:
    """Do a piece of work and send its result, or its error."""
    try:
        order: _Order = pickle.loads(data)
        use_robots_folder(order.robots)
        answer = order.work(_Asking(pipe, order.number, stopped), *order.arguments, **order.options)
        pipe.send((_ANSWER, answer))
    except ConnectionError:
        raise
    except Exception as error:
        error.add_note("".join(traceback.format_exception(error)))  # pickling drops the traceback
        pipe.send((_ERROR, error))
