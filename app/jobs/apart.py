"""Runs one piece of work in a process of its own, and kills it when its answer is no longer needed.

Threads share one interpreter: two searches at once take half as long again in total, and everything else waits for
them. Processes do not, and can be ended at any point, even inside a library; their memory is freed then. A template
process loads the planner and its kernels once; each piece of work runs in a fork of it, which costs a few milliseconds
and some 20 MB (measured: a plan of 0.2 s takes 9 ms longer than in a thread).
"""

import contextlib
import logging
import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
import time
import traceback
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, TypeVar

from app.jobs.job_pool import ShouldStop
from planner.errors import FoldingError
from planner.robots.own_robots import robots_folder, use_robots_folder

P = ParamSpec("P")
Answer = TypeVar("Answer")
Tell = Callable[[Any], None]

_TEMPLATE = "app.jobs.template"
_LOOK_EVERY_S = 0.02
"""Period of the check whether to stop (s)."""

_STARTED_WITHIN_S = 10.0
"""Time for attempts to start a process (s)."""

_NEWS, _ANSWER, _ERROR = "news", "answer", "error"
_context = multiprocessing.get_context("forkserver")
_log = logging.getLogger(__name__)


class StoppedError(FoldingError):
    """The work was stopped."""

    def __str__(self) -> str:
        return "the search was stopped"


class LostProcessError(Exception):
    """The process ended before the work did: it crashed, or the system ended it."""


class PlannerNotLoadedError(FoldingError):
    """The template process could not load the planner or its kernels."""

    def __str__(self) -> str:
        return "the planner could not be loaded; the server's log says why"


def ignore(_: object) -> None:
    """Ignore news."""


class _Template:
    """The template process, as far as it is loaded."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._loading: Future[None] | None = None

    def loading(self) -> Future[None]:
        """Start the template process unless that is done; return the end of its loading, which takes seconds.

        A template that failed is replaced.
        """
        with self._lock:
            if self._loading is None or (self._loading.done() and self._loading.exception()):
                self._loading = Future()
                threading.Thread(target=_load_template, args=(self._loading,), name="template", daemon=True).start()
            return self._loading

    def problem(self) -> str | None:
        """Return why loading failed; None if it did not, or not yet."""
        with self._lock:
            failed = self._loading is not None and self._loading.done() and self._loading.exception()
            return str(failed) if failed else None


_template = _Template()


def start_template() -> None:
    """Start the template process, so that the first work does not wait for it."""
    _template.loading()


def template_problem() -> str | None:
    """Return why no process has the planner; None if one has it or is loading it."""
    return _template.problem()


def _load_template(loading: Future[None]) -> None:
    _context.set_forkserver_preload([_TEMPLATE])
    resource_tracker.ensure_running()  # started later, it would unblock Ctrl-C again
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # only the server handles Ctrl-C, and ends the rest
    first = _context.Process(target=ignore, args=(None,), daemon=True)
    try:
        _start(first)  # where loading fails the template ends, after it has written why
        first.join()
    except Exception:
        _log.exception("the template process could not load the planner")
        loading.set_exception(PlannerNotLoadedError())
    else:
        loading.set_result(None)


def run_apart(
    work: Callable[Concatenate[Tell, P], Answer],
    should_stop: ShouldStop,
    on_news: Tell,
    *arguments: P.args,
    **options: P.kwargs,
) -> Answer:
    """Return the result of work done in a process of its own.

    Args:
        work: a module-level function. Its first argument is a function through which it can send news.
        should_stop: called while waiting; true kills the process.
        on_news: called with the news.
        arguments: the further positional arguments of the work.
        options: its keyword arguments.

    Raises:
        StoppedError: the work was stopped.
        PlannerNotLoadedError: no process has the planner; the next work tries again.
        LostProcessError: its process ended before it did.
        Exception: whatever the work raises.
    """
    _wait_until_loaded(should_stop)
    ours, theirs = _context.Pipe(duplex=False)
    process = _context.Process(target=_work, args=(theirs, robots_folder(), work, arguments, options), daemon=True)
    _start(process)
    theirs.close()
    try:
        while True:
            while not ours.poll(_LOOK_EVERY_S):
                if should_stop():
                    raise StoppedError
                if not process.is_alive() and not ours.poll():  # its children may still hold the pipe open
                    raise EOFError
            kind, value = ours.recv()
            if kind == _ANSWER:
                answer: Answer = value
                return answer
            if kind == _ERROR:
                raise value
            on_news(value)
    except EOFError:
        process.join()
        raise LostProcessError(f"exit code {process.exitcode}") from None
    finally:
        _kill(process)
        process.join()
        process.close()
        ours.close()


def _wait_until_loaded(should_stop: ShouldStop) -> None:
    loading = _template.loading()
    while True:
        try:
            return loading.result(_LOOK_EVERY_S)
        except TimeoutError:
            if should_stop():
                raise StoppedError from None


def _start(process: ForkServerProcess) -> None:
    """Start a process; if the template has ended, retry until the system has noticed and replaced it."""
    until_s = time.monotonic() + _STARTED_WITHIN_S
    while time.monotonic() < until_s:
        try:
            process.start()
        except (EOFError, ConnectionError):
            time.sleep(_LOOK_EVERY_S)
        else:
            return
    raise LostProcessError("the template process cannot be replaced")


def _work(
    connection: Connection,
    robots: Path,
    work: Callable[..., Any],
    arguments: tuple[Any, ...],
    options: dict[str, Any],
) -> None:
    """Do the work and send its result; runs in the child process, which leads a group of its own.

    Processes that the work starts belong to the group, and so end with it.
    """
    os.setpgid(0, 0)
    use_robots_folder(robots)
    multiprocessing.current_process().daemon = False  # only processes that are no daemons may start others
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(BrokenPipeError):
        try:
            connection.send((_ANSWER, work(lambda news: connection.send((_NEWS, news)), *arguments, **options)))
        except BrokenPipeError:
            raise
        except Exception as error:
            error.add_note("".join(traceback.format_exception(error)))  # pickling drops the traceback
            connection.send((_ERROR, error))


def _kill(process: ForkServerProcess) -> None:
    """Kill a process, and those that its work has started."""
    process.kill()
    if process.pid is not None:
        with contextlib.suppress(ProcessLookupError, PermissionError):  # it has ended, or never led a group
            os.killpg(process.pid, signal.SIGKILL)


def _end_with_parent() -> None:
    """End this process and its group as soon as the server has ended."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    multiprocessing.connection.wait([parent.sentinel])
    os.killpg(0, signal.SIGKILL)
