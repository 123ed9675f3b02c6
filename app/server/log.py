"""The server's log: lines with time, level and source on standard error.

A separate thread writes them. A stopped terminal, or a pipe that nobody reads, then blocks that thread and not the
server; lines that do not fit into the queue are dropped.
"""

import logging
import os
import queue
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from logging.handlers import QueueHandler

LINES_MAX = 1000
"""Largest number of lines waiting to be written."""

_FORMAT = "%(asctime)s %(levelname)s %(name)s: %(message)s"
_TIME_FORMAT = "%Y-%m-%dT%H:%M:%S%z"
_LEVELS = {"app": logging.INFO, "uvicorn.access": logging.INFO, "uvicorn.error": logging.WARNING}
_LAST_LINES_S = 0.2
"""Time to write the last lines when the server ends (s)."""

Lines = queue.Queue[logging.LogRecord | None]


@contextmanager
def logging_to(descriptor: int) -> Iterator[None]:
    """Write the log, requests included, to an open file during this context."""
    lines: Lines = queue.Queue(LINES_MAX)
    root, handler = logging.getLogger(), _DroppingHandler(lines)
    writer = threading.Thread(target=_write, args=(lines, descriptor), name="log", daemon=True)
    writer.start()
    root.addHandler(handler)
    for name, level in _LEVELS.items():
        logging.getLogger(name).setLevel(level)
    try:
        yield
    finally:
        root.removeHandler(handler)
        with suppress(queue.Full):
            lines.put_nowait(None)
        writer.join(_LAST_LINES_S)


def standard_error() -> int:
    """Return the descriptor of standard error."""
    return sys.stderr.fileno()


class _DroppingHandler(QueueHandler):
    """Queues lines while there is room."""

    def enqueue(self, record: logging.LogRecord) -> None:
        """Queue a line without ever waiting for room, since the caller may be the event loop."""
        with suppress(queue.Full):
            self.queue.put_nowait(record)


def _write(lines: Lines, descriptor: int) -> None:
    """Write lines until None arrives, bypassing Python's buffer: its lock must be free when the interpreter ends."""
    formatter = logging.Formatter(_FORMAT, _TIME_FORMAT)
    while (record := lines.get()) is not None:
        with suppress(OSError):
            os.write(descriptor, (formatter.format(record) + "\n").encode("utf-8", "backslashreplace"))
