"""The errors of studies."""

from planner.errors import FieldError, FoldingError


class StudyError(FieldError):
    """A study that is not valid; names the field of its file."""


class StudyFolderError(FoldingError):
    """A folder whose results cannot be used."""
