"""Errors about stored documents."""

from dataclasses import dataclass

from planner.errors import FoldingError


@dataclass
class UnknownDocumentError(FoldingError):
    """No document has this id."""

    document_id: str

    def __str__(self) -> str:
        return f"there is no document {self.document_id[:80]!r}"


@dataclass
class NewerDocumentError(FoldingError):
    """A newer version of Pleat wrote the document."""

    document_id: str
    format: int

    def __str__(self) -> str:
        return (
            f"document {self.document_id!r} is of format {self.format}, which this version of Pleat cannot read. "
            "It is left as it is; open it with a newer version."
        )


@dataclass
class BrokenDocumentError(FoldingError):
    """The stored data of a document cannot be read."""

    document_id: str
    why: str

    def __str__(self) -> str:
        return f"document {self.document_id!r} cannot be read and is left as it is: {self.why}"
