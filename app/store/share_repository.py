"""Links with which others may look at a document: each has a random token, of which only the hash is kept."""

import hashlib
import secrets
import time

from sqlalchemy import CursorResult, delete, insert, select

from app.store.database import Database
from app.store.document_errors import UnknownDocumentError
from app.store.document_repository import require_id
from app.store.schema import DocumentRow, ShareRow

_TOKEN_BYTES = 24


class ShareRepository:
    """The links to documents."""

    def __init__(self, database: Database) -> None:
        """Use a database; read nothing yet."""
        self._database = database

    def add(self, document_id: str) -> str:
        """Return the token of a new link to a document.

        Raises:
            UnknownDocumentError: there is no such document.
            StorageError: the link could not be kept.
        """
        require_id(document_id)
        token = secrets.token_urlsafe(_TOKEN_BYTES)
        with self._database.writing("the link could not be kept") as session:
            if session.scalar(select(DocumentRow.id).where(DocumentRow.id == document_id)) is None:
                raise UnknownDocumentError(document_id)
            row = {"hash": _hash(token), "document_id": document_id, "created_s": time.time()}
            session.execute(insert(ShareRow), row)
        return token

    def document_of(self, token: str) -> str | None:
        """Return the id of the document that a link leads to; None if it leads nowhere."""
        with self._database.reading("the link could not be read") as session:
            return session.scalar(select(ShareRow.document_id).where(ShareRow.hash == _hash(token)))

    def revoke(self, document_id: str) -> int:
        """Let no link lead to a document any more; return how many there were. Raise as `add` does."""
        require_id(document_id)
        with self._database.writing("the links could not be taken back") as session:
            removed = session.execute(delete(ShareRow).where(ShareRow.document_id == document_id))
            assert isinstance(removed, CursorResult)
            return removed.rowcount


def _hash(token: str) -> str:
    """Return the hash that is kept of a token; a plain one is enough, because tokens are long and random."""
    return hashlib.sha256(token.encode()).hexdigest()
