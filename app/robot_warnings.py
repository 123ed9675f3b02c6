"""Warnings about values of a robot's card that are allowed but probably not intended: codes, numbers and a sentence."""

from collections.abc import Iterable, Iterator
from typing import Any

from planner.robots.station_room import StationInTable
from planner.robots.tool_point import BEFORE_OFF_M, BESIDE_OFF_M, ToolPoint


def robot_warnings(points: Iterable[ToolPoint], stations: Iterable[StationInTable]) -> list[dict[str, Any]]:
    """Return a warning for each tool point off the fingertips and each station in the table: code, numbers, message."""
    return [*map(_of_tool, (point for point in points if point.is_off)), *map(_of_station, stations)]


def _of_tool(point: ToolPoint) -> dict[str, Any]:
    return {
        "code": "tool_off_tips",
        "arm": point.arm,
        "beyond_m": point.beyond_m,
        "beside_m": point.beside_m,
        "message": f"{point.arm}: {' and '.join(_off(point))}; put arms[].tool.offset_m where the fingertips meet",
    }


def _off(point: ToolPoint) -> Iterator[str]:
    if point.beyond_m >= 0.0:
        yield f"the fingertips reach {point.beyond_m:.3f} m beyond the tool point, which passes 0.02 m over the table"
    elif point.beyond_m < -BEFORE_OFF_M:
        yield f"the fingertips end {-point.beyond_m:.3f} m before the tool point"
    if abs(point.beside_m or 0.0) > BESIDE_OFF_M:
        yield f"the fingers meet {abs(point.beside_m or 0.0):.3f} m beside it along the closing axis"


def _of_station(found: StationInTable) -> dict[str, Any]:
    back = "so it would up to a metre further back" if found.back_m is None else f"{found.back_m:.2f} m back it is free"
    return {
        "code": "station_in_table",
        "station": found.station,
        "back_m": found.back_m,
        "message": f"scene.stations: at {found.station} the base would stand in the table or its legs; {back}",
    }
