"""Errors of pictures in which no garment can be recognised."""

from planner.errors import FieldError, FoldingError
from planner.message import Message

LARGEST_PICTURE = 20 << 20
"""Largest size of a picture's file (bytes)."""


class PictureError(FieldError):
    """Bad input: the file is not a readable picture, or an option given with it is wrong.

    The field is ``file``, ``scale``, ``like`` or ``state_of``.
    """


class NothingToldError(FoldingError):
    """The picture is readable, but shows nothing that can be recognised.

    Attributes:
        says: why, as data.
    """

    def __init__(self, says: Message) -> None:
        super().__init__(says.text)
        self.says = says


class ScaleNeededError(FoldingError):
    """Nothing in the picture says how large the garment is."""

    def __init__(self) -> None:
        super().__init__(
            "nothing in the picture says how large the garment is: lay a sheet of A4 or Letter beside it, or give a "
            "length, as in 0.60m:longest"
        )
