"""The template of the workers: a process that has loaded the planner and its kernels.

A fork of it costs a few milliseconds and some 20 MB (measured), where a new interpreter would load for seconds. It and
all that it starts import nothing from the current folder, where Python would look for any module first.

A worker that needs workers of its own, as a rehearsal does, forks itself: it has the planner already.
"""

import logging
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from multiprocessing import forkserver, resource_tracker
from multiprocessing.process import BaseProcess
from typing import Any

from app.worker.stop import Stop, StoppedError
from planner.errors import FoldingError

_PRELOADED = "app.worker.preloaded"
_SAFE_PATH = "PYTHONSAFEPATH"

_STARTED_WITHIN_S, _AGAIN_AFTER_S = 10.0, 0.02
"""Time for attempts to start a process, and between two of them (s)."""

_forking = multiprocessing.get_context("fork")
_serving = multiprocessing.get_context("forkserver")
_log = logging.getLogger(__name__)

starting = threading.RLock()
"""Held while a process is started or waited for: `multiprocessing` keeps a list of its children that no lock guards."""


class LostProcessError(Exception):
    """The process ended before the work did: it crashed, or the system ended it."""


class PlannerNotLoadedError(FoldingError):
    """The template process could not load the planner or its kernels."""

    def __str__(self) -> str:
        return "the planner could not be loaded; the server's log says why"


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

    def be_loaded(self) -> None:
        """Have the planner in this process, which is a worker."""
        with self._lock:
            self._loading = Future()
            self._loading.set_result(None)

    def problem(self) -> str | None:
        """Return why loading failed; None if it did not, or not yet."""
        with self._lock:
            failed = self._loading is not None and self._loading.done() and self._loading.exception()
            return str(failed) if failed else None


_template = _Template()
_is_worker = False


def start_template() -> None:
    """Start the template process, so that the first work does not wait for it."""
    _template.loading()


def template_problem() -> str | None:
    """Return why no process has the planner; None if one has it or is loading it."""
    return _template.problem()


def become_worker() -> None:
    """Note that this process is a worker, of which further ones are forks."""
    global _is_worker
    _is_worker = True
    _template.be_loaded()


def started(target: Callable[..., None], stop: Stop, *arguments: Any) -> BaseProcess:  # noqa: ANN401
    """Return a new process that has the planner; it ends with this one.

    Raises:
        StoppedError: it was stopped while the planner was being loaded.
        PlannerNotLoadedError: the planner cannot be loaded; the next call tries again.
        LostProcessError: no process can be started.
    """
    _wait_until_loaded(stop)
    process = (_forking if _is_worker else _serving).Process(target=target, args=arguments, daemon=True)
    _start(process)
    return process


def _wait_until_loaded(stop: Stop) -> None:
    loading, either = _template.loading(), threading.Event()
    loading.add_done_callback(lambda _: either.set())
    forget = stop.then(either.set)
    either.wait()
    forget()
    if not loading.done():
        raise StoppedError
    loading.result()


def _load_template(loading: Future[None]) -> None:
    _serving.set_forkserver_preload([_PRELOADED])
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # only the program handles Ctrl-C, and ends the rest
    first = _serving.Process(target=_do_nothing, daemon=True)
    try:
        with _safe_path():
            resource_tracker.ensure_running()  # started later, it would unblock Ctrl-C again
            forkserver.ensure_running()
        _start(first)  # where loading fails the template ends, after it has written why
        first.join()
    except Exception:
        _log.exception("the template process could not load the planner")
        loading.set_exception(PlannerNotLoadedError())
    else:
        loading.set_result(None)


def _do_nothing() -> None:
    """Do nothing: the first process that is started waits until the template is loaded."""


@contextmanager
def _safe_path() -> Iterator[None]:
    """Have interpreters started in this context look for no module in the current folder."""
    before = os.environ.get(_SAFE_PATH)
    os.environ[_SAFE_PATH] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[_SAFE_PATH]


def _start(process: BaseProcess) -> None:
    """Start a process; if the template has ended, retry until the system has noticed and replaced it."""
    until_s = time.monotonic() + _STARTED_WITHIN_S
    while time.monotonic() < until_s:
        try:
            with starting, _safe_path():
                process.start()
        except (EOFError, ConnectionError):
            time.sleep(_AGAIN_AFTER_S)
        else:
            return
    raise LostProcessError("the template process cannot be replaced")
