"""Limits for one client, so that nobody takes the whole server."""

from contextvars import ContextVar
from dataclasses import dataclass

from planner.errors import FoldingError

CLIENT: ContextVar[str] = ContextVar("CLIENT", default="")
"""The address of the client whose request is being answered, if limits hold for it; empty for this machine."""


@dataclass
class TooManyError(FoldingError):
    """A client asks for more than its share.

    Attributes:
        what: what there is too much of, as a sentence.
        retry_after_s: the time after which to try again (s).
    """

    what: str
    retry_after_s: int

    def __str__(self) -> str:
        return f"{self.what}; try again in {self.retry_after_s} s"
