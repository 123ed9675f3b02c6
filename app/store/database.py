"""The database in the data folder, migrated to this version's tables when it is first used.

SQLite with a write-ahead log: readers do not wait for a writer, and what is committed survives a kill and a power
failure (`synchronous=FULL`). Where the folder cannot be written, the database is in memory and ends with the server.
"""

import logging
import os
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, create_engine, event, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session
from sqlalchemy.pool import StaticPool

from app.store.storage_error import ForbiddenStorageError, FullStorageError, StorageError
from planner.errors import FoldingError

_MIGRATIONS = Path(__file__).parent / "migrations"
_FORBIDDEN = frozenset({sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM})
_BUSY_S = 5.0
"""Time to wait for another connection's transaction (s)."""

_MAIN_CODE = 0xFF
"""The bits of an SQLite error code that are the same for its variants."""

_log = logging.getLogger(__name__)


@dataclass
class NewerDatabaseError(FoldingError):
    """A newer version of Pleat has changed the tables."""

    path: Path

    def __str__(self) -> str:
        return f"{self.path} belongs to a newer version of Pleat; use that one, or another data folder"


class Database:
    """The database of a server; safe to use from any thread."""

    def __init__(self, path: Path) -> None:
        """Describe the database; open nothing yet."""
        self.path = path
        self._engine: Engine | None = None
        self._lock = threading.Lock()

    @contextmanager
    def session(self, what: str) -> Iterator[Session]:
        """Yield a session; commit at the end, or roll back if an error is raised.

        Args:
            what: the operation, as the beginning of an error's sentence.

        Raises:
            StorageError: the system or the database refuses.
            NewerDatabaseError: a newer version of Pleat has changed the tables.
        """
        try:
            with Session(self._opened(), expire_on_commit=False) as session, session.begin():
                yield session
        except DBAPIError as error:
            raise _storage_error(what, error) from error

    def problem(self) -> str | None:
        """Return why the database does not answer; None if it does."""
        try:
            with self.session("the database does not answer") as session:
                session.execute(text("SELECT 1"))
        except FoldingError as error:
            return str(error)
        return None

    def close(self) -> None:
        """Close all connections."""
        with self._lock:
            if self._engine is not None:
                self._engine.dispose()
                self._engine = None

    def _opened(self) -> Engine:
        with self._lock:
            if self._engine is None:
                engine = self._engine_here()
                try:
                    _migrate(engine, self.path)
                except BaseException:
                    engine.dispose()
                    raise
                self._engine = engine
            return self._engine

    def _engine_here(self) -> Engine:
        if not self.path.parent.exists() or os.access(self.path.parent, os.W_OK):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            engine = create_engine(f"sqlite:///{self.path}", connect_args={"timeout": _BUSY_S})
            event.listen(engine, "connect", _set_up)
            return engine
        _log.warning("%s cannot be written: jobs are kept in memory and end with the server", self.path.parent)
        return create_engine("sqlite://", poolclass=StaticPool, connect_args={"check_same_thread": False})


def _set_up(connection: sqlite3.Connection, _: Any) -> None:  # noqa: ANN401
    """Make a new connection durable and tolerant of others."""
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
        connection.execute(f"PRAGMA {pragma}")


def _migrate(engine: Engine, path: Path) -> None:
    """Lead the tables to this version's."""
    from alembic.command import upgrade  # here, because this import takes a quarter of a second
    from alembic.config import Config
    from alembic.util import CommandError

    config = Config()
    config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        try:
            upgrade(config, "head")
        except CommandError:
            raise NewerDatabaseError(path) from None


def _storage_error(what: str, error: DBAPIError) -> StorageError:
    why = str(error.orig)
    code = getattr(error.orig, "sqlite_errorcode", 0) & _MAIN_CODE
    if code == sqlite3.SQLITE_FULL:
        return FullStorageError(what, why)
    return ForbiddenStorageError(what, why) if code in _FORBIDDEN else StorageError(what, why)
