"""What a test relies on: values that are there, and searches that found joints, or none."""

from typing import TypeVar

from planner.geometry.pose import FloatArray
from planner.robots.tool_path import NoPath

T = TypeVar("T")


def required(value: T | None) -> T:
    """Return what has been found."""
    assert value is not None
    return value


def joints_of(found: FloatArray | NoPath) -> FloatArray:
    """Return the joints that a search has found."""
    assert not isinstance(found, NoPath)
    return found


def no_path_of(found: FloatArray | NoPath) -> NoPath:
    """Return what a search tells that has found no joints."""
    assert isinstance(found, NoPath)
    return found
