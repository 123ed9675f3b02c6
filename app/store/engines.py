"""The ways to the databases: how connections are set up, and how transactions begin.

SQLite would begin a transaction as a reader and refuse it the change if another connection had written meanwhile.
So sessions say at the start whether they write, and writers wait for each other then.
"""

import os
import secrets
import shutil
import sqlite3
import tempfile
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection, Engine, NullPool, create_engine, event, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session
from sqlalchemy.pool import StaticPool

IS_WRITING, IS_SYNCED = "pleat_is_writing", "pleat_is_synced"
"""Execution options of an engine: whether a transaction changes something, and whether it waits for the disk."""

_BUSY_S = 5.0
"""Time to wait for another connection's transaction (s)."""

_CONNECTIONS, _MORE_CONNECTIONS = 8, 32
"""Number of connections that are kept, and of further ones at busy times."""

_PRIVATE = 0o600

_CONNECT_S = 5
"""Time to wait for a database server (s)."""


def sqlite_engine(path: Path) -> Engine:
    """Return the engine of an SQLite file, which only its owner can read; SQLite would leave that to the umask."""
    os.close(os.open(path, os.O_CREAT | os.O_RDONLY, _PRIVATE))
    with suppress(OSError):  # it is another user's
        path.chmod(_PRIVATE)
    engine = create_engine(
        f"sqlite:///{path}", connect_args={"timeout": _BUSY_S}, pool_size=_CONNECTIONS, max_overflow=_MORE_CONNECTIONS
    )
    return _set_up_for_sqlite(engine, "journal_mode=WAL", "foreign_keys=ON")


def copied_engine(path: Path) -> Engine:
    """Return the engine of a database in memory that begins as a copy of a file which cannot be written."""
    engine = create_engine("sqlite://", poolclass=StaticPool, connect_args={"check_same_thread": False})
    _set_up_for_sqlite(engine, "foreign_keys=ON")
    if path.exists():
        with tempfile.TemporaryDirectory() as folder:
            for file in path.parent.glob(f"{path.name}*"):  # with its write-ahead log
                shutil.copyfile(file, Path(folder) / file.name)
            with closing(sqlite3.connect(Path(folder) / path.name)) as copy, engine.connect() as connection:
                copy.backup(connection.connection.driver_connection)  # type: ignore[arg-type]
    return engine


def postgresql_engine(url: URL) -> Engine:
    """Return the engine of a PostgreSQL database."""
    engine = create_engine(
        url,
        pool_pre_ping=True,  # the database server may have been started anew
        pool_size=_CONNECTIONS,
        max_overflow=_MORE_CONNECTIONS,
        connect_args={"connect_timeout": _CONNECT_S},
    )

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        options = connection.get_execution_options()
        if not options.get(IS_WRITING):
            connection.execute(text("SET TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY"))
        elif not options.get(IS_SYNCED):
            connection.execute(text("SET LOCAL synchronous_commit = off"))

    return engine


def _text(stored: bytes) -> str:
    """Return bytes as text, invalid UTF-8 replaced: the driver would refuse all rows of an answer for one such text."""
    return stored.decode("utf-8", "replace")


def _set_up_for_sqlite(engine: Engine, *pragmas: str) -> Engine:
    @event.listens_for(engine, "connect")
    def connect(connection: sqlite3.Connection, _: Any) -> None:  # noqa: ANN401
        connection.isolation_level = None  # the driver begins no transactions of its own
        connection.text_factory = _text
        for pragma in pragmas:
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        options = connection.get_execution_options()
        if options.get(IS_WRITING):
            connection.exec_driver_sql(f"PRAGMA synchronous={'FULL' if options.get(IS_SYNCED) else 'NORMAL'}")
            connection.exec_driver_sql("BEGIN IMMEDIATE")
        else:
            connection.exec_driver_sql("BEGIN")

    return engine


_NUMBERS = 1 << 62


class Presence:
    """The sign that this server on a PostgreSQL database is alive.

    A server holds an advisory lock with a number of its own for as long as its connection lasts, so a lock that can be
    had tells that its server has ended, however it ended.

    Attributes:
        number: the server's number.
    """

    def __init__(self, url: URL) -> None:
        """Take a number; raise `DBAPIError` if the database refuses."""
        self.number = 1 + secrets.randbelow(_NUMBERS)
        engine = create_engine(url, poolclass=NullPool, isolation_level="AUTOCOMMIT")
        self._connection = engine.connect()
        self._connection.execute(text("SELECT pg_advisory_lock(:number)"), {"number": self.number})

    def end(self) -> None:
        """Let others know that this server has ended."""
        with suppress(DBAPIError), self._connection:  # the lock of a connection that was lost is free already
            self._connection.execute(text("SELECT pg_advisory_unlock(:number)"), {"number": self.number})


def has_ended(session: Session, number: int) -> bool:
    """Return whether a server has ended; only one server learns it within a transaction."""
    if number == 0:
        return True
    lock = text("SELECT pg_try_advisory_xact_lock(:number)")
    return bool(session.scalar(lock, {"number": number}))
