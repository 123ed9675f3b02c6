"""Documents in a repository that many tests use."""

from pathlib import Path

from app.document import Document
from app.drawing.draft import Draft
from app.store.document_list import DocumentEntry
from app.store.document_repository import DocumentRepository
from tests.app.store.drafts import TOWEL


def kept_document(repository: DocumentRepository) -> tuple[str, Document]:
    """Return a document that is stored at each commit, and its id."""
    document_id = repository.new_id()
    keeper = repository.keeper(document_id)
    keeper.keep(1, TOWEL)
    return document_id, Document(TOWEL, keep=keeper.keep)


def restored(repository: DocumentRepository, document_id: str, tmp_path: Path) -> tuple[int, Draft]:
    """Return the state that a server finds if it starts after this one was killed."""
    kept = DocumentRepository(tmp_path / "documents").kept(document_id)
    return kept.version, kept.draft


def entries(repository: DocumentRepository) -> tuple[DocumentEntry, ...]:
    """Return the first page of the list of documents."""
    return repository.page(None, 100).entries
