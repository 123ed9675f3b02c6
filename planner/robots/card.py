"""A robot's card: the data to show, place and describe the robot."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray

HELD_M = 0.001
"""The fingers' opening while they hold cloth at its edge (m): its layers, pressed."""

EDGE_OPEN_M = 0.01
"""The opening with which one finger slides under the cloth at its edge and the other over it (m)."""

OPENING_M = 0.06
"""Default upper limit of the fingers' opening where they are compared with other things (m)."""

RAISED_MAX_M, LOWERED_MAX_M = 0.004, 0.03
"""How far above and below the height of its path a hand may take cloth and let go of it (m)."""


RISE_S = 0.25
"""The time in which a joint comes to its top speed, where a card gives no acceleration (s); a URDF never does."""

FINGER_RISE_S = 0.08
"""The same for the joint that drives fingers, which weigh little."""


@dataclass(frozen=True, slots=True)
class LinearGripper:
    """Fingers whose opening is proportional to the way of one joint.

    Attributes:
        joint_name: the joint that drives both fingers.
        closed: its value where they touch (rad, m).
        opened: its value where they are as wide open as they go (rad, m).
        opening_max_m: the widest opening (m).
        finger_width_m: a finger's width across the closing direction (m).
        speed: the top speed of the driven joint (rad/s, m/s).
    """

    joint_name: str
    closed: float
    opened: float
    opening_max_m: float
    finger_width_m: float
    speed: float

    def angle(self, opening_m: float) -> float:
        """Return the driven joint at which the fingers are an opening apart (m), clipped to 0..opening_max_m."""
        share = min(max(opening_m / self.opening_max_m, 0.0), 1.0)
        return self.closed + share * (self.opened - self.closed)

    def least_s(self, wide_m: float, narrow_m: float) -> float:
        """Return the least time to go from one opening (m) to a narrower one, or back (s)."""
        return abs(self.angle(wide_m) - self.angle(narrow_m)) / self.speed


@dataclass(frozen=True, slots=True)
class ParallelogramGripper:
    """Two fingers on parallelograms: they swing out and stay parallel.

    Attributes:
        joint_name: the joint that drives both fingers.
        link_x_m: how far the fingertip's hinge is ahead of the driven hinge, gripper closed (m).
        link_y_m: how far it is to the side of the driven hinge (m).
        opening_max_m: the widest opening (m).
        finger_width_m: a finger's width across the closing direction (m).
        speed: the top speed of the driven joint (rad/s).
    """

    joint_name: str
    link_x_m: float
    link_y_m: float
    opening_max_m: float
    finger_width_m: float
    speed: float

    def angle(self, opening_m: float) -> float:
        """Return the driven joint (rad) at which the fingers are an opening apart (m), clipped to 0..opening_max_m.

        The hinge is at y = link_x sin(q) + link_y cos(q) from the driven joint, and that has grown by half of the
        opening since q = 0.
        """
        half = 0.5 * min(max(opening_m, 0.0), self.opening_max_m)
        length = math.hypot(self.link_x_m, self.link_y_m)
        return math.asin((half + self.link_y_m) / length) - math.asin(self.link_y_m / length)

    def least_s(self, wide_m: float, narrow_m: float) -> float:
        """Return the least time to go at constant speed from one opening (m) to a narrower one, or back (s).

        Per metre the driven joint turns most where the fingers are widest apart.
        """
        ahead = math.sqrt(self.link_x_m**2 + self.link_y_m**2 - (0.5 * wide_m + self.link_y_m) ** 2)
        return 0.5 * (wide_m - narrow_m) / ahead / self.speed


GripperCard: TypeAlias = LinearGripper | ParallelogramGripper
"""A gripper of two fingers that one joint drives; the others mimic it."""


@dataclass(frozen=True, slots=True)
class ArmCard:
    """An arm.

    Attributes:
        name: its name for people.
        joint_names: its joints in the URDF, from the shoulder outwards.
        speeds_rad_s: their top speeds (rad/s).
        is_continuous: which of them turn without end.
        tool_frame: the URDF frame between the fingertips, x along the approach axis.
        home: the joints when the arm is out of the way (rad).
        gripper: its gripper.
        limits: the lowest and highest value of each joint (rad, m), soft limits kept; infinite for endless ones.
        lifting: the joints that raise its elbow and hand: as at home they take an empty hand high above a table.
        is_mirrored: whether it is built as the mirror image of an arm on the left: its hand then rolls the other way.
        accelerations: its joints' top accelerations (rad/s2, m/s2); None where nobody has said.
    """

    name: str
    joint_names: tuple[str, ...]
    speeds_rad_s: tuple[float, ...]
    is_continuous: tuple[bool, ...]
    tool_frame: str
    home: tuple[float, ...]
    gripper: GripperCard
    limits: tuple[tuple[float, float], ...]
    lifting: tuple[str, ...] = ()
    is_mirrored: bool = False
    accelerations: tuple[float, ...] | None = None

    @property
    def kept_accelerations(self) -> tuple[float, ...]:
        """The accelerations that motions keep: the given ones, or those with which joints rise in `RISE_S`."""
        return self.accelerations or tuple(speed / RISE_S for speed in self.speeds_rad_s)


@dataclass(frozen=True, slots=True)
class RobotCard:
    """A robot.

    Attributes:
        name: the name it is loaded by.
        title: the name for people.
        arms: its arms, from left to right as the robot sees them.
        base_kind: how the base moves; ``fixed`` where it does not.
        base_size_m: length and width of the base (m).
        base_radius_m: radius of a circle that contains the base as it turns, a margin included (m).
        lift_joint: the joint that raises the shoulders; None without a lift.
        lift_limits_m: its lowest and highest value (m); 0 and 0 without a lift.
        resting: all other actuated joints and where they rest, as (name, rad).
        urdf_path: the robot's description.
        package_dir: the directory to which its ``package://`` addresses are relative.
        eye_frame: the URDF frame of its eyes; None without a head.
        base_acceleration_m_s2: the base's top acceleration.
    """

    name: str
    title: str
    arms: tuple[ArmCard, ...]
    base_kind: str
    base_size_m: tuple[float, float]
    base_radius_m: float
    lift_joint: str | None
    lift_limits_m: tuple[float, float]
    resting: tuple[tuple[str, float], ...]
    urdf_path: Path
    package_dir: Path
    eye_frame: str | None = None
    base_acceleration_m_s2: float = 0.5

    @property
    def is_fixed(self) -> bool:
        """Whether the base does not move."""
        return self.base_kind == "fixed"

    def still_values(self, torso_m: float) -> dict[str, float]:
        """Return the joints that do not move in a plan by name, with the lift raised (m): rad; m for the lift."""
        lift = {} if self.lift_joint is None else {self.lift_joint: float(torso_m)}
        return lift | dict(self.resting)

    def home_values(self, torso_m: float) -> dict[str, float]:
        """Return every actuated joint by name (rad; m for the lift) with the arms at home and the grippers closed."""
        return self.joint_values(torso_m, [np.array(arm.home) for arm in self.arms], [0.0] * len(self.arms))

    def joint_values(
        self, torso_m: float, arm_joints: Sequence[FloatArray], openings_m: Sequence[float]
    ) -> dict[str, float]:
        """Return every actuated joint of the URDF by name (rad; m for the lift), as plain floats.

        Args:
            torso_m: how far the lift is raised (m).
            arm_joints: the joints of each arm, from left to right.
            openings_m: how far each gripper is open (m).

        Raises:
            ValueError: the numbers of arms or openings differ from the robot's arms, or an arm has other joints.
        """
        values = self.still_values(torso_m)
        for arm, joints, opening_m in zip(self.arms, arm_joints, openings_m, strict=True):
            values |= {name: float(q) for name, q in zip(arm.joint_names, joints, strict=True)}
            values[arm.gripper.joint_name] = arm.gripper.angle(float(opening_m))
        return values


@dataclass(frozen=True, slots=True, eq=False)
class JointLayout:
    """The joints of all arms in a configuration: one row, one arm after the other.

    So arms may have different numbers of joints, and one array, shape (n, joints), holds a whole motion.

    Attributes:
        spans: each arm's part of a configuration.
        owners: the arm of each joint, shape (joints,).
        home: all arms out of the way (rad), shape (joints,).
        speeds_rad_s: the top speeds, shape (joints,).
        accelerations: the top accelerations (rad/s2), shape (joints,).
        is_continuous: which joints turn without end, shape (joints,).
        is_lifting: which joints raise an arm's elbow and hand, shape (joints,).
        ranges: the lowest and highest values (rad, m), infinite for endless joints, shape (joints, 2).
    """

    spans: tuple[slice, ...]
    owners: NDArray[np.int64]
    home: FloatArray
    speeds_rad_s: FloatArray
    accelerations: FloatArray
    is_continuous: BoolArray
    is_lifting: BoolArray
    ranges: FloatArray

    @staticmethod
    def of(card: RobotCard) -> "JointLayout":
        """Return the layout of a robot's arms, from left to right."""
        counts = [len(arm.joint_names) for arm in card.arms]
        ends = np.cumsum([0, *counts]).tolist()
        lifting = [name in arm.lifting for arm in card.arms for name in arm.joint_names]
        return JointLayout(
            tuple(slice(start, end) for start, end in pairwise(ends)),
            np.repeat(np.arange(len(counts)), counts),
            np.array([q for arm in card.arms for q in arm.home], dtype=float),
            np.array([speed for arm in card.arms for speed in arm.speeds_rad_s], dtype=float),
            np.array([own for arm in card.arms for own in arm.kept_accelerations], dtype=float),
            np.array([turns for arm in card.arms for turns in arm.is_continuous], dtype=np.bool_),
            np.array(lifting, dtype=np.bool_),
            np.array([ends for arm in card.arms for ends in arm.limits], dtype=float),
        )

    @property
    def arms(self) -> range:
        """The arms' indices."""
        return range(len(self.spans))

    def at_home(self, count: int) -> FloatArray:
        """Return configurations with all arms at home, shape (count, joints); a new array."""
        return np.tile(self.home, (count, 1))

    def joints_of(self, arms: Iterable[int]) -> slice | NDArray[np.int64]:
        """Return the indices of some arms' joints in a configuration; arms in rising order."""
        chosen = tuple(arms)
        if chosen == tuple(self.arms):
            return slice(None)
        return np.flatnonzero(np.isin(self.owners, chosen))
