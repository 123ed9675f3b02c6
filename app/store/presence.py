"""Which servers on a PostgreSQL database are alive.

A server holds an advisory lock with a number of its own for as long as its connection lasts, so a lock that can be had
tells that its server has ended, however it ended.
"""

import secrets
from contextlib import suppress

from sqlalchemy import URL, NullPool, create_engine, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

_NUMBERS = 1 << 62


class Presence:
    """The sign that this server is alive.

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
