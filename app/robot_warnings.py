"""Warnings about values of a robot's card that are allowed but probably not intended: codes, numbers and a sentence."""

from collections.abc import Iterable, Iterator
from typing import Any

from planner.robots.tool_point import BEFORE_OFF_M, BESIDE_OFF_M, ToolPoint


def robot_warnings(points: Iterable[ToolPoint]) -> list[dict[str, Any]]:
    """Return a warning for each tool point that is off the fingertips: a code, its numbers, and the message."""
    return [
        {
            "code": "tool_off_tips",
            "arm": point.arm,
            "beyond_m": point.beyond_m,
            "beside_m": point.beside_m,
            "message": f"{point.arm}: {' and '.join(_off(point))}; put arms[].tool.offset_m where the fingertips meet",
        }
        for point in points
        if point.is_off
    ]


def _off(point: ToolPoint) -> Iterator[str]:
    if point.beyond_m >= 0.0:
        yield f"the fingertips reach {point.beyond_m:.3f} m beyond the tool point, which passes 0.02 m over the table"
    elif point.beyond_m < -BEFORE_OFF_M:
        yield f"the fingertips end {-point.beyond_m:.3f} m before the tool point"
    if abs(point.beside_m or 0.0) > BESIDE_OFF_M:
        yield f"the fingers meet {abs(point.beside_m or 0.0):.3f} m beside it along the closing axis"
