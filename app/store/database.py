"""The server's database, migrated to this version's tables when it is first used.

By default it is an SQLite file in the data folder, with a write-ahead log: readers do not wait for a writer. A URL
names a PostgreSQL server instead, which several servers of Pleat may share. What is committed survives a kill and,
unless a caller says otherwise, a power failure. Where the folder cannot be written, the database is a copy in memory,
which ends with the server.
"""

import logging
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine, make_url, select, text
from sqlalchemy.exc import ArgumentError, DBAPIError
from sqlalchemy.orm import Session

from app.distribution import require
from app.store.database_error import database_error
from app.store.engines import IS_SYNCED, IS_WRITING, Presence, copied_engine, postgresql_engine, sqlite_engine
from app.store.schema import Table
from app.store.storage_error import ForbiddenStorageError, StorageError, storing
from planner.errors import FoldingError

_MIGRATIONS = Path(__file__).parent / "migrations"
_POSTGRESQL, _DRIVER = "postgresql", "psycopg"

_log = logging.getLogger(__name__)


@dataclass
class OtherDatabaseError(FoldingError):
    """Another version of Pleat has made the tables, from which no migration leads to this one's."""

    where: str

    def __str__(self) -> str:
        return f"{self.where} belongs to another version of Pleat; use that one, or another database"


class BadDatabaseUrlError(FoldingError):
    """A URL names no database that can be used."""

    def __str__(self) -> str:
        return "the database must be a URL as in postgresql+psycopg://user@host/name; leave it out for SQLite"


class Database:
    """The database of a server; safe to use from any thread.

    Attributes:
        path: the file of an SQLite database; None if a URL names another one.
        is_copy: whether it is a copy in memory, since the folder cannot be written; known after the first use.
    """

    def __init__(self, path: Path, url: str | None = None) -> None:
        """Describe the database; open nothing yet.

        Args:
            path: the SQLite file to use without a URL.
            url: a PostgreSQL database.

        Raises:
            BadDatabaseUrlError: the URL names no such database.
            RequestError: PostgreSQL's library is not installed.
        """
        self.path = path if url is None else None
        self._url = None
        if url is not None:
            try:
                self._url = make_url(url)
            except (ArgumentError, ValueError):  # the latter for a port that is no number
                raise BadDatabaseUrlError from None
            if self._url.get_backend_name() != _POSTGRESQL:
                raise BadDatabaseUrlError
            require(_DRIVER)
            self._url = self._url.set(drivername=f"{_POSTGRESQL}+{_DRIVER}")
        self._engine: Engine | None = None
        self._engines: dict[bool | None, Engine] = {}
        self.is_copy = False
        self._opened_file: int | None = None
        self._presence: Presence | None = None
        self._lock = threading.Lock()

    @property
    def is_shared(self) -> bool:
        """Whether other servers may use it at the same time."""
        return self.path is None

    @contextmanager
    def reading(self, what: str) -> Iterator[Session]:
        """Yield a session that sees one moment of the database and changes nothing.

        Args:
            what: the operation, as the beginning of an error's sentence.

        Raises:
            StorageError: the system or the database refuses.
            OtherDatabaseError: another version of Pleat has made the tables.
        """
        with self._session(what, None) as session:
            yield session

    @contextmanager
    def writing(self, what: str, *, is_synced: bool = True, is_lasting: bool = True) -> Iterator[Session]:
        """Yield a session for changes; commit at the end, or roll back if an error is raised.

        Args:
            what: the operation, as the beginning of an error's sentence.
            is_synced: whether the changes are on the disk afterwards, so that they survive a power failure; otherwise
                they survive only the end of this process.
            is_lasting: whether to refuse changes that would end with the server.

        Raises:
            StorageError: the system or the database refuses.
            OtherDatabaseError: another version of Pleat has made the tables.
        """
        with self._session(what, is_synced) as session:
            if is_lasting and self.is_copy:
                raise ForbiddenStorageError(what, "the data folder is read-only")
            yield session

    @property
    def number(self) -> int:
        """The number by which other servers on the database know this one; 0 if there are no others."""
        with self._lock:
            if self._url is not None and self._presence is None:
                self._presence = Presence(self._url)
        return 0 if self._presence is None else self._presence.number

    def problem(self) -> str | None:
        """Return why the database cannot be read and written; None if it can.

        Every table is looked at, and a row is written over with what it is.
        """
        try:
            with self.writing("the database does not answer", is_synced=False, is_lasting=False) as session:
                for table in Table.metadata.sorted_tables:
                    session.execute(select(*table.primary_key).limit(1))
                session.execute(text("UPDATE alembic_version SET version_num = version_num"))
        except FoldingError as error:
            return str(error)
        return None

    def engine(self) -> Engine:
        """Return the engine, for work on whole tables; the first call migrates them.

        Raises:
            DBAPIError: the database refuses.
            OtherDatabaseError: another version of Pleat has made the tables.
        """
        with self._lock:
            if self._engine is None:
                engine = self._new_engine()
                try:
                    self._migrate(engine)
                except BaseException:
                    engine.dispose()
                    raise
                for is_synced in (True, False):
                    self._engines[is_synced] = engine.execution_options(**{IS_WRITING: True, IS_SYNCED: is_synced})
                self._engine = engine
                self._opened_file = self._file()
            return self._engine

    def close(self) -> None:
        """Close all connections."""
        with self._lock:
            if self._engine is not None:
                self._engine.dispose()
                self._engine = None
                self._engines.clear()
            if self._presence is not None:
                self._presence.end()
                self._presence = None

    @contextmanager
    def _session(self, what: str, is_synced: bool | None) -> Iterator[Session]:
        try:
            with storing(what):
                engine = self.engine()
            if is_synced is not None and self._file() != self._opened_file:
                raise StorageError(what, "the database's file was removed or replaced")
            with Session(self._engines.get(is_synced, engine), expire_on_commit=False) as session, session.begin():
                yield session
        except DBAPIError as error:
            raise database_error(what, error, None if self.path is None else self.path.parent) from error

    def _file(self) -> int | None:
        """Return the number of the SQLite file that has the name now: SQLite goes on with one that has lost it."""
        try:
            return None if self.path is None or self.is_copy else self.path.stat().st_ino
        except FileNotFoundError:
            return None

    def _new_engine(self) -> Engine:
        if self._url is not None:
            return postgresql_engine(self._url)
        assert self.path is not None
        folder = self.path.parent
        self.is_copy = folder.exists() and not os.access(folder, os.W_OK)
        if not self.is_copy:
            folder.mkdir(parents=True, exist_ok=True)
            return sqlite_engine(self.path)
        _log.warning("%s cannot be written: changes are kept in memory and end with the server", folder)
        return copied_engine(self.path)

    def _migrate(self, engine: Engine) -> None:
        """Lead the tables to this version's."""
        from alembic.command import upgrade  # here, because this import takes a quarter of a second
        from alembic.config import Config
        from alembic.util import CommandError

        config = Config()
        config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
        with engine.execution_options(**{IS_WRITING: True, IS_SYNCED: True}).begin() as connection:
            if engine.dialect.name == _POSTGRESQL:  # two servers may start at the same moment
                connection.execute(text("SELECT pg_advisory_xact_lock(hashtext('pleat migrations'))"))
            config.attributes["connection"] = connection
            try:
                upgrade(config, "head")
            except CommandError:
                raise OtherDatabaseError(str(self.path or "the database")) from None
