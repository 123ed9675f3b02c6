"""Runs one piece of work in a process of its own, and kills it when nobody needs the answer any more.

Threads share one interpreter: two searches at once take half as long again in total, and everything else waits for
them. Processes do not, and can be ended at any point, even inside a library; their memory is freed then. A template
process loads the planner and its kernels once; each piece of work runs in a fork of it, which costs a few milliseconds
and some 20 MB (measured: a plan of 0.2 s takes 9 ms longer than in a thread).
"""

import contextlib
import functools
import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
import time
import traceback
from collections.abc import Callable
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from typing import Any, Concatenate, ParamSpec, TypeVar

from app.jobs.job_pool import ShouldStop
from planner.errors import FoldingError

P = ParamSpec("P")
Answer = TypeVar("Answer")
Tell = Callable[[Any], None]

_TEMPLATE = "app.jobs.template"
_LOOK_EVERY_S = 0.02
"""Period of the check whether to stop (s)."""

_STARTS_MAX = 50
"""Largest number of attempts to start a process."""

_NEWS, _ANSWER, _ERROR = "news", "answer", "error"
_context = multiprocessing.get_context("forkserver")


class StoppedError(FoldingError):
    """The work was stopped."""

    def __str__(self) -> str:
        return "the search was stopped"


class LostProcessError(Exception):
    """The process ended before the work did: it crashed, or the system ended it."""


def ignore(_: object) -> None:
    """Ignore news."""


@functools.cache
def template_is_ready() -> threading.Event:
    """Start the template process, once; return an event that is set after loading, which takes seconds."""
    is_ready = threading.Event()
    threading.Thread(target=_load_template, args=(is_ready,), name="template", daemon=True).start()
    return is_ready


def _load_template(is_ready: threading.Event) -> None:
    _context.set_forkserver_preload([_TEMPLATE])
    resource_tracker.ensure_running()  # started later, it would unblock Ctrl-C again
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # only the server handles Ctrl-C, and ends the rest
    first = _context.Process(target=ignore, args=(None,), daemon=True)
    first.start()
    first.join()
    is_ready.set()


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
        LostProcessError: its process ended before it did.
        Exception: whatever the work raises.
    """
    while not template_is_ready().wait(_LOOK_EVERY_S):
        if should_stop():
            raise StoppedError
    ours, theirs = _context.Pipe(duplex=False)
    process = _context.Process(target=_work, args=(theirs, work, arguments, options), daemon=True)
    _start(process)
    theirs.close()
    try:
        while True:
            while not ours.poll(_LOOK_EVERY_S):
                if should_stop():
                    raise StoppedError
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
        process.kill()
        process.join()
        process.close()
        ours.close()


def _start(process: ForkServerProcess) -> None:
    """Start a process; if the template was killed from outside, retry until the system has noticed and replaced it."""
    for _ in range(_STARTS_MAX):
        try:
            process.start()
        except (EOFError, ConnectionError):
            time.sleep(_LOOK_EVERY_S)
        else:
            return
    raise LostProcessError("the template process cannot be replaced")


def _work(
    connection: Connection, work: Callable[..., Any], arguments: tuple[Any, ...], options: dict[str, Any]
) -> None:
    """Do the work and send its result; runs in the child process."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(BrokenPipeError):
        try:
            connection.send((_ANSWER, work(lambda news: connection.send((_NEWS, news)), *arguments, **options)))
        except BrokenPipeError:
            raise
        except Exception as error:
            error.add_note("".join(traceback.format_exception(error)))  # pickling drops the traceback
            connection.send((_ERROR, error))


def _end_with_parent() -> None:
    """End this process as soon as the server has ended."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    multiprocessing.connection.wait([parent.sentinel])
    os._exit(1)
