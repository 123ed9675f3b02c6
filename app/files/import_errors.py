"""What can be wrong with a file that is to be imported."""

from collections.abc import Mapping

from planner.errors import FieldError, FoldingError
from planner.message import Message


class ImportedFileError(FieldError):
    """A file that is no drawing of a garment; the field is ``file``, or the option of the import that is wrong."""


class UnitsNeededError(FoldingError):
    """The file does not say how long a unit of it is.

    Attributes:
        why: what is wrong with what the file says.
        sizes: for each unit that could be meant, how wide and how high the garment would be (m).
    """

    def __init__(self, why: Message, sizes: Mapping[str, tuple[float, float]]) -> None:
        super().__init__(f"{why.text}: say whether a unit of the drawing is {', '.join(sizes)}")
        self.why = why
        self.sizes = dict(sizes)


def broken(message: str) -> ImportedFileError:
    """The file itself is at fault."""
    return ImportedFileError("file", message)
