"""The parts of a robot's card: URDFs with their mounts, grippers and tools."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from annotated_types import Interval
from pydantic import Field

from planner.errors import RobotError
from planner.geometry.pose import Point3
from planner.json_form import require_intervals

Length = Annotated[float, Interval(ge=0.0, le=10.0)]
"""A length (m)."""

_Place = Annotated[float, Interval(ge=-10.0, le=10.0)]
_Angle = Annotated[float, Interval(ge=-7.0, le=7.0)]

TOOL_MAX_M = 2.0
"""A tool farther from its link is a mistake (m)."""

Rate = Annotated[float, Interval(gt=0.0, le=1e3)]
"""A top speed or acceleration."""


@dataclass(frozen=True, slots=True)
class UrdfFile:
    """The location of a URDF.

    Attributes:
        path: its path below the card's folder, or in the package.
        package: the installed distribution that carries it; None: it is beside the card.
    """

    path: str
    package: str | None = None


@dataclass(frozen=True, slots=True)
class Mount:
    """The pose of a URDF's root in the base frame, or of a tool's root on its link.

    Attributes:
        name: the name put before those of links and joints; empty for none.
        x_m, y_m, z_m: the position.
        roll_rad, pitch_rad, yaw_rad: the rotation, as in a URDF.
    """

    name: str = ""
    x_m: _Place = 0.0
    y_m: _Place = 0.0
    z_m: _Place = 0.0
    roll_rad: _Angle = 0.0
    pitch_rad: _Angle = 0.0
    yaw_rad: _Angle = 0.0

    def __post_init__(self) -> None:
        require_intervals(self, RobotError)


@dataclass(frozen=True, slots=True)
class Attachment:
    """A URDF fixed to a link of the robot's URDF, on every mount.

    Attributes:
        urdf: the tool's URDF.
        link: the link that carries it.
        mount: where its root is on that link, and the name put before those of its links and joints.
    """

    urdf: UrdfFile
    link: str
    mount: Mount


@dataclass(frozen=True, slots=True)
class LinearDrive:
    """Fingers whose opening is proportional to the way of one joint; others mimic it in the URDF.

    Attributes:
        joint: the joint that drives them.
        closed: its value where they touch (rad, m).
        opened: its value where they are as wide open as they go (rad, m).
    """

    joint: str
    closed: float
    opened: float
    kind: Literal["linear"] = "linear"

    def __post_init__(self) -> None:
        if self.closed == self.opened:
            raise RobotError("opened", f"is {self.opened}, as when closed")


@dataclass(frozen=True, slots=True)
class ParallelogramDrive:
    """Fingers on parallelograms: they swing out and stay parallel.

    Attributes:
        joint: the joint that drives both fingers.
        link_x_m: how far the fingertip's hinge is ahead of the driven hinge, gripper closed (m).
        link_y_m: how far it is to the side (m).
    """

    joint: str
    link_x_m: Length
    link_y_m: Length
    kind: Literal["parallelogram"] = "parallelogram"

    def __post_init__(self) -> None:
        require_intervals(self, RobotError)


@dataclass(frozen=True, slots=True)
class Pinch:
    """The flattest approach of a gripper over the table, by the roll of its fingers.

    Attributes:
        side_by_side_rad: the least pitch with the fingers side by side.
        one_over_other_rad: the least pitch with one finger over the other.
    """

    side_by_side_rad: Annotated[float, Interval(ge=0.0, le=1.5707963267948966)] = 0.0
    one_over_other_rad: Annotated[float, Interval(ge=0.0, le=1.5707963267948966)] = 0.0

    def __post_init__(self) -> None:
        require_intervals(self, RobotError)


@dataclass(frozen=True, slots=True)
class GripperFile:
    """A gripper of two fingers.

    Attributes:
        drive: the joint that moves the fingers, and how.
        opening_max_m: how wide it opens.
        finger_length_m, finger_width_m, finger_thickness_m: a finger's size: along the approach axis, across the
            closing axis, along it.
        pinch: how it pinches.
        speed: the top speed of the driven joint, rad/s or m/s; None: the URDF's.
    """

    drive: Annotated[LinearDrive | ParallelogramDrive, Field(discriminator="kind")]
    opening_max_m: Annotated[float, Interval(gt=0.0, le=0.5)]
    finger_length_m: Length
    finger_width_m: Length
    finger_thickness_m: Length
    pinch: Pinch = Pinch()
    speed: Rate | None = None

    def __post_init__(self) -> None:
        """Refuse sizes out of bounds, and fingers that would open further than their links are long."""
        require_intervals(self, RobotError)
        if isinstance(self.drive, ParallelogramDrive):
            length_m = math.hypot(self.drive.link_x_m, self.drive.link_y_m)
            if not 0.5 * self.opening_max_m + self.drive.link_y_m < length_m:
                said = f"links of {length_m:g} m do not open fingers by {self.opening_max_m:g} m"
                raise RobotError("drive.link_x_m", said)


@dataclass(frozen=True, slots=True)
class ToolFile:
    """The tool: the point between the fingertips.

    Attributes:
        link: the link or frame it is fixed to.
        approach: the direction in which the fingers point, in that frame.
        closing: the direction along which they close, in that frame.
        offset_m: where the tool is in that frame.
    """

    link: str
    approach: Point3
    closing: Point3
    offset_m: Point3 = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if max(map(abs, self.offset_m)) > TOOL_MAX_M:
            raise RobotError("offset_m", f"{list(self.offset_m)} is more than {TOOL_MAX_M:g} m away")


@dataclass(frozen=True, slots=True)
class CameraFile:
    """A camera: its picture, and its pose in the frame of a link or of the table; z ahead, x right, y down.

    Attributes:
        x_m, y_m, z_m: the position of its lens.
        roll_rad, pitch_rad, yaw_rad: the rotation, as in a URDF.
        width_px, height_px: the size of its picture.
        field_of_view_rad: the angle between the left and the right edge of the picture.
        link: the link that carries it; None: it hangs over the table, and the pose is in the table's frame.
    """

    x_m: _Place = 0.0
    y_m: _Place = 0.0
    z_m: _Place = 0.0
    roll_rad: _Angle = 0.0
    pitch_rad: _Angle = 0.0
    yaw_rad: _Angle = 0.0
    width_px: Annotated[int, Interval(ge=160, le=1920)] = 640
    height_px: Annotated[int, Interval(ge=120, le=1440)] = 480
    field_of_view_rad: Annotated[float, Interval(ge=0.1, le=2.6)] = 1.0
    link: str | None = None

    def __post_init__(self) -> None:
        require_intervals(self, RobotError)
