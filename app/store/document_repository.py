"""The document repository: a folder of documents. An unreadable file is renamed and reported; the others still open."""

import secrets
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from app.store.document_files import BROKEN, HEAD, JOURNAL, JSON, PREVIEW, START, DocumentFiles, UnknownDocumentError
from app.store.document_keeper import DocumentKeeper
from app.store.document_list import DocumentEntry, DocumentList, DocumentPage
from app.store.document_reader import KeptDocument, glance_at, read_document, read_entry
from app.store.durable_file import sync_folder, write_at_once
from app.store.storage_error import storing
from app.store.versions import KeptVersion, read_versions

_LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
"""Characters of ids, without those that look alike (0, 1, i, l, o)."""


class DocumentRepository:
    """A repository of documents in a folder; saving the first one makes the folder."""

    def __init__(self, folder: Path) -> None:
        """Remove the temporary files of a server that was killed while it wrote."""
        self._folder = folder
        self._last = folder / ".last"
        self._list = DocumentList(folder, self._glance, self._entry)
        with suppress(OSError):  # leftover files do no harm
            for left in folder.glob(".?*-*"):
                left.unlink(missing_ok=True)

    def page(self, after: tuple[str, str] | None, count: int) -> DocumentPage:
        """Return a page of the list, the latest changed documents first, unreadable ones last."""
        with storing("the documents could not be listed"):
            return self._list.page(after, count)

    def new_id(self) -> str:
        """Return an unused id."""
        while True:
            document_id = "".join(secrets.choice(_LETTERS) for _ in range(8))
            files = DocumentFiles(document_id, self._folder)
            if files.document is None and not files.path(BROKEN).exists():
                return document_id

    def keeper(self, document_id: str) -> DocumentKeeper:
        """Return the keeper of a new document."""
        return DocumentKeeper(DocumentFiles(document_id, self._folder))

    def kept(self, document_id: str) -> KeptDocument:
        """Return a document as saved.

        Raises:
            UnknownDocumentError: there is none.
            NewerDocumentError: a newer version of Pleat wrote it.
            BrokenDocumentError: its file is damaged, and has been renamed if possible.
            StorageError: the system refuses to read it.
        """
        files = DocumentFiles(document_id, self._folder)
        with storing(f"document {document_id!r} could not be read"):
            return read_document(files)

    def versions(self, document_id: str) -> tuple[KeptVersion, ...]:
        """Return the drawings that a document can go back to, the latest first.

        Raises:
            UnknownDocumentError: there is no such document.
            StorageError: the system refuses to read it.
        """
        files = DocumentFiles(document_id, self._folder)
        with storing(f"document {document_id!r} could not be read"):
            return read_versions(files)

    def remove(self, document_id: str) -> None:
        """Remove a document.

        Raises:
            UnknownDocumentError: there is none.
            StorageError: it could not be removed, and is still there.
        """
        files = DocumentFiles(document_id, self._folder)
        with storing(f"document {document_id!r} could not be removed"):
            found = [path for path in map(files.path, (BROKEN, JSON, JOURNAL)) if path.exists()]
            if not found:
                raise UnknownDocumentError(document_id)
            for path in found:
                path.unlink()
        with suppress(OSError):  # the document itself is removed already
            for path in map(files.path, (HEAD, PREVIEW, START)):
                path.unlink(missing_ok=True)
            sync_folder(self._folder)

    def recent(self) -> Iterator[str]:
        """Yield the ids of readable documents: the last opened one, then the others, latest changed first.

        Judged by their list entries; opening one may still fail.
        """
        last = ""
        with suppress(OSError, ValueError, UnknownDocumentError):
            last = self._last.read_text(encoding="utf-8")
            if DocumentFiles(last, self._folder).document is not None:
                yield last
        with storing("the documents could not be listed"):
            entries = self._list.ordered()
        yield from (entry.id for entry in entries if entry.problem is None and entry.id != last)

    def remember_last(self, document_id: str) -> None:
        """Save which document was opened last; ignore a failure."""
        with suppress(OSError):
            write_at_once(self._last, document_id.encode(), is_synced=False)

    def _glance(self, document_id: str) -> DocumentEntry:
        return glance_at(DocumentFiles(document_id, self._folder))

    def _entry(self, document_id: str) -> DocumentEntry:
        return read_entry(DocumentFiles(document_id, self._folder))
