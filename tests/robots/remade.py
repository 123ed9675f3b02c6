"""Robots of any number of arms, each one of a PR2's, mounted where somebody says: for tests of what counts arms.

An arm is that of a PR2 that stands elsewhere, so its kinematics and its collisions with the table are a PR2's. What
touches what among these arms is simple: the hands of arms of one PR2 as theirs do, hands of others if they are not in
the order of their arms from left to right, `HANDS_APART_M` apart. An arm may have joints that do nothing.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from planner.deadline import Deadline
from planner.geometry.pose import BoolArray, FloatArray, Point3, Pose2
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.geometry.table import Table
from planner.robots.arm_paths import Together, arm_paths, arm_searches
from planner.robots.card import ArmCard, JointLayout, ParallelogramGripper, RobotCard
from planner.robots.collision.collisions import Clearance, Collisions, Contact
from planner.robots.pr2.mirrored_arm import MirroredArm
from planner.robots.pr2.reach import Pr2Reach
from planner.robots.pr2.robot import Pr2
from planner.robots.tool_path import IsFree, NoPath, ToolPath

HANDS_APART_M = 0.2

WITHOUT_LIFT_M = 0.29


@dataclass(frozen=True, slots=True)
class Mounted:
    """An arm of a robot.

    Attributes:
        name: its name.
        of: the PR2's arm that it is: 0 the left one, 1 the right one.
        aside_m: how far further left it is mounted (m).
        idle: how many joints it has that do nothing.
    """

    name: str
    of: int
    aside_m: float = 0.0
    idle: int = 0

    @property
    def mount(self) -> FloatArray:
        return np.array([0.0, self.aside_m, 0.0])

    def stand(self, bases: Pose2 | FloatArray) -> FloatArray:
        """Where the PR2 stands whose arm it is, shape (n, 3)."""
        rows = np.array([[bases.x_m, bases.y_m, bases.yaw_rad]]) if isinstance(bases, Pose2) else np.array(bases)
        rows[:, 0] -= np.sin(rows[:, 2]) * self.aside_m
        rows[:, 1] += np.cos(rows[:, 2]) * self.aside_m
        return rows

    def bent(self, joints: FloatArray) -> FloatArray:
        """The PR2's joints among its own."""
        return np.ascontiguousarray(joints[..., : joints.shape[-1] - self.idle])

    def own(self, joints: FloatArray) -> FloatArray:
        """Its joints, those that do nothing at 0."""
        return np.concatenate([joints, np.zeros((*joints.shape[:-1], self.idle))], axis=-1)

    def card(self, arm: ArmCard) -> ArmCard:
        gripper = arm.gripper
        assert isinstance(gripper, ParallelogramGripper)
        names = tuple(f"{self.name}_{joint}" for joint in (*arm.joint_names, *(f"idle_{n}" for n in range(self.idle))))
        return replace(
            arm,
            name=self.name,
            joint_names=names,
            speeds_rad_s=(*arm.speeds_rad_s, *(1.0,) * self.idle),
            is_continuous=(*arm.is_continuous, *(False,) * self.idle),
            limits=(*arm.limits, *((-1.0, 1.0),) * self.idle),
            home=(*arm.home, *(0.0,) * self.idle),
            lifting=tuple(f"{self.name}_{joint}" for joint in arm.lifting),
            gripper=replace(gripper, joint_name=f"{self.name}_{gripper.joint_name}"),
        )


@dataclass(frozen=True, slots=True)
class ShiftedArm(MirroredArm):
    """A PR2's arm, asked in the frame of a base from which it is mounted further left."""

    aside_m: float = 0.0

    def mirrored_places(self, places: FloatArray) -> FloatArray:
        return MirroredArm.mirrored_places(self, places - np.array([0.0, self.aside_m, 0.0]))


class RemadeReach(Pr2Reach):
    """The reach of several arms."""

    _arms: tuple[ShiftedArm, ...]

    @property
    def shoulders(self) -> tuple[Point3, ...]:
        plain = [MirroredArm(arm.shape, arm.is_mirrored) for arm in self._arms]
        found = [arm.mirrored_places(arm.shoulder(self.torso_m)) for arm in plain]
        return tuple(
            (float(x), float(y) + arm.aside_m, float(z)) for arm, (x, y, z) in zip(self._arms, found, strict=True)
        )

    def _least_shortfall(self, place: ReachQuery, at_most_m: float, deadline: Deadline) -> tuple[Shortfall, int]:
        found, queries = super()._least_shortfall(place, at_most_m, deadline)
        x, y, z = found.towards
        shift = self._arms[place.arm].aside_m  # the direction was seen as if it were a place
        y += shift if not self._arms[place.arm].is_mirrored else -shift
        return replace(found, towards=(x, y, z)), queries


class RemadeRobot:
    """A robot that has these arms, from left to right."""

    can_mind_arms = False
    mirror = None

    def __init__(self, *arms: Mounted, **changes: Any) -> None:
        """Take its arms, and what of the card of a PR2 differs."""
        self.arms = arms
        self.pr2 = Pr2()
        cards = tuple(arm.card(self.pr2.card.arms[arm.of]) for arm in arms)
        self.card: RobotCard = replace(self.pr2.card, name="remade", arms=cards, **changes)
        shape = self.pr2._arms[0].shape
        self._kinematics = tuple(ShiftedArm(shape, arm.of == 1, arm.aside_m) for arm in arms)

    def reach(self, torso_m: float, comfort_m: float, *, minds_arms: bool = False) -> RemadeReach:
        names, torso_m = tuple(arm.name for arm in self.arms), self.raised(torso_m)
        return RemadeReach(names, self._kinematics, torso_m, comfort_m, self.pr2._room(torso_m, minds_arms))

    def collisions(self, table: Table, torso_m: float, **options: Any) -> "RemadeCollisions":
        raised_m = self.raised(torso_m)
        return RemadeCollisions(self, self.pr2.collisions(table, raised_m, **options), raised_m)

    def edge_raised_m(self, arm: int, height_m: float, pitch_rad: float) -> float | None:
        return self.pr2.edge_raised_m(self.arms[arm].of, height_m, pitch_rad)

    def raised(self, torso_m: float) -> float:
        """How far the PR2 is raised whose arms these are; without a lift always as far."""
        return WITHOUT_LIFT_M if self.card.lift_joint is None else torso_m

    def arm_paths(
        self,
        paths: Mapping[int, ToolPath],
        torso_m: float,
        floor_m: float,
        are_free: Mapping[int, IsFree],
        together: Together,
    ) -> FloatArray | NoPath:
        arms = [IdleArm(arm, self.pr2._arms[arm.of]) for arm in self.arms]
        seen = {number: self._seen(self.arms[number], path) for number, path in paths.items()}
        raised_m = self.raised(torso_m)
        return arm_paths(arm_searches(arms, self.card, seen, raised_m, floor_m, are_free), together)

    def arm_path_near(
        self, arm: int, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray
    ) -> FloatArray | None:
        one = self.arms[arm]
        found = self.pr2.arm_path_near(
            one.of, self._seen(one, path), self.raised(torso_m), self._own(one, is_free), one.bent(known)
        )
        return None if found is None else one.own(found)

    def free_postures(
        self,
        arm: int,
        position: FloatArray,
        rotation: FloatArray,
        torso_m: float,
        is_free: Callable[[FloatArray], BoolArray],
    ) -> FloatArray:
        one = self.arms[arm]
        found = self.pr2.free_postures(
            one.of, position - one.mount, rotation, self.raised(torso_m), lambda joints: is_free(one.own(joints))
        )
        return one.own(found)

    def tool_places(self, arm: int, joints: FloatArray, torso_m: float) -> FloatArray:
        one = self.arms[arm]
        return self.pr2.tool_places(one.of, one.bent(joints), self.raised(torso_m)) + one.mount

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        one = self.arms[arm]
        place, rotation = self.pr2.tool_pose(one.of, one.bent(joints[None])[0], self.raised(torso_m))
        return place + one.mount, rotation

    @staticmethod
    def _seen(arm: Mounted, path: ToolPath) -> ToolPath:
        return replace(path, positions=path.positions - arm.mount)

    @staticmethod
    def _own(arm: Mounted, is_free: IsFree) -> IsFree:
        return lambda steps, joints: is_free(steps, arm.own(joints))


class IdleArm:
    """A PR2's arm with joints that do nothing, as searches for joint paths see it."""

    def __init__(self, arm: Mounted, real: MirroredArm) -> None:
        self._arm = arm
        self._real = real

    @property
    def periods(self) -> FloatArray:
        return self._arm.own(self._real.periods)

    @property
    def stride(self) -> int:
        return self._real.stride

    def samples(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, floor_m: float
    ) -> tuple[FloatArray, FloatArray]:
        joints, costs = self._real.samples(positions, rotations, torso_m, floor_m)
        return self._arm.own(joints), costs

    def along(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, guides: FloatArray
    ) -> tuple[FloatArray, BoolArray]:
        joints, is_found = self._real.along(positions, rotations, torso_m, self._arm.bent(guides))
        return self._arm.own(joints), is_found

    def unwound(self, chain: FloatArray) -> FloatArray:
        return self._arm.own(self._real.unwound(self._arm.bent(chain)))

    def tool_places(self, joints: FloatArray, torso_m: float) -> FloatArray:
        return self._real.tool_places(self._arm.bent(joints), torso_m)


class RemadeClearance:
    """Arms high above cloth, each seen from its PR2."""

    def __init__(self, arms: Sequence[Mounted], real: Clearance) -> None:
        self._arms = arms
        self._real = real

    def arm_clear(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        one = self._arms[arm]
        return self._real.arm_clear(one.of, one.stand(bases), one.bent(joints))


class RemadeCollisions:
    """The collisions of a remade robot's arms."""

    def __init__(self, robot: RemadeRobot, real: Collisions, torso_m: float) -> None:
        self._robot = robot
        self._arms = robot.arms
        self._layout = JointLayout.of(robot.card)
        self._real = real
        self._torso_m = torso_m

    def arm_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        one = self._arms[arm]
        return self._real.arm_free(one.of, one.stand(bases), one.bent(joints))

    def is_arm_path_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        return bool(self.arm_free(arm, bases, joints).all())

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        counts = [len(self._robot.card.arms[arm].joint_names) for arm in arms]
        assert joints.shape[1] == sum(counts)
        of_arm = dict(zip(arms, np.split(joints, np.cumsum(counts)[:-1], axis=1), strict=True))
        apart = np.ones(len(joints), dtype=bool)
        for one, other in combinations(arms, 2):
            apart &= self._pair_apart((one, other), of_arm[one], of_arm[other])
        return apart

    def _pair_apart(self, pair: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        one, other = (self._arms[arm] for arm in pair)
        if (one.of, other.of) == (0, 1) and one.aside_m == other.aside_m:
            return self._real.arms_apart((0, 1), np.hstack([one.bent(first), other.bent(second)]))
        tools = [self._robot.tool_places(arm, q, self._torso_m) for arm, q in zip(pair, (first, second), strict=True)]
        return np.asarray(tools[0][:, 1] - tools[1][:, 1] > HANDS_APART_M)

    def postures_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        pairs = [self._pair_apart(arms, row[None].repeat(len(second), 0), second) for row in first]
        return np.array(pairs, dtype=bool).reshape(len(first), len(second))

    def are_some_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> bool:
        return bool(self.postures_apart(arms, first, second).any())

    def free_until(self, bases: Pose2 | FloatArray, joints: FloatArray) -> int:
        alone = [self.arm_free(arm, bases, joints[:, self._layout.spans[arm]]) for arm in self._layout.arms]
        are_free = np.all([*alone, self.arms_apart(tuple(self._layout.arms), joints)], axis=0)
        return int(np.append(are_free, False).argmin())

    def is_path_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        return self.free_until(bases, joints) == len(joints)

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> RemadeClearance:
        return RemadeClearance(self._arms, self._real.over_cloth(pieces, over_m))

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        if self.is_path_free(base_in_table, joints[None]):
            return None
        return Contact(f"{self._arms[0].name} palm", f"{self._arms[-1].name} palm", 0.01)


ONE_ARM = RemadeRobot(Mounted("single", of=0))
UNLIKE = RemadeRobot(Mounted("left", of=0, idle=1), Mounted("right", of=1))
THREE_ARMS = RemadeRobot(Mounted("outer", of=0, aside_m=0.45), Mounted("left", of=0), Mounted("right", of=1, idle=2))
BOLTED = RemadeRobot(
    Mounted("left", of=0), Mounted("right", of=1), base_kind="fixed", lift_joint=None, lift_limits_m=(0.0, 0.0)
)
