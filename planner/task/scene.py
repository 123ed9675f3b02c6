"""The scene: table, stations, and every number of the cost model, with its default.

No default stands anywhere else. In the default scene a PR2 can fold all nine garments of the paper's Table 1: the
table is 1.60 m deep and 0.98 m wide, and the base centre is 0.15 m outside the edge at each of five stations.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Any

from annotated_types import Interval

from planner.errors import SceneError
from planner.geometry.given import NamedPoses
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.json_form import NULL_IS_DEFAULT, STRICT, JsonForm, require_intervals

_QUARTER = math.pi / 2

DEFAULT_STATIONS: MappingProxyType[str, Pose2] = MappingProxyType(
    {
        "front": Pose2(-0.95, 0.0, 0.0),
        "front_left": Pose2(-0.10, 0.64, -_QUARTER),
        "left": Pose2(0.45, 0.64, -_QUARTER),
        "front_right": Pose2(-0.10, -0.64, _QUARTER),
        "right": Pose2(0.45, -0.64, _QUARTER),
    }
)
"""The default stations, poses of the base in the table frame by name (paper, Figure 7a)."""

STATIONS_MAX = 64
"""The most stations that a scene may have."""

FRICTION_MAX = 10.0
"""The largest friction coefficient between cloth and table."""

SUPPORT_ANGLE_MAX_RAD = math.radians(85.0)
"""The largest support angle (rad): beyond it the cloth beside it would support even the top of a hanging piece."""


@dataclass(frozen=True, slots=True)
class Scene:
    """The table, the stations, and the costs of the robot's motions.

    Attributes:
        table: the table.
        stations: named base poses in the table frame, in the order given.
        torso_m: the height to which the robot's lift is raised (m).
        friction: static friction coefficient between cloth and table, mu.
        support_angle_rad: a vertex also counts as supported when cloth lies within this angle of
            straight above it (rad); 0 is the bare theory.
        approach_cone_rad: a pinch comes from within this angle of the bisector of the directions
            into the cloth (rad); pi asks nothing.
        back_off_max_m: the furthest that the base may back off from a station (m).
        edge_clear_m: the distance outside a table edge's plane at which a tool holds cloth that hangs there (m).
        arm_motion_s: the time of one arm motion (s).
        grip_dwell_s: the time that a hand rests while its fingers close, and again while they open, within an arm
            motion (s).
        base_speed_m_s: the base's speed (m/s).
        base_turn_rad_s: the base's turning speed (rad/s).
    """

    __pydantic_config__ = STRICT

    table: Annotated[Table, NULL_IS_DEFAULT] = field(default_factory=Table)
    stations: Annotated[NamedPoses, NULL_IS_DEFAULT] = tuple(DEFAULT_STATIONS.items())
    torso_m: Annotated[float, Interval(ge=0.0, le=1.0), NULL_IS_DEFAULT] = 0.29
    friction: Annotated[float, Interval(ge=0.0, le=FRICTION_MAX), NULL_IS_DEFAULT] = 1.0
    support_angle_rad: Annotated[float, Interval(ge=0.0, le=SUPPORT_ANGLE_MAX_RAD), NULL_IS_DEFAULT] = math.radians(5.0)
    approach_cone_rad: Annotated[float, Interval(ge=0.0, le=math.pi), NULL_IS_DEFAULT] = math.radians(75.0)
    back_off_max_m: Annotated[float, Interval(ge=0.0, le=1.5), NULL_IS_DEFAULT] = 0.8
    edge_clear_m: Annotated[float, Interval(ge=0.0, le=0.1), NULL_IS_DEFAULT] = 0.03
    arm_motion_s: Annotated[float, Interval(ge=1e-3, le=1e3), NULL_IS_DEFAULT] = 3.0
    grip_dwell_s: Annotated[float, Interval(ge=0.0, le=60.0), NULL_IS_DEFAULT] = 0.5
    base_speed_m_s: Annotated[float, Interval(ge=1e-3, le=1e3), NULL_IS_DEFAULT] = 0.25
    base_turn_rad_s: Annotated[float, Interval(ge=1e-3, le=1e3), NULL_IS_DEFAULT] = 0.5

    def __post_init__(self) -> None:
        """Check the fields; raises `SceneError` with the field and the number."""
        if not 1 <= len(self.stations) <= STATIONS_MAX:
            raise SceneError("stations", f"there are {len(self.stations)}, a scene has 1 to {STATIONS_MAX}")
        require_intervals(self, SceneError)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Scene":
        """Return the scene that JSON holds; fields left out or null have defaults, given stations replace the five.

        Raises:
            SceneError: names the field, and says what is wrong with which number.
        """
        return _SCENES.read(data)

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as JSON, every field filled in."""
        written: dict[str, Any] = _SCENES.write(self)
        return written


_SCENES = JsonForm(Scene, SceneError)
