"""Refusals: reasons why an action cannot be done, in one sentence."""

from dataclasses import dataclass

from app.drawing.rules import as_sentence
from app.language import ENGLISH, Language, translated
from app.ui.editor.drawing_messages import localized
from planner.errors import FieldError, FoldingError

_SUBJECTS = {"line": "The line", "end": "The fold", "start": "The fold"}


@dataclass
class RefusedError(FoldingError):
    """Raised where an action of the pointer cannot be done.

    Attributes:
        sentence: why, for people.
    """

    sentence: str

    def __str__(self) -> str:
        return self.sentence


def sentence(error: FoldingError, language: Language = ENGLISH) -> str:
    """Return an error as a sentence of the language that begins with a capital letter and ends with a full stop."""
    text = str(error)
    if isinstance(error, FieldError):
        subject = _SUBJECTS.get(error.field.rpartition(".")[2])
        text = f"{subject} {error.message}" if subject and error.message.startswith("does not") else error.message
        text = localized(language, error.says, text)
    return translated(language, as_sentence(text))
