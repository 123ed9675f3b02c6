"""Documents in the database: what is kept is what was there, whatever happens to the server."""

import json
import sqlite3
from contextlib import closing, suppress
from dataclasses import asdict, replace
from pathlib import Path

import pytest
from sqlalchemy import delete, func, select, update

from app.drawing import history
from app.drawing.curve import Curve
from app.drawing.edit import Edit, Phase, StaleVersionError
from app.store.database import Database
from app.store.document_errors import BrokenDocumentError, NewerDocumentError, UnknownDocumentError
from app.store.document_keeper import FORMAT
from app.store.document_repository import DocumentEntry, DocumentRepository
from app.store.schema import DocumentRow, StepRow
from app.store.storage_error import StorageError
from tests.app.drawing.drawings import outlined
from tests.app.store.documents import entries, kept_document, reopened, restored
from tests.app.store.drafts import TOWEL, moved, worked_on


def test_every_committed_change_is_there_after_the_server_was_killed(repository: DocumentRepository) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    document.edit(Edit("two", moved(2)))
    document.edit(Edit("spoilt", outlined(moved(2), (0.0, 0.0), (0.4, 0.3), (0.4, 0.0), (0.0, 0.3))))
    document.undo()
    version, draft = restored(repository, document_id)
    assert version == document.state.version
    assert draft.drawing == document.state.drawing
    assert draft.history == document.state.draft.history


def test_what_a_gesture_had_changed_is_a_step_after_the_server_was_killed(repository: DocumentRepository) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    document.edit(Edit("drag", moved(2), Phase.PREVIEW))
    document.edit(Edit("drag", moved(3), Phase.PREVIEW))
    version, draft = restored(repository, document_id)
    assert version == document.state.version
    assert draft.drawing == moved(3)
    assert [step.label for step in draft.history.past] == ["one", "drag"]
    assert draft.undone().drawing == moved(1)


def test_a_gesture_that_was_cancelled_or_committed_is_over_for_the_disk_too(repository: DocumentRepository) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("drag", moved(1), Phase.PREVIEW))
    document.edit(Edit("", None, Phase.CANCEL))
    version, draft = restored(repository, document_id)
    assert (version, draft.drawing, draft.history) == (3, TOWEL.drawing, TOWEL.history)
    document.edit(Edit("drag", moved(1), Phase.PREVIEW))
    document.edit(Edit("drag", moved(2), Phase.COMMIT))
    version, draft = restored(repository, document_id)
    assert (version, draft.drawing, draft.history.can_undo) == (5, moved(2), "drag")


def test_a_gesture_that_another_closed_is_kept_as_its_step(repository: DocumentRepository, tmp_path: Path) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("first", moved(1), Phase.PREVIEW, gesture="1"))
    document.edit(Edit("second", moved(2), Phase.PREVIEW, gesture="2"))
    _, draft = restored(repository, document_id)
    assert [step.label for step in draft.history.past] == ["first", "second"]
    assert draft.undone().drawing == moved(1)


@pytest.mark.parametrize("drawing", ["", "{", "[]", "null", '{"outline": 1}', "[" * 100_000])
def test_a_spoilt_document_is_told_of_and_left_alone_and_the_others_are_read(
    database: Database, repository: DocumentRepository, drawing: str
) -> None:
    good, _ = kept_document(repository)
    spoilt, _ = kept_document(repository)
    with database.writing("spoil") as session:
        session.execute(update(StepRow).where(StepRow.document_id == spoilt).values(drawing=drawing))
    with pytest.raises(BrokenDocumentError, match=spoilt):
        repository.kept(spoilt)
    assert {entry.id for entry in entries(repository)} == {good, spoilt}
    assert repository.kept(good).draft.drawing == TOWEL.drawing
    repository.remove(spoilt)
    assert [entry.id for entry in entries(repository)] == [good]


def test_a_document_of_which_steps_are_missing_does_not_look_well(
    database: Database, repository: DocumentRepository
) -> None:
    document_id, document = kept_document(repository)
    for number in (1, 2):
        document.edit(Edit("Move", moved(number)))
    with database.writing("spoil") as session:
        session.execute(delete(StepRow).where(StepRow.number == 2))
    with pytest.raises(BrokenDocumentError, match="missing"):
        repository.kept(document_id)
    assert "missing" in str(entries(repository)[0].problem)


def test_a_document_of_a_newer_format_is_refused_by_its_number(
    database: Database, repository: DocumentRepository
) -> None:
    document_id, _ = kept_document(repository)
    with database.writing("age") as session:
        session.execute(update(DocumentRow).values(format=FORMAT + 1))
    for ask in (repository.kept, repository.versions):
        with pytest.raises(NewerDocumentError, match=f"format {FORMAT + 1}"):
            ask(document_id)
    assert f"format {FORMAT + 1}" in str(entries(repository)[0].problem)
    assert list(repository.recent()) == []


def test_only_a_document_with_curves_has_the_format_that_knows_them(
    database: Database, repository: DocumentRepository
) -> None:
    """A version that knows no curves goes on reading all others."""
    document_id, document = kept_document(repository)

    def number() -> int:
        with database.reading("look") as session:
            return session.execute(select(DocumentRow.format).where(DocumentRow.id == document_id)).scalar_one()

    document.edit(Edit("one", moved(1)))
    assert number() == FORMAT - 1
    outline = tuple(replace(corner, curve=Curve(0.0, 0.1)) for corner in moved(1).outline)
    document.edit(Edit("Bend edge", replace(moved(1), outline=outline)))
    assert number() == FORMAT
    _, draft = restored(repository, document_id)
    assert draft.drawing.outline == outline
    document.undo()
    assert number() == FORMAT  # to redo the step is a curve again


@pytest.mark.parametrize("size", [1, 3, 7])
def test_the_pages_have_all_documents_once_the_one_changed_last_first(
    database: Database, repository: DocumentRepository, size: int
) -> None:
    ids = [kept_document(repository)[0] for _ in range(7)]
    with database.writing("age") as session:
        for number, document_id in enumerate(ids):
            changed_at = f"2026-01-0{1 + number % 3}"
            session.execute(update(DocumentRow).where(DocumentRow.id == document_id).values(changed_at=changed_at))
    shown: list[DocumentEntry] = []
    page = repository.page(None, size)
    while page.end is not None:
        assert len(page.entries) == size
        shown += page.entries
        page = repository.page(page.end, size)
    shown += page.entries
    assert sorted(entry.id for entry in shown) == sorted(ids)
    assert [entry.changed_at for entry in shown] == sorted((entry.changed_at for entry in shown), reverse=True)
    assert all(entry.picture is not None and len(entry.picture.outline) == 4 for entry in shown)


@pytest.mark.parametrize(
    ("table", "column", "value"),
    [
        ("documents", "format", "x"),
        ("documents", "title", b"\xff\xfe"),
        ("documents", "changed_at", b"\x00"),
        ("documents", "first", "none"),
        ("document_steps", "drawing", "[1e999"),
        ("document_steps", "drawing", '{"outline": [{"point": [1e999, NaN]}], "folds": []}'),
        ("document_steps", "drawing", b"\xff"),
        ("document_steps", "number", "x"),
    ],
)
def test_a_damaged_row_is_told_of_and_hides_no_other_document(
    tmp_path: Path, table: str, column: str, value: object
) -> None:
    database = Database(tmp_path / "pleat.db")
    repository = DocumentRepository(database)
    bad, good = kept_document(repository)[0], kept_document(repository)[0]
    with closing(sqlite3.connect(tmp_path / "pleat.db")) as other:
        key = "id" if table == "documents" else "document_id"
        other.execute("PRAGMA ignore_check_constraints = ON")
        other.execute(f"UPDATE {table} SET {column} = CAST(? AS TEXT) WHERE {key} = ?", (value, bad))
        other.commit()
    found = {entry.id: entry for entry in entries(repository)}
    assert found.keys() == {bad, good} and found[good].problem is None
    json.dumps([asdict(entry) for entry in found.values()], allow_nan=False)
    assert good in repository.recent()
    repository.kept(good)
    with suppress(BrokenDocumentError):
        repository.kept(bad)
    database.close()


def test_the_list_has_the_one_changed_last_first(repository: DocumentRepository) -> None:
    first, changed = kept_document(repository)
    second, _ = kept_document(repository)
    repository.remember_last(second)
    assert list(repository.recent()) == [second, first]
    changed.edit(Edit("one", moved(1)))
    assert [entry.id for entry in entries(repository)] == [first, second]
    assert entries(repository)[0].title == "My towel"


def test_ids_are_short_and_fit_into_an_address(repository: DocumentRepository) -> None:
    ids = {repository.new_id() for _ in range(100)}
    assert len(ids) == 100
    assert all(len(document_id) == 8 and document_id.isalnum() for document_id in ids)


@pytest.mark.parametrize("document_id", ["../../x", "", "abcdefgh", "ABCDEFGH", ".last", "a" * 300, "\x00"])
def test_what_is_no_document_is_unknown(repository: DocumentRepository, document_id: str) -> None:
    for ask in (repository.kept, repository.remove):
        with pytest.raises(UnknownDocumentError):
            ask(document_id)


def test_a_change_that_cannot_be_written_says_so_and_is_not_made(tmp_path: Path) -> None:
    repository = DocumentRepository(Database(tmp_path / "pleat.db"))
    _, document = kept_document(repository)
    (tmp_path / "pleat.db").rename(tmp_path / "elsewhere")
    with pytest.raises(StorageError, match="not made"):
        document.edit(Edit("one", moved(1)))
    assert document.state.drawing == TOWEL.drawing


def test_no_more_steps_are_kept_than_can_be_undone(
    database: Database, repository: DocumentRepository, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(history, "STEPS_MAX", 10)
    document_id, document = kept_document(repository)
    for number in range(25):
        document.edit(Edit("Move", moved(1 + number % 7)))
    with database.reading("count") as session:
        assert session.scalar(select(func.count()).select_from(StepRow)) == 10 + 1
    assert restored(repository, document_id)[1].history == document.state.draft.history


@pytest.mark.parametrize("seed", range(4))
def test_what_is_saved_is_the_history_after_any_work(repository: DocumentRepository, seed: int) -> None:
    keeper = repository.keeper("abcdefgh")
    for version, draft in enumerate(worked_on(seed, 40), 1):
        keeper.keep(version, draft)
        if draft.gesture is None:
            found_version, found = restored(repository, "abcdefgh")
            assert (found_version, found.drawing, found.history) == (version, draft.drawing, draft.history)


def test_of_two_servers_that_change_a_document_the_slower_one_follows(repository: DocumentRepository) -> None:
    document_id, _ = kept_document(repository)
    quick, slow = reopened(repository, document_id), reopened(repository, document_id)
    quick.edit(Edit("one", moved(1)))
    quick.edit(Edit("two", moved(2)))
    with pytest.raises(StaleVersionError):
        slow.edit(Edit("mine", moved(5), base_version=1))
    assert (slow.state.version, slow.state.drawing) == (3, moved(2))
    slow.undo()
    with pytest.raises(StaleVersionError):
        quick.edit(Edit("three", moved(3)))
    assert quick.state.drawing == moved(1)
    assert quick.state.version > 3, "its pages have seen version 3"
    quick.edit(Edit("three", moved(3)))
    with pytest.raises(StaleVersionError):
        slow.undo()
    assert slow.state.draft.history == quick.state.draft.history == restored(repository, document_id)[1].history


def test_a_document_that_another_server_has_removed_cannot_be_changed(repository: DocumentRepository) -> None:
    document_id, document = kept_document(repository)
    repository.remove(document_id)
    with pytest.raises(UnknownDocumentError):
        document.edit(Edit("one", moved(1)))
    with pytest.raises(UnknownDocumentError):
        repository.remove(document_id)


def test_labels_and_titles_may_have_any_character(repository: DocumentRepository) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("zero \x00, \u20ac, \U0001f9e6", replace(moved(1), title="\x00")))
    assert restored(repository, document_id)[1].drawing.title == "\x00"
    assert "\U0001f9e6" in str(restored(repository, document_id)[1].history.can_undo)
