"""Keeps the newest traces of rehearsed runs in the database, by id."""

import logging
import uuid
from dataclasses import dataclass

from sqlalchemy import insert, select

from app.store.database import Database
from app.store.schema import TraceRow, drop_oldest
from planner.errors import FoldingError

CAPACITY, CAPACITY_BYTES = 1000, 64 << 20
"""Number of traces kept, and their size (bytes)."""

_log = logging.getLogger(__name__)


@dataclass
class UnknownTraceError(FoldingError):
    """No trace has this id, or it has been dropped."""

    trace_id: str

    def __str__(self) -> str:
        return f"there is no trace with the id {self.trace_id[:80]!r}"


class TraceStore:
    """Keeps the newest traces, packed; safe to use from any thread."""

    def __init__(self, database: Database, capacity: int = CAPACITY, capacity_bytes: int = CAPACITY_BYTES) -> None:
        """Use a database; read nothing yet."""
        self._database = database
        self._capacity, self._capacity_bytes = capacity, capacity_bytes

    def add(self, content: bytes) -> str | None:
        """Store a trace and return its id; None if the database refuses: a rehearsal is of use without its trace."""
        trace_id = uuid.uuid4().hex
        row = {"id": trace_id, "size": len(content), "content": content}
        try:
            with self._database.writing("the trace could not be kept", is_synced=False, is_lasting=False) as session:
                session.execute(insert(TraceRow), row)
                drop_oldest(session, TraceRow, self._capacity, self._capacity_bytes)
        except FoldingError as error:
            _log.warning("%s", error)
            return None
        return trace_id

    def content(self, trace_id: str) -> bytes:
        """Return the trace with this id; raise `UnknownTraceError` if there is none."""
        if "\0" in trace_id:  # PostgreSQL knows no zero character
            raise UnknownTraceError(trace_id)
        with self._database.reading("the trace could not be read") as session:
            found = session.scalar(select(TraceRow.content).where(TraceRow.id == trace_id))
        if found is None:
            raise UnknownTraceError(trace_id)
        return found
