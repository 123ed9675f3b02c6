"""The server's log: lines with time, level and source on standard error, as text or as JSON.

What is logged while a request is answered has the request's id.

A separate thread writes them. A stopped terminal, or a pipe that nobody reads, then blocks that thread and not the
server; lines that do not fit into the queue are dropped.
"""

import asyncio
import json
import logging
import os
import queue
import re
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from logging.handlers import QueueHandler

from app.server.request_id import REQUEST_ID

LINES_MAX = 1000
"""Largest number of lines waiting to be written."""

_FORMAT = "%(asctime)s %(levelname)s %(name)s: %(message)s"
_TIME_FORMAT = "%Y-%m-%dT%H:%M:%S%z"
_LEVELS = {"app": logging.INFO, "uvicorn.access": logging.INFO, "uvicorn.error": logging.INFO}
_LAST_LINES_S = 0.2
"""Time to write the last lines when the server ends (s)."""

_WEBSOCKET = '%s - "WebSocket %s" '
"""The beginning of uvicorn's lines about requests for websockets."""

_ACCEPTED = "[accepted]"


def _in_any_form(text: str) -> str:
    """Return a pattern for a text in either case, whose characters may be percent-encoded, once or more often."""
    forms = (f"{re.escape(sign)}|%(?:25)*(?:{ord(sign):02x}|{ord(sign.swapcase()):02x})" for sign in text)
    return "".join(f"(?:{form})" for form in forms)


_SECRETS = re.compile(
    rf"({_in_any_form('token=')})[^\s&]+?(?=\"?(?:[\s&]|$))"
    rf"|({_in_any_form('/')}+{_in_any_form('s')}{_in_any_form('/')}+)[A-Za-z0-9_%-]{{8,}}"
    r"|(pleat-\d+=|bearer )[^\s;]+",
    re.IGNORECASE,
)
"""What must not be in the log: the server's token in an address, a cookie or a header, and the tokens of links."""

Lines = queue.Queue[logging.LogRecord | None]


@contextmanager
def logging_to(descriptor: int, *, as_json: bool = False) -> Iterator[None]:
    """Write the log, requests included, to an open file during this context."""
    lines: Lines = queue.Queue(LINES_MAX)
    root, handler = logging.getLogger(), _DroppingHandler(lines)
    writer = threading.Thread(
        target=_write, args=(lines, descriptor, _JsonLine() if as_json else _TextLine()), name="log", daemon=True
    )
    writer.start()
    handler.addFilter(_is_news)
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


def _is_news(record: logging.LogRecord) -> bool:
    """Return whether a record tells something; that the end of the server has cut off a slow request does not.

    uvicorn logs such a request as an exception, with its stack, as if the application had failed. Of what uvicorn says
    below warnings, only the websockets that were refused are news.
    """
    if record.name == "uvicorn.error" and record.levelno < logging.WARNING:
        text = str(record.msg)
        return text.startswith(_WEBSOCKET) and not text.endswith(_ACCEPTED)
    return record.exc_info is None or record.exc_info[0] is not asyncio.CancelledError


def _without_secrets(text: str) -> str:
    """Return a line with dots in the place of tokens."""
    return _SECRETS.sub(lambda found: f"{next(filter(None, found.groups()))}...", text)


class _DroppingHandler(QueueHandler):
    """Queues lines while there is room, each with the id of its request."""

    def prepare(self, record: logging.LogRecord) -> logging.LogRecord:
        """Return the record as it is written, from the context of the request."""
        prepared: logging.LogRecord = super().prepare(record)
        prepared.msg = prepared.message = _without_secrets(prepared.getMessage())
        prepared.request = REQUEST_ID.get()
        return prepared

    def enqueue(self, record: logging.LogRecord) -> None:
        """Queue a line without ever waiting for room, since the caller may be the event loop."""
        with suppress(queue.Full):
            self.queue.put_nowait(record)


class _TextLine(logging.Formatter):
    """A line with time, level, source, message and the request's id."""

    def __init__(self) -> None:
        super().__init__(_FORMAT, _TIME_FORMAT)

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        request = getattr(record, "request", "")
        return super().format(record) + (f" request={request}" if request else "")


class _JsonLine(_TextLine):
    """The same as a JSON object."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        line = {
            "time": self.formatTime(record, _TIME_FORMAT),
            "level": record.levelname,
            "source": record.name,
            "message": record.getMessage(),
        }
        request = getattr(record, "request", "")
        return json.dumps({**line, "request": request} if request else line)


def _write(lines: Lines, descriptor: int, formatter: logging.Formatter) -> None:
    """Write lines until None arrives, bypassing Python's buffer: its lock must be free when the interpreter ends."""
    while (record := lines.get()) is not None:
        with suppress(OSError):
            os.write(descriptor, (formatter.format(record) + "\n").encode("utf-8", "backslashreplace"))
