"""The repository that tests of stored documents use."""

from pathlib import Path

import pytest

from app.store.document_repository import DocumentRepository


@pytest.fixture
def repository(tmp_path: Path) -> DocumentRepository:
    """Return an empty repository."""
    return DocumentRepository(tmp_path / "documents")
