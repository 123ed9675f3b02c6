"""Documents of older and newer formats, and documents that were cut off: read, refused, or reported as damaged."""

from pathlib import Path

import pytest

from app.document import Document
from app.drawing.draft import Draft
from app.drawing.edit import Edit
from app.store.document_files import NewerDocumentError
from app.store.document_reader import BrokenDocumentError
from app.store.document_repository import DocumentRepository
from tests.app.store.documents import entries, kept_document, restored
from tests.app.store.drafts import TOWEL, moved, older_file, worked_on


def put_older(tmp_path: Path, document_id: str, draft: Draft, format_: int = 1) -> Path:
    """Write a document of format 1, or one with another format number."""
    path = tmp_path / "documents" / f"{document_id}.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(older_file(document_id, 7, draft, format_))
    return path


def test_a_document_of_the_format_before_is_read_and_goes_on_as_a_journal(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    *_, draft = (draft for draft in worked_on(5, 40) if draft.gesture is None)
    assert draft.history.past
    path = put_older(tmp_path, "oldone22", draft)
    assert [(entry.id, entry.problem) for entry in entries(repository)] == [("oldone22", None)]
    kept = repository.kept("oldone22")
    assert (kept.version, kept.draft.drawing, kept.draft.history) == (7, draft.drawing, draft.history)
    assert path.exists(), "reading changes nothing"
    document = Document(kept.draft, version=kept.version, keep=kept.keeper.keep)
    document.edit(Edit("new", moved(9)))
    assert not path.exists()
    version, after = restored(repository, "oldone22", tmp_path)
    assert (version, after.drawing, after.history) == (8, moved(9), document.state.draft.history)
    assert [entry.id for entry in entries(repository)] == ["oldone22"]


def test_a_spoilt_drawing_in_an_older_file_is_told_of_by_its_field(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    path = put_older(tmp_path, "oldone22", TOWEL)
    path.write_text(path.read_text().replace("[0.4, 0.0]", '[0, "x"]'))
    assert "outline[1].point[1]" in str(entries(repository)[0].problem)
    with pytest.raises(BrokenDocumentError, match=r"outline\[1\]\.point\[1\]"):
        repository.kept("oldone22")


def newer_files(repository: DocumentRepository, tmp_path: Path) -> dict[str, int]:
    """Return documents of future formats, possibly cut off or reordered, with their formats."""
    put_older(tmp_path, "newerabc", TOWEL, 2)
    cut = put_older(tmp_path, "newercut", TOWEL, 17)
    cut.write_bytes(cut.read_bytes()[:-40])
    put_older(tmp_path, "newertoo", TOWEL).write_text('{"content": {}, "format": 3}')
    (tmp_path / "documents" / "newerxyz.journal").write_bytes(b'{"format": 3, "id": "newerxyz"}\n\x00\x01')
    return {"newerabc": 2, "newercut": 17, "newertoo": 3, "newerxyz": 3}


def test_a_document_of_a_newer_format_is_refused_by_its_version_and_left_alone(
    repository: DocumentRepository, tmp_path: Path
) -> None:
    formats = newer_files(repository, tmp_path)
    before = {path.name: path.read_bytes() for path in (tmp_path / "documents").iterdir()}
    problems = {entry.id: str(entry.problem) for entry in entries(repository)}
    assert list(repository.recent()) == []
    for document_id, number in formats.items():
        assert f"format {number}" in problems[document_id]
        with pytest.raises(NewerDocumentError, match=f"format {number}"):
            repository.kept(document_id)
    DocumentRepository(tmp_path / "documents")
    assert {path.name: path.read_bytes() for path in (tmp_path / "documents").iterdir()} == before


@pytest.mark.parametrize("share", [0.3, 0.7, 0.99])
def test_a_document_that_was_cut_off_does_not_look_well(
    repository: DocumentRepository, tmp_path: Path, share: float
) -> None:
    """What was acknowledged is missing: that is told, where a line that a kill left unfinished is not."""
    document_id, document = kept_document(repository)
    for number in range(4):
        document.edit(Edit("Move", moved(number + 1)))
    put_older(tmp_path, "oldone22", document.state.draft)
    for name in (f"{document_id}.journal", "oldone22.json"):
        path = tmp_path / "documents" / name
        path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    for here in (repository, DocumentRepository(tmp_path / "documents")):
        assert {entry.id for entry in entries(here) if entry.problem} == {document_id, "oldone22"}
    for cut in (document_id, "oldone22"):
        with pytest.raises(BrokenDocumentError):
            repository.kept(cut)
