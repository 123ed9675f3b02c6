"""Errors of a file to import."""

from collections.abc import Mapping

from planner.errors import FieldError, FoldingError
from planner.message import Message


class ImportedFileError(FieldError):
    """A file is not a drawing of a garment; the field is ``file``, or the option of the import at fault."""


class UnitsNeededError(FoldingError):
    """The length of a drawing's unit is unknown.

    Attributes:
        why: why the unit in the file cannot be used.
        sizes: the garment's width and height for each possible unit (m).
    """

    def __init__(self, why: Message, sizes: Mapping[str, tuple[float, float]]) -> None:
        super().__init__(f"{why.text}: say whether a unit of the drawing is {', '.join(sizes)}")
        self.why = why
        self.sizes = dict(sizes)


def broken(message: str) -> ImportedFileError:
    """Return the error of a file that is itself at fault."""
    return ImportedFileError("file", message)
