"""The sentence of every message about planning, made from its code and numbers.

The planner reports codes and numbers; their English sentences are here alone, for REST, for the command line, and for
whoever prints a plan in Python. The page has its own catalogue, in its reader's unit (`static/js/messages`).
"""

from collections.abc import Callable, Mapping

from planner.message import Message
from planner.words.cloth import CLOTH
from planner.words.folds import FOLDS
from planner.words.lengths import Folds, Values, called
from planner.words.reach import REACH

_NAMELESS: Mapping[str, Callable[[Values], str]] = {**CLOTH, **REACH}

CODES = frozenset({*_NAMELESS, *FOLDS})
"""The codes that have a sentence here."""


def worded(code: str, values: Values, folds: Folds = (), fold: int | None = None) -> Message:
    """Return a message with its sentence.

    Args:
        code: the kind of message.
        values: its named values.
        folds: the garment's folds, whose names the sentence may use.
        fold: the fold that the message is about, named in front; None if it is about none.
    """
    words = FOLDS[code](values, folds) if code in FOLDS else _NAMELESS[code](values)
    return Message(code, words if fold is None else f"{called(folds, fold)}: {words}", values)


def sentence(says: Message, folds: Folds, fold: int | None = None) -> str:
    """Return the sentence of a message, made anew from its numbers; arguments as for `worded`.

    The sentence that a message from elsewhere came with is used only if it has no code of this catalogue, or lacks some
    of the code's numbers.
    """
    if says.code not in CODES:
        return says.text
    try:
        return worded(says.code, says.values, folds, fold).text
    except (LookupError, TypeError, ValueError, ArithmeticError, AttributeError):
        return says.text
