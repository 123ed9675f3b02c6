"""Documents on the disk: what is kept is what was there, whatever happens to the server."""

import itertools
import shutil
from pathlib import Path

import pytest

from app.document import Document
from app.drawing.edit import Edit, Phase
from app.store.document_files import UnknownDocumentError
from app.store.document_reader import BrokenDocumentError
from app.store.document_repository import DocumentRepository
from app.store.storage_error import StorageError
from tests.app.drawing.drawings import outlined
from tests.app.store.documents import entries, kept_document, restored
from tests.app.store.drafts import TOWEL, moved


def test_every_committed_change_is_there_after_the_server_was_killed(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    document.edit(Edit("two", moved(2)))
    document.edit(Edit("spoilt", outlined(moved(2), (0.0, 0.0), (0.4, 0.3), (0.4, 0.0), (0.0, 0.3))))
    document.undo()
    version, draft = restored(repository, document_id, tmp_path)
    assert version == document.state.version
    assert draft.drawing == document.state.drawing
    assert draft.history == document.state.draft.history


def test_what_a_gesture_had_changed_is_a_step_after_the_server_was_killed(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    document.edit(Edit("drag", moved(2), Phase.PREVIEW))
    document.edit(Edit("drag", moved(3), Phase.PREVIEW))
    version, draft = restored(repository, document_id, tmp_path)
    assert version == document.state.version
    assert draft.drawing == moved(3)
    assert [step.label for step in draft.history.past] == ["one", "drag"]
    assert draft.undone().drawing == moved(1)


def test_a_gesture_that_was_cancelled_or_committed_is_over_for_the_disk_too(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("drag", moved(1), Phase.PREVIEW))
    document.edit(Edit("", None, Phase.CANCEL))
    version, draft = restored(repository, document_id, tmp_path)
    assert (version, draft.drawing, draft.history) == (3, TOWEL.drawing, TOWEL.history)
    document.edit(Edit("drag", moved(1), Phase.PREVIEW))
    document.edit(Edit("drag", moved(2), Phase.COMMIT))
    version, draft = restored(repository, document_id, tmp_path)
    assert (version, draft.drawing, draft.history.can_undo) == (5, moved(2), "drag")


def test_a_gesture_that_another_closed_is_kept_as_its_step(repository: DocumentRepository, tmp_path: Path) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("first", moved(1), Phase.PREVIEW, gesture="1"))
    document.edit(Edit("second", moved(2), Phase.PREVIEW, gesture="2"))
    _, draft = restored(repository, document_id, tmp_path)
    assert [step.label for step in draft.history.past] == ["first", "second"]
    assert draft.undone().drawing == moved(1)


def test_a_server_that_was_killed_while_it_wrote_leaves_the_old_file_and_no_rubbish(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    half_written = tmp_path / "documents" / f".{document_id}-abcd"
    half_written.write_text("{")
    assert restored(repository, document_id, tmp_path)[1].drawing == moved(1)
    assert not half_written.exists()


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "null", '{"format": 2}', '{"format": "3"}', "\x00" * 100, "[" * 100_000]
)
def test_a_spoilt_file_is_put_aside_and_told_of_and_the_others_are_read(
    repository: DocumentRepository, tmp_path: Path, content: str
) -> None:
    good, _ = kept_document(repository)
    spoilt, _ = kept_document(repository)
    path = tmp_path / "documents" / f"{spoilt}.journal"
    path.write_text(content)
    with pytest.raises(BrokenDocumentError, match=f"{spoilt}.broken"):
        repository.kept(spoilt)
    assert (tmp_path / "documents" / f"{spoilt}.broken").read_text() == content
    shown = entries(repository)
    assert [entry.id for entry in shown] == [good, spoilt]
    assert shown[0].problem is None
    assert shown[1].problem is not None and "broken" in shown[1].problem
    assert list(repository.recent()) == [good]
    with pytest.raises(BrokenDocumentError):
        repository.kept(spoilt)
    repository.remove(spoilt)
    assert [entry.id for entry in entries(repository)] == [good]


def test_a_spoilt_preview_loses_only_itself(repository: DocumentRepository, tmp_path: Path) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    (tmp_path / "documents" / f"{document_id}.preview").write_text("{")
    assert restored(repository, document_id, tmp_path)[1].drawing == moved(1)


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


def test_a_change_that_cannot_be_written_says_so_and_is_not_made(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    _, document = kept_document(repository)
    folder = tmp_path / "documents"
    folder.rename(tmp_path / "elsewhere")
    folder.write_text("in the way")
    with pytest.raises(StorageError, match="not made"):
        document.edit(Edit("one", moved(1)))
    assert document.state.drawing == TOWEL.drawing


def test_a_line_that_was_never_finished_is_no_harm_and_the_next_takes_its_place(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    with (tmp_path / "documents" / f"{document_id}.journal").open("ab") as file:
        file.write(b"0123abcd {" + b"x" * 100_000)
    assert entries(repository)[0].problem is None
    kept = DocumentRepository(tmp_path / "documents").kept(document_id)
    assert kept.draft.drawing == moved(1)
    Document(kept.draft, version=kept.version, keep=kept.keeper.keep).edit(Edit("two", moved(2)))
    assert restored(repository, document_id, tmp_path)[1].drawing == moved(2)


def test_without_its_head_a_document_is_the_same(repository: DocumentRepository, tmp_path: Path) -> None:
    """A power failure may lose it, or bring an older one back."""
    document_id, document = kept_document(repository)
    head = tmp_path / "documents" / f"{document_id}.head"
    older = head.read_bytes()
    document.edit(Edit("one", moved(1)))
    shown = entries(repository)
    for content in (older, b"", None):
        head.unlink() if content is None else head.write_bytes(content)
        found = entries(DocumentRepository(tmp_path / "documents"))
        assert [(one.id, one.title, one.problem) for one in found] == [(one.id, one.title, None) for one in shown]
        assert restored(repository, document_id, tmp_path)[1].drawing == moved(1)


def test_a_commit_writes_about_one_step_and_the_journal_does_not_grow_for_ever(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    journal = tmp_path / "documents" / f"{document_id}.journal"
    one_drawing, sizes = journal.stat().st_size, []
    for number in range(450):
        document.edit(Edit("Move", moved(1 + number % 7)))
        sizes.append(journal.stat().st_size)
    grown = [after - before for before, after in itertools.pairwise(sizes)]
    assert sum(size > 1.2 * one_drawing for size in grown) == 0
    anew = sum(size < 0 for size in grown)
    assert 1 <= anew <= 4, "now and then, not at every commit"
    assert max(sizes) < 3 * 200 * one_drawing
    assert restored(repository, document_id, tmp_path)[1].history == document.state.draft.history


def test_a_document_whose_files_somebody_took_away_is_written_whole_again(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    document_id, document = kept_document(repository)
    document.edit(Edit("one", moved(1)))
    shutil.rmtree(tmp_path / "documents")
    document.edit(Edit("two", moved(2)))
    assert restored(repository, document_id, tmp_path)[1].history == document.state.draft.history
