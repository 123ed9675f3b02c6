"""What tests of robots rely on: searches that found joints, or none."""

from planner.geometry.pose import FloatArray
from planner.robots.tool_path import NoPath


def joints_of(found: FloatArray | NoPath) -> FloatArray:
    """Return the joints that a search has found."""
    assert not isinstance(found, NoPath)
    return found


def no_path_of(found: FloatArray | NoPath) -> NoPath:
    """Return what a search tells that has found no joints."""
    assert isinstance(found, NoPath)
    return found
