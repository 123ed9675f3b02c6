"""Warnings about values of a robot's card that are allowed but probably not intended: codes, numbers and a sentence."""

import math
from collections.abc import Iterable, Iterator
from typing import Any

from planner.robots.card_doubts import (
    ArmsCrossed,
    ArmsTogether,
    Doubt,
    MountFacesAway,
    OddPart,
    StationFacesAway,
    StationInTable,
    card_doubts,
    stations_in_table,
)
from planner.robots.card_robot import CardRobot
from planner.robots.described_robot import DescribedRobot
from planner.robots.tool_point import BEFORE_OFF_M, BESIDE_OFF_M, BEYOND_OFF_M, ToolPoint, tool_points


def warnings_of(robot: DescribedRobot) -> list[dict[str, Any]]:
    """Return the warnings about a robot, without a look at where its arms can go: that takes half a minute an arm.

    Raises:
        RobotError: a mesh cannot be read or is too large.
    """
    scene = robot.card.scene
    doubts = card_doubts(robot)
    if any(isinstance(doubt, OddPart) for doubt in doubts):
        return robot_warnings((), (), doubts)  # what else there is to see follows from the shape
    at_table = CardRobot(robot).collisions(scene.table, scene.torso_m)
    return robot_warnings(tool_points(robot), stations_in_table(scene.stations, at_table), doubts)


def robot_warnings(
    points: Iterable[ToolPoint], stations: Iterable[StationInTable], doubts: Iterable[Doubt] = ()
) -> list[dict[str, Any]]:
    """Return a warning for each tool point off the fingertips, each station in the table and each doubt about a card.

    Each has a code, numbers, and a message.
    """
    of_tools = map(_of_tool, (point for point in points if point.is_off))
    return [*map(_of_doubt, doubts), *of_tools, *map(_of_station, stations)]


def _of_doubt(doubt: Doubt) -> dict[str, Any]:
    match doubt:
        case OddPart(link, size_m, most_m) if size_m > most_m:
            said = f"urdf: link {link!r} has a shape of {size_m:.3g} m, and the robot reaches {most_m:.3g} m"
            said += "; check the unit of its mesh, or give its scale in the URDF"
            return {"code": "part_too_large", "link": link, "size_m": size_m, "most_m": most_m, "message": said}
        case OddPart(link, size_m):
            said = (
                f"urdf: link {link!r} has a shape of {1000.0 * size_m:.3g} mm; check the unit or the scale of its mesh"
            )
            return {"code": "part_too_small", "link": link, "size_m": size_m, "message": said}
        case ArmsTogether((one, other), apart_m):
            said = f"mounts: the arms {one!r} and {other!r} begin {apart_m:.3f} m from each other; mount them apart"
            return {"code": "arms_together", "arms": [one, other], "apart_m": apart_m, "message": said}
        case ArmsCrossed((one, other), left_m):
            said = f"arms: {other!r} stands {left_m:.2f} m to the left of {one!r}; name the arms from left to right"
            return {"code": "arms_crossed", "arms": [one, other], "left_m": left_m, "message": said}
        case StationFacesAway(station, away_rad):
            said = (
                f"scene.stations: at {station} the table is {math.degrees(away_rad):.0f} degrees off the way the base"
            )
            said += " looks; turn its yaw_rad towards the table"
            return {"code": "station_faces_away", "station": station, "away_rad": away_rad, "message": said}
        case MountFacesAway(mount, away_rad):
            which = f"the arms of {mount!r}" if mount else "the arms"
            said = f"mounts: at home {which} reach {math.degrees(away_rad):.0f} degrees off the way to the table"
            said += "; turn the mount's yaw_rad towards the table, or change the home"
            return {"code": "mount_faces_away", "mount": mount, "away_rad": away_rad, "message": said}


def _of_tool(point: ToolPoint) -> dict[str, Any]:
    return {
        "code": "tool_off_tips",
        "arm": point.arm,
        "beyond_m": point.beyond_m,
        "beside_m": point.beside_m,
        "message": f"{point.arm}: {' and '.join(_off(point))}; put arms[].tool.offset_m where the fingertips meet",
    }


def _off(point: ToolPoint) -> Iterator[str]:
    if point.beyond_m > BEYOND_OFF_M:
        yield f"the fingertips reach {point.beyond_m:.3f} m beyond the tool point, which passes 0.02 m over the table"
    elif point.beyond_m < -BEFORE_OFF_M:
        yield f"the fingertips end {-point.beyond_m:.3f} m before the tool point"
    if abs(point.beside_m or 0.0) > BESIDE_OFF_M:
        yield f"the fingers meet {abs(point.beside_m or 0.0):.3f} m beside the tool point along the closing axis"


def _of_station(found: StationInTable) -> dict[str, Any]:
    back = "so it would up to a metre further back" if found.back_m is None else f"{found.back_m:.2f} m back it is free"
    return {
        "code": "station_in_table",
        "station": found.station,
        "back_m": found.back_m,
        "message": f"scene.stations: at {found.station} the base would stand in the table or its legs; {back}",
    }
