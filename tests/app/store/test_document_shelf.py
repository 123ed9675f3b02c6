"""Documents on the disk: what is kept is what was there, whatever happens to the server."""

import json
from pathlib import Path

import pytest

from app.document import Document
from app.drawing.draft import Draft, draft_of
from app.drawing.drawing import Drawing
from app.drawing.edit import Edit, Phase
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.store.document_keeper import UnkeptDocumentError
from app.store.document_shelf import BrokenDocumentError, DocumentShelf, UnknownDocumentError
from planner.cloth.garment import Garment
from tests.app.drawing.drawings import outlined, pulled
from tests.app.samples import towel

TOWEL = draft_of(drawing_of(Garment.from_dict(towel())))


def moved(millimetres: int) -> Drawing:
    return solve(pulled(TOWEL.drawing, 0, -0.001 * millimetres, 0.0)).drawing


@pytest.fixture
def shelf(tmp_path: Path) -> DocumentShelf:
    return DocumentShelf(tmp_path / "documents")


def kept_document(shelf: DocumentShelf) -> tuple[str, Document]:
    document_id = shelf.new_id()
    keeper = shelf.keeper(document_id)
    keeper.keep(1, TOWEL)
    return document_id, Document(TOWEL, keep=keeper.keep)


def restored(shelf: DocumentShelf, document_id: str, tmp_path: Path) -> tuple[int, Draft]:
    """What a server finds that starts after this one was killed."""
    return DocumentShelf(tmp_path / "documents").kept(document_id)


def test_every_committed_change_is_there_after_the_server_was_killed(shelf: DocumentShelf, tmp_path: Path) -> None:
    document_id, document = kept_document(shelf)
    document.edit(Edit("one", moved(1)))
    document.edit(Edit("two", moved(2)))
    document.edit(Edit("spoilt", outlined(moved(2), (0.0, 0.0), (0.4, 0.3), (0.4, 0.0), (0.0, 0.3))))
    document.undo()
    version, draft = restored(shelf, document_id, tmp_path)
    assert version == document.state.version
    assert draft.drawing == document.state.drawing
    assert draft.history == document.state.draft.history


def test_what_a_gesture_had_changed_is_a_step_after_the_server_was_killed(shelf: DocumentShelf, tmp_path: Path) -> None:
    document_id, document = kept_document(shelf)
    document.edit(Edit("one", moved(1)))
    document.edit(Edit("drag", moved(2), Phase.PREVIEW))
    document.edit(Edit("drag", moved(3), Phase.PREVIEW))
    version, draft = restored(shelf, document_id, tmp_path)
    assert version == document.state.version
    assert draft.drawing == moved(3)
    assert [step.label for step in draft.history.past] == ["one", "drag"]
    assert draft.undone().drawing == moved(1)


def test_a_gesture_that_was_cancelled_or_committed_is_over_for_the_disk_too(
    shelf: DocumentShelf, tmp_path: Path
) -> None:
    document_id, document = kept_document(shelf)
    document.edit(Edit("drag", moved(1), Phase.PREVIEW))
    document.edit(Edit("", None, Phase.CANCEL))
    version, draft = restored(shelf, document_id, tmp_path)
    assert (version, draft.drawing, draft.history) == (3, TOWEL.drawing, TOWEL.history)
    document.edit(Edit("drag", moved(1), Phase.PREVIEW))
    document.edit(Edit("drag", moved(2), Phase.COMMIT))
    version, draft = restored(shelf, document_id, tmp_path)
    assert (version, draft.drawing, draft.history.can_undo) == (5, moved(2), "drag")


def test_a_gesture_that_another_closed_is_kept_as_its_step(shelf: DocumentShelf, tmp_path: Path) -> None:
    document_id, document = kept_document(shelf)
    document.edit(Edit("first", moved(1), Phase.PREVIEW, gesture="1"))
    document.edit(Edit("second", moved(2), Phase.PREVIEW, gesture="2"))
    _, draft = restored(shelf, document_id, tmp_path)
    assert [step.label for step in draft.history.past] == ["first", "second"]
    assert draft.undone().drawing == moved(1)


def test_a_server_that_was_killed_while_it_wrote_leaves_the_old_file_and_no_rubbish(
    shelf: DocumentShelf, tmp_path: Path
) -> None:
    document_id, document = kept_document(shelf)
    document.edit(Edit("one", moved(1)))
    half_written = tmp_path / "documents" / f".{document_id}-abcd"
    half_written.write_text("{")
    assert restored(shelf, document_id, tmp_path)[1].drawing == moved(1)
    assert not half_written.exists()


@pytest.mark.parametrize("content", ["", "{", "[]", "null", '{"format": 2}', "\x00" * 100, "[" * 100_000])
def test_a_spoilt_file_is_put_aside_and_told_of_and_the_others_are_read(
    shelf: DocumentShelf, tmp_path: Path, content: str
) -> None:
    good, _ = kept_document(shelf)
    spoilt, _ = kept_document(shelf)
    path = tmp_path / "documents" / f"{spoilt}.json"
    path.write_text(content)
    with pytest.raises(BrokenDocumentError, match=f"{spoilt}.broken"):
        shelf.kept(spoilt)
    assert (tmp_path / "documents" / f"{spoilt}.broken").read_text() == content
    entries = shelf.entries()
    assert [entry.id for entry in entries] == [good, spoilt]
    assert entries[0].problem is None
    assert entries[1].problem is not None and "broken" in entries[1].problem
    assert shelf.recent() == [good]
    with pytest.raises(BrokenDocumentError):
        shelf.kept(spoilt)
    shelf.remove(spoilt)
    assert [entry.id for entry in shelf.entries()] == [good]


def test_a_spoilt_drawing_within_a_good_file_is_told_of_by_its_field(shelf: DocumentShelf, tmp_path: Path) -> None:
    document_id, _ = kept_document(shelf)
    path = tmp_path / "documents" / f"{document_id}.json"
    data = json.loads(path.read_text())
    data["drawing"]["outline"][1]["point"] = [0, "x"]
    path.write_text(json.dumps(data))
    with pytest.raises(BrokenDocumentError, match=r"outline\[1\]\.point\[1\]"):
        shelf.kept(document_id)


def test_a_spoilt_preview_loses_only_itself(shelf: DocumentShelf, tmp_path: Path) -> None:
    document_id, document = kept_document(shelf)
    document.edit(Edit("one", moved(1)))
    (tmp_path / "documents" / f"{document_id}.preview").write_text("{")
    assert restored(shelf, document_id, tmp_path)[1].drawing == moved(1)


def test_the_list_has_the_one_changed_last_first(shelf: DocumentShelf) -> None:
    first, changed = kept_document(shelf)
    second, _ = kept_document(shelf)
    shelf.remember_last(second)
    assert shelf.recent() == [second, first]
    changed.edit(Edit("one", moved(1)))
    assert {entry.id for entry in shelf.entries()} == {first, second}
    assert shelf.entries()[0].title == "My towel"


def test_ids_are_short_and_fit_into_an_address(shelf: DocumentShelf) -> None:
    ids = {shelf.new_id() for _ in range(100)}
    assert len(ids) == 100
    assert all(len(document_id) == 8 and document_id.isalnum() for document_id in ids)


@pytest.mark.parametrize("document_id", ["../../x", "", "abcdefgh", "ABCDEFGH", ".last", "a" * 300, "\x00"])
def test_what_is_no_document_is_unknown(shelf: DocumentShelf, document_id: str) -> None:
    for ask in (shelf.kept, shelf.remove):
        with pytest.raises(UnknownDocumentError):
            ask(document_id)


def test_a_change_that_cannot_be_written_says_so_and_is_not_made(shelf: DocumentShelf, tmp_path: Path) -> None:
    _, document = kept_document(shelf)
    folder = tmp_path / "documents"
    folder.rename(tmp_path / "elsewhere")
    folder.write_text("in the way")
    with pytest.raises(UnkeptDocumentError, match="not made"):
        document.edit(Edit("one", moved(1)))
    assert document.state.drawing == TOWEL.drawing
