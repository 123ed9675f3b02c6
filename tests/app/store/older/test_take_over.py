"""Documents and garments of the formats before the database: taken over, and their files kept as they are."""

import json
from pathlib import Path

import pytest
from pydantic_core import to_json

from app.drawing.draft import Draft
from app.drawing.drawing_json import drawing_to_dict
from app.store.data_folder import DataFolder
from app.store.database import Database
from app.store.document_errors import BrokenDocumentError, NewerDocumentError
from app.store.document_repository import DocumentRepository
from app.store.garment_repository import GarmentRepository
from app.store.older.take_over import TAKEN_OVER, take_over
from planner.cloth.garment import Garment
from tests.app.refused import refused
from tests.app.samples import towel
from tests.app.store.documents import entries
from tests.app.store.drafts import TOWEL, moved, older_file, worked_on
from tests.app.store.older.journals import put_journal


def drafts(seed: int, count: int) -> list[Draft]:
    return [draft for draft in worked_on(seed, count) if draft.gesture is None]


def put_older(tmp_path: Path, document_id: str, draft: Draft, format_: int = 1) -> Path:
    """Write a document of format 1, or one with another format number."""
    path = tmp_path / "documents" / f"{document_id}.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(older_file(document_id, 7, draft, format_))
    return path


def files_in(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_documents_and_garments_are_taken_over_once_and_their_files_are_kept(
    tmp_path: Path, database: Database, repository: DocumentRepository
) -> None:
    journal, file = drafts(5, 40), drafts(6, 30)[-1]
    put_journal(tmp_path / "documents", "abcdefgh", journal)
    put_older(tmp_path, "oldone22", file)
    (tmp_path / "documents" / ".last").write_text("oldone22")
    (tmp_path / "garments").mkdir()
    (tmp_path / "garments" / "my-towel.json").write_text(json.dumps(towel(name="my-towel")))
    before = files_in(tmp_path / "documents") | files_in(tmp_path / "garments")
    take_over(DataFolder(tmp_path), database)
    newest = repository.kept("abcdefgh")
    assert (newest.version, newest.draft.drawing, newest.draft.history) == (
        len(journal),
        journal[-1].drawing,
        journal[-1].history,
    )
    older = repository.kept("oldone22")
    assert (older.version, older.draft.drawing, older.draft.history) == (7, file.drawing, file.history)
    assert all(version.changed_at for version in repository.versions("abcdefgh")[:-1])
    assert list(repository.recent()) == ["oldone22", "abcdefgh"]
    assert GarmentRepository(database).garment("my-towel") == Garment.from_dict(towel(name="my-towel"))
    kept = tmp_path / TAKEN_OVER
    assert files_in(kept / "documents") | files_in(kept / "garments") == before
    repository.remove("oldone22")
    older_keeper = newest.keeper
    older_keeper.keep(newest.version + 1, TOWEL)
    take_over(DataFolder(tmp_path), database)
    assert [entry.id for entry in entries(repository)] == ["abcdefgh"]
    assert repository.kept("abcdefgh").draft.drawing == TOWEL.drawing


def test_files_that_a_killed_server_had_taken_over_but_not_moved_change_nothing(
    tmp_path: Path, database: Database, repository: DocumentRepository
) -> None:
    put_journal(tmp_path / "documents", "abcdefgh", drafts(5, 4))
    take_over(DataFolder(tmp_path), database)
    (tmp_path / TAKEN_OVER / "documents").rename(tmp_path / "documents")
    put_older(tmp_path, "oldone22", TOWEL)
    repository.kept("abcdefgh").keeper.keep(9, TOWEL)
    take_over(DataFolder(tmp_path), database)
    assert repository.kept("abcdefgh").version == 9
    assert repository.kept("oldone22").draft.drawing == TOWEL.drawing
    assert not (tmp_path / "documents").exists()
    assert (tmp_path / f"{TAKEN_OVER}-2" / "documents" / "abcdefgh.journal").exists()


def test_a_gesture_in_progress_and_a_chosen_start_are_taken_over(
    tmp_path: Path, database: Database, repository: DocumentRepository
) -> None:
    put_journal(tmp_path / "documents", "abcdefgh", drafts(5, 4))
    preview = {"version": 90, "label": "drag", "drawing": drawing_to_dict(moved(3))}
    (tmp_path / "documents" / "abcdefgh.preview").write_bytes(to_json(preview))
    take_over(DataFolder(tmp_path), database)
    kept = repository.kept("abcdefgh")
    assert (kept.version, kept.draft.drawing, kept.draft.history.can_undo) == (90, moved(3), "drag")


def test_a_spoilt_preview_or_start_loses_only_itself(
    tmp_path: Path, database: Database, repository: DocumentRepository
) -> None:
    last = drafts(5, 4)[-1]
    put_journal(tmp_path / "documents", "abcdefgh", drafts(5, 4))
    for ending in ("preview", "start", "head"):
        (tmp_path / "documents" / f"abcdefgh.{ending}").write_text("{")
    take_over(DataFolder(tmp_path), database)
    assert repository.kept("abcdefgh").draft.history == last.history


def test_documents_of_newer_formats_and_damaged_ones_are_told_of_and_their_files_kept(
    tmp_path: Path, database: Database, repository: DocumentRepository
) -> None:
    put_older(tmp_path, "newerabc", TOWEL, 2)
    cut = put_older(tmp_path, "newercut", TOWEL, 17)
    cut.write_bytes(cut.read_bytes()[:-40])
    (tmp_path / "documents" / "newerxyz.journal").write_bytes(b'{"format": 3, "id": "newerxyz"}\n\x00\x01')
    short = put_journal(tmp_path / "documents", "shortone", drafts(5, 9))
    short.write_bytes(short.read_bytes()[: -len(short.read_bytes()) // 3])
    spoilt = put_older(tmp_path, "spoilt22", TOWEL)
    spoilt.write_text(spoilt.read_text().replace("[0.4, 0.0]", '[0, "x"]'))
    (tmp_path / "documents" / "aside222.broken").write_bytes(b"\x00")
    put_older(tmp_path, "goodone2", TOWEL)
    before = files_in(tmp_path / "documents")
    take_over(DataFolder(tmp_path), database)
    assert files_in(tmp_path / TAKEN_OVER / "documents") == before
    problems = {entry.id: str(entry.problem) for entry in entries(repository) if entry.problem}
    for document_id, number in {"newerabc": 2, "newercut": 17, "newerxyz": 3}.items():
        assert f"format {number}" in problems.pop(document_id)
        with pytest.raises(NewerDocumentError, match=f"format {number}"):
            repository.kept(document_id)
    assert "outline[1].point[1]" in problems["spoilt22"]
    assert {"spoilt22", "shortone", "aside222"} == problems.keys()
    for document_id in problems:
        with pytest.raises(BrokenDocumentError, match=TAKEN_OVER):
            repository.kept(document_id)
        repository.remove(document_id)
    assert list(repository.recent()) == ["goodone2"]


def test_in_a_read_only_folder_documents_are_shown_and_the_files_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put_journal(tmp_path / "documents", "abcdefgh", drafts(5, 4))
    before = files_in(tmp_path)
    with refused(monkeypatch, tmp_path, "EROFS", databases_too=False):
        database = Database(tmp_path / "pleat.db")
        take_over(DataFolder(tmp_path), database)
        assert [entry.id for entry in entries(DocumentRepository(database))] == ["abcdefgh"]
        database.close()
    assert files_in(tmp_path) == before


def test_nothing_is_taken_over_where_something_fails(
    tmp_path: Path, database: Database, repository: DocumentRepository, monkeypatch: pytest.MonkeyPatch
) -> None:
    for document_id in ("aaaaaaaa", "bbbbbbbb"):
        put_journal(tmp_path / "documents", document_id, drafts(5, 4))
    before = files_in(tmp_path / "documents")

    def refuse(*_: object) -> None:
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as patched, pytest.raises(Exception, match="taken over"):
        patched.setattr("app.store.older.take_over._remember_last", refuse)
        take_over(DataFolder(tmp_path), database)
    assert files_in(tmp_path / "documents") == before
    assert entries(repository) == ()
