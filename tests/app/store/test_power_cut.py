"""After a power cut at any moment every edit is there that was acknowledged."""

import random
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from sqlalchemy import Engine, event

from app.document import Document
from app.drawing.edit import Edit, Phase
from app.store.database import Database
from app.store.document_errors import UnknownDocumentError
from app.store.document_repository import DocumentRepository
from tests.app.store.drafts import TOWEL, moved
from tests.app.store.power import Acknowledged, Event, cut, written_by

ID = "abcd2345"
EDITS = 40
CUTS = 100
_DRAWINGS = [moved(millimetres) for millimetres in range(1, 8)]


@contextmanager
def noted(statements: list[str | Acknowledged]) -> Iterator[None]:
    """Note every statement that a database carries out, with its values."""
    connections = set()

    def connect(connection: sqlite3.Connection, _: object) -> None:
        connections.add(connection)
        connection.set_trace_callback(statements.append)

    event.listen(Engine, "connect", connect)
    try:
        yield
    finally:
        event.remove(Engine, "connect", connect)
    assert len(connections) == 1  # otherwise their order would be lost


@cache
def session() -> tuple[str | Acknowledged, ...]:
    """Return what a database carries out while a document is edited, and when commits are acknowledged."""
    statements: list[str | Acknowledged] = []
    with TemporaryDirectory() as folder, noted(statements):
        database = Database(Path(folder) / "pleat.db")
        keeper = DocumentRepository(database).keeper(ID)
        keeper.keep(1, TOWEL)
        statements.append(Acknowledged(1))
        document = Document(TOWEL, keep=keeper.keep)
        for number in range(EDITS):
            if number % 3 == 1:
                preview = Edit("Drag", _DRAWINGS[number % 7], Phase.PREVIEW, gesture=str(number))
                document.edit(preview)  # not acknowledged as kept: it survives the process, not the power
            drawing = _DRAWINGS[document.state.version % 7]
            gesture = str(number) if number % 3 == 1 else None
            state = document.edit(Edit(f"edit {number}", drawing, gesture=gesture))
            statements.append(Acknowledged(state.version))
        database.close()
    return tuple(statements)


def lost(events: list[Event], rng: random.Random, folder: Path) -> list[str]:
    """Return what is wrong after cuts at random moments since the first acknowledgement."""
    first = next(number for number, event in enumerate(events) if isinstance(event, Acknowledged))
    wrong = []
    for number in range(CUTS):
        data = folder / str(number)
        data.mkdir()
        at = rng.randrange(first + 1, len(events) + 1)
        acknowledged = cut(events[:at], data, rng)
        database = Database(data / "pleat.db")
        try:
            kept = DocumentRepository(database).kept(ID)
            assert kept.draft.drawing in (TOWEL.drawing, *_DRAWINGS)
            version = kept.version
        except UnknownDocumentError:
            version = 0
        finally:
            database.close()
        if version < acknowledged:
            wrong.append(f"cut {at}: version {version} of {acknowledged}")
    return wrong


@pytest.fixture
def events(tmp_path: Path, request: pytest.FixtureRequest) -> list[Event]:
    """Return what happens to the files in a session, synced as the store does or less."""
    setting: str = request.param
    statements = [
        one if isinstance(one, Acknowledged) else one.replace("synchronous=FULL", setting) for one in session()
    ]
    return written_by(statements, tmp_path)


@pytest.mark.parametrize("events", ["synchronous=FULL"], indirect=True)
def test_no_acknowledged_edit_is_lost_by_a_power_cut(events: list[Event], tmp_path: Path) -> None:
    assert lost(events, random.Random(1), tmp_path) == []


@pytest.mark.long
@pytest.mark.parametrize("events", ["synchronous=NORMAL"], indirect=True)
def test_with_fewer_syncs_edits_would_be_lost(events: list[Event], tmp_path: Path) -> None:
    assert lost(events, random.Random(1), tmp_path) != []
