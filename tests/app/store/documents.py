"""Documents in a repository that many tests use."""

from app.document import Document
from app.drawing.draft import Draft
from app.store.document_repository import DocumentEntry, DocumentRepository
from tests.app.store.drafts import TOWEL


def kept_document(repository: DocumentRepository) -> tuple[str, Document]:
    """Return a document that is stored at each commit, and its id."""
    document_id = repository.new_id()
    keeper = repository.keeper(document_id)
    keeper.keep(1, TOWEL)
    return document_id, Document(TOWEL, keep=keeper.keep)


def reopened(repository: DocumentRepository, document_id: str) -> Document:
    """Return a document as a server opens it that starts now."""
    kept = repository.kept(document_id)
    return Document(
        kept.draft,
        version=kept.version,
        start=kept.start,
        keep=kept.keeper.keep,
        keep_start=kept.keeper.keep_start,
        reread=lambda: repository.reread(kept.keeper),
    )


def restored(repository: DocumentRepository, document_id: str) -> tuple[int, Draft]:
    """Return the state that a server finds if it starts after this one was killed."""
    kept = repository.kept(document_id)
    return kept.version, kept.draft


def entries(repository: DocumentRepository) -> tuple[DocumentEntry, ...]:
    """Return the first page of the list of documents."""
    return repository.page(None, 100).entries
