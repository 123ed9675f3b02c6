"""Traces of rehearsed runs stored by id: the newest can be read."""

from pathlib import Path

import pytest

from app.store.database import Database
from app.store.trace_store import TraceStore, UnknownTraceError
from tests.app.refused import refused


def test_a_trace_is_read_as_it_was_after_a_restart_too(database: Database) -> None:
    kept = TraceStore(database).add(b"\x00\xff trace")
    assert kept is not None
    assert TraceStore(database).content(kept) == b"\x00\xff trace"
    for unknown in ("unknown", "", "\0", "x" * 1000):
        with pytest.raises(UnknownTraceError):
            TraceStore(database).content(unknown)


def test_the_oldest_are_dropped_beyond_a_number_and_beyond_a_size(database: Database) -> None:
    for store in (TraceStore(database, capacity=2), TraceStore(database, capacity_bytes=2000)):
        ids = [store.add(bytes(900)) for _ in range(3)]
        assert None not in ids
        with pytest.raises(UnknownTraceError):
            store.content(str(ids[0]))
        for kept in ids[1:]:
            assert len(store.content(str(kept))) == 900


def test_where_the_database_refuses_a_rehearsal_goes_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    database = Database(tmp_path / "pleat.db")
    store = TraceStore(database)
    assert store.add(b"one")
    with refused(monkeypatch, tmp_path, "ENOSPC"):
        assert store.add(b"two") is None
    database.close()
