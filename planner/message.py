"""Messages for people, as data: a code and named numbers, with the sentence that programs and logs print.

To show a message in another unit, numbering or language, make the words from the code and the numbers; never read a
number back out of the sentence.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Message:
    """A sentence, and the data it is made of.

    Attributes:
        code: the kind of message, which fixes the names of the values. Empty where the sentence has no numbers.
        text: the sentence in English: metres, indices from 0, without its full stop.
        values: the named values, as JSON: SI units, folds and edges by index.
    """

    code: str
    text: str
    values: Mapping[str, Any] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any] | None:
        """Return the code and the values as one JSON object, without the sentence; None if there is no code."""
        return {"code": self.code, **self.values} if self.code else None

    @staticmethod
    def plain(text: str) -> "Message":
        """Return a sentence without numbers."""
        return Message("", text)


def plain_points(points: Iterable[Iterable[float]]) -> list[list[float]]:
    """Return points as JSON."""
    return [[float(coordinate) for coordinate in point] for point in points]
