"""The repository that tests of stored documents use."""

import pytest

from app.store.database import Database
from app.store.document_repository import DocumentRepository


@pytest.fixture
def repository(database: Database) -> DocumentRepository:
    """Return an empty repository, in a database of each kind in turn."""
    return DocumentRepository(database)
