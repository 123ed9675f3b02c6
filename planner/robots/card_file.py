"""A robot described by a JSON card, which names a URDF in its folder or in an installed package.

Lengths are in m, angles in rad, times in s. The base frame is on the floor under the robot, x ahead, z up. A URDF
stands in it once for each of the card's mounts; its links and joints are then called by the mount's name, `_`, and
their own name. The same holds for tools, URDFs that are fixed to a link: so one arm's URDF and one gripper's make a
pair of arms with grippers.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from annotated_types import Interval
from pydantic import Field

from planner.errors import RobotError
from planner.geometry.given import GivenPose, NamedNumbers, NamedPoses
from planner.geometry.table import Table
from planner.json_form import STRICT, JsonForm, require_intervals
from planner.robots.card_parts import Attachment, CameraFile, GripperFile, Length, Mount, Rate, ToolFile, UrdfFile

VERSION = 1

ARMS_MAX, JOINTS_MAX = 8, 12
"""Cards with more arms, or with arms of more joints, are refused."""

NAME_MAX, TITLE_MAX = 64, 200
"""Most characters of an arm's name, and of a title."""


@dataclass(frozen=True, slots=True)
class ArmFile:
    """An arm.

    Attributes:
        name: its name for people.
        joints: its joints, from the base outwards.
        tool: its tool.
        home: its joints when it is out of the way (rad, m).
        gripper: its gripper.
        speeds: top speeds that replace the URDF's (rad/s, m/s); None: the URDF's.
        accelerations: top accelerations (rad/s2, m/s2); None: a usual one.
        lifting: the joints that raise its elbow and hand.
    """

    name: Annotated[str, Field(min_length=1, max_length=NAME_MAX)]
    joints: Annotated[
        tuple[str, ...], Field(json_schema_extra={"minItems": 1, "maxItems": JOINTS_MAX, "uniqueItems": True})
    ]
    tool: ToolFile
    home: tuple[float, ...]
    gripper: GripperFile
    speeds: tuple[Rate, ...] | None = None
    accelerations: tuple[Rate, ...] | None = None
    lifting: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse lists of unequal length; raises `RobotError`."""
        count = len(self.joints)
        if not 1 <= count <= JOINTS_MAX:
            raise RobotError("joints", f"there are {count}, an arm has 1 to {JOINTS_MAX}")
        if len(set(self.joints)) < count:
            raise RobotError("joints", "one of them is named twice")
        for name, given in (("home", self.home), ("speeds", self.speeds), ("accelerations", self.accelerations)):
            if given is not None and len(given) != count:
                raise RobotError(name, f"has {len(given)} numbers for {count} joints")


@dataclass(frozen=True, slots=True)
class BaseFile:
    """The base.

    Attributes:
        kind: how it moves.
        radius_m: the radius of a circle that contains it as it turns.
        size_m: its length and width.
        speed_m_s, turn_rad_s: its speeds.
        acceleration_m_s2: its acceleration.
    """

    kind: Literal["fixed", "omni", "differential"]
    radius_m: Length
    size_m: tuple[Length, Length]
    speed_m_s: Rate = 0.25
    turn_rad_s: Rate = 0.5
    acceleration_m_s2: Rate = 0.5


@dataclass(frozen=True, slots=True)
class SuitableScene:
    """A scene that suits a robot.

    Attributes:
        table: the table.
        stations: where the base may stand, table frame.
        placement: where a garment lies, table frame.
        torso_m: how far the lift is raised.
    """

    table: Table
    stations: NamedPoses
    placement: GivenPose
    torso_m: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.0

    def __post_init__(self) -> None:
        """Refuse a scene without stations; raises `RobotError`."""
        require_intervals(self, RobotError)
        if not self.stations:
            raise RobotError("stations", "there are none")


@dataclass(frozen=True, slots=True)
class CardFile:
    """A robot's card.

    Attributes:
        pleat_robot: the version of this form.
        name: the name it is loaded by.
        title: the name for people.
        urdf: its description.
        mounts: where that stands in the base frame.
        tools: descriptions fixed to its links.
        arms: its arms, from left to right as the robot sees them.
        base: its base.
        lift: the joint that raises the arms straight up; None without one.
        resting: where all other joints rest (rad, m).
        camera: what looks at the cloth; None: one over the table.
        scene: the scene that suits it.
    """

    __pydantic_config__ = STRICT

    pleat_robot: Annotated[int, Field(json_schema_extra={"const": VERSION})]
    name: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,63}$")]
    title: Annotated[str, Field(min_length=1, max_length=TITLE_MAX)]
    urdf: UrdfFile
    arms: Annotated[tuple[ArmFile, ...], Field(json_schema_extra={"minItems": 1, "maxItems": ARMS_MAX})]
    base: BaseFile
    scene: SuitableScene
    mounts: tuple[Mount, ...] = (Mount(),)
    tools: tuple[Attachment, ...] = ()
    lift: str | None = None
    resting: NamedNumbers = ()
    camera: CameraFile | None = None

    def __post_init__(self) -> None:
        """Refuse a newer version, names that are used twice, and a fixed base with several stations."""
        if self.pleat_robot != VERSION:
            raise RobotError("pleat_robot", f"is {self.pleat_robot}, this program reads {VERSION}")
        if not 1 <= len(self.arms) <= ARMS_MAX:
            raise RobotError("arms", f"there are {len(self.arms)}, a robot has 1 to {ARMS_MAX}")
        if not self.mounts:
            raise RobotError("mounts", "there are none")
        for field, named in (("arms", self.arms), ("mounts", self.mounts)):
            if len({one.name for one in named}) < len(named):
                raise RobotError(field, "two of them have one name")
        if self.base.kind == "fixed" and len(self.scene.stations) != 1:
            raise RobotError("scene.stations", f"a fixed base has one station, not {len(self.scene.stations)}")

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "CardFile":
        """Return the card that JSON holds; raises `RobotError`, which names the field."""
        return CARD_FILES.read(data)

    def to_dict(self) -> dict[str, Any]:
        """Return the card as JSON, every field filled in."""
        written: dict[str, Any] = CARD_FILES.write(self)
        return written


CARD_FILES = JsonForm(CardFile, RobotError)
