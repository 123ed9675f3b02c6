"""Values that may be missing, where a test relies on them."""

from typing import TypeVar

T = TypeVar("T")


def required(found: T | None) -> T:
    """Return a value that must be there."""
    assert found is not None
    return found
