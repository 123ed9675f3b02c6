"""The scene: table, stations, and every number of the cost model, with its default. Nowhere else.

The default scene is one in which a PR2 can fold all nine articles of the paper's Table 1: a table 1.60 m deep and
0.98 m wide, the base centre standing 0.15 m outside the edge at each of five stations.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any

from pydantic import ValidationError

from planner.errors import SceneError
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.strict_model import Bounded, StrictModel, first_error

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
"""Where the base may stand, in the table frame, by name (paper, Figure 7a)."""

STATIONS_MAX = 64
"""A scene with more stations is refused."""

SUPPORT_ANGLE_MAX_RAD = math.radians(85.0)
"""Beyond this even the top of a hanging piece would count as supported by what is beside it (rad)."""


@dataclass(frozen=True, slots=True)
class Scene:
    """The table, where the robot may stand, and what its motions cost.

    Attributes:
        table: the table.
        stations: named base poses in the table frame, in the order given.
        torso_m: how far the robot's lift is raised (m).
        friction: static friction coefficient between cloth and table, mu.
        support_angle_rad: a vertex also counts as supported when cloth lies within this angle of
            straight above it (rad); 0 is the bare theory.
        approach_cone_rad: a pinch comes from within this angle of the bisector of the directions
            into the cloth (rad); pi asks nothing.
        back_off_max_m: the furthest that the base may back off from a station (m).
        edge_clear_m: how far outside a table edge's plane a tool holds cloth that hangs there (m).
        arm_motion_s: the time of one arm motion (s).
        grip_dwell_s: how long a hand rests while its fingers close, and again while they open, within an arm
            motion (s).
        base_speed_m_s: the base's speed (m/s).
        base_turn_rad_s: the base's turning speed (rad/s).
    """

    table: Table = field(default_factory=Table)
    stations: tuple[tuple[str, Pose2], ...] = tuple(DEFAULT_STATIONS.items())
    torso_m: float = 0.29
    friction: float = 1.0
    support_angle_rad: float = math.radians(5.0)
    approach_cone_rad: float = math.radians(75.0)
    back_off_max_m: float = 0.8
    edge_clear_m: float = 0.03
    arm_motion_s: float = 3.0
    grip_dwell_s: float = 0.5
    base_speed_m_s: float = 0.25
    base_turn_rad_s: float = 0.5

    def __post_init__(self) -> None:
        """Refuse what is no scene; raises `SceneError` naming the field and the number."""
        for name in ("depth_m", "width_m", "height_m"):
            _require_between(f"table.{name}", getattr(self.table, name), 0.1, 10.0)
        if not 1 <= len(self.stations) <= STATIONS_MAX:
            raise SceneError("stations", f"there are {len(self.stations)}, a scene has 1 to {STATIONS_MAX}")
        _require_between("torso_m", self.torso_m, 0.0, 1.0)
        _require_between("friction", self.friction, 0.0, 10.0)
        _require_between("support_angle_rad", self.support_angle_rad, 0.0, SUPPORT_ANGLE_MAX_RAD)
        _require_between("approach_cone_rad", self.approach_cone_rad, 0.0, math.pi)
        _require_between("back_off_max_m", self.back_off_max_m, 0.0, 1.5)
        _require_between("edge_clear_m", self.edge_clear_m, 0.0, 0.1)
        _require_between("grip_dwell_s", self.grip_dwell_s, 0.0, 60.0)
        for name in ("arm_motion_s", "base_speed_m_s", "base_turn_rad_s"):
            _require_between(name, getattr(self, name), 1e-3, 1e3)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Scene":
        """A scene from JSON; fields left out have their defaults, given stations replace the five.

        Raises:
            SceneError: names the field, and says what is wrong with which number.
        """
        try:
            given = _SceneModel.model_validate(data)
        except ValidationError as error:
            raise first_error(error, SceneError) from None
        return given.to_scene()

    def to_dict(self) -> dict[str, Any]:
        """The scene as JSON, every field filled in."""
        plain = {f.name: getattr(self, f.name) for f in fields(self)[2:]}
        table = {f.name: getattr(self.table, f.name) for f in fields(self.table)}
        stations = {name: pose.to_dict() for name, pose in self.stations}
        return {"table": table, "stations": stations, **plain}


def _require_between(name: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise SceneError(name, f"{value} is not between {low} and {high}")


class _TableModel(StrictModel):
    depth_m: float | None = None
    width_m: float | None = None
    height_m: float | None = None


class _StationModel(StrictModel):
    x_m: Bounded
    y_m: Bounded
    yaw_rad: Bounded


class _SceneModel(StrictModel):
    table: _TableModel | None = None
    stations: dict[str, _StationModel] | None = None
    torso_m: float | None = None
    friction: float | None = None
    support_angle_rad: float | None = None
    approach_cone_rad: float | None = None
    back_off_max_m: float | None = None
    edge_clear_m: float | None = None
    arm_motion_s: float | None = None
    grip_dwell_s: float | None = None
    base_speed_m_s: float | None = None
    base_turn_rad_s: float | None = None

    def to_scene(self) -> Scene:
        """The scene with defaults where nothing, or null, was given."""
        given = self.model_dump(exclude_none=True)
        if self.table is not None:
            given["table"] = Table(**self.table.model_dump(exclude_none=True))
        if self.stations is not None:
            given["stations"] = tuple((name, Pose2(p.x_m, p.y_m, p.yaw_rad)) for name, p in self.stations.items())
        return Scene(**given)
