"""Bounds on what a piece of work may take of the machine, for the process that does it."""

import fcntl
import os
import resource
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def bounded(memory_bytes: int, cpu_s: int) -> Iterator[None]:
    """Let this process take some more memory (bytes) and processor time (s) during this context, and no more.

    Beyond the memory there is a `MemoryError`, beyond the time the system ends the process. A limit that the system
    does not have is left out.
    """
    used, mapped_bytes = resource.getrusage(resource.RUSAGE_SELF), _mapped_bytes()
    time_limit = int(used.ru_utime + used.ru_stime) + cpu_s
    memory_limit = None if mapped_bytes is None else mapped_bytes + memory_bytes
    with _soft(resource.RLIMIT_AS, memory_limit), _soft(resource.RLIMIT_CPU, time_limit):
        yield


@contextmanager
def one_at_a_time(folder: Path) -> Iterator[None]:
    """Wait until no other process is in this context for the same folder, and keep others out; raises `OSError`."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


@contextmanager
def _soft(kind: int, limit: int | None) -> Iterator[None]:
    """Set a limit of this process unless it has a stricter one, and afterwards what it was; None: leave it."""
    soft, hard = resource.getrlimit(kind)
    if limit is not None and (soft == resource.RLIM_INFINITY or limit < soft):
        with suppress(ValueError, OSError):
            resource.setrlimit(kind, (limit, hard))
    try:
        yield
    finally:
        with suppress(ValueError, OSError):
            resource.setrlimit(kind, (soft, hard))


def _mapped_bytes() -> int | None:
    """Return how much memory this process has mapped; None where the system does not say."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    except (OSError, ValueError):
        return None
