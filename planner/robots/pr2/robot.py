"""The PR2, with its card, its reach and its joints."""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import RobotCard
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.comfort_reach import Memories
from planner.robots.described_card import card_on
from planner.robots.described_robot import lift_limits
from planner.robots.edge_grip import HandShape
from planner.robots.known_robots import read_card, shipped_path
from planner.robots.pr2.arm import MIRROR, read_arm
from planner.robots.pr2.description import package_directory, read_model, urdf_path
from planner.robots.pr2.mirrored_arm import MirroredArm
from planner.robots.pr2.part_shapes import pr2_parts
from planner.robots.pr2.posture_room import Room, room_beside
from planner.robots.pr2.reach import Pr2Reach


def pr2_card(model: pin.Model) -> RobotCard:
    """Return the card of a PR2, with numbers from its kinematic tree."""
    described = read_card(shipped_path("pr2"))
    card = card_on(described, model, lift_limits(model, described), urdf_path(), package_directory())
    left, right = card.arms
    return replace(card, arms=(left, replace(right, is_mirrored=True)), eye_frame="head_plate_frame")


def _mirrored(joints: FloatArray) -> FloatArray:
    left, right = np.split(joints, 2, axis=1)
    return np.concatenate([right * MIRROR, left * MIRROR], axis=1)


class Pr2(ArmedRobot):
    """A PR2; the base frame is ``base_footprint``."""

    can_mind_arms = True

    def __init__(self) -> None:
        """Read the robot's description (10 ms); raise `FoldingError` where it is missing."""
        self._model = read_model()
        super().__init__(pr2_card(self._model))
        self._rooms: dict[tuple[float, bool], Room] = {}

    @cached_property
    def _arms(self) -> tuple[MirroredArm, ...]:
        shape = read_arm(self._model)
        return MirroredArm(shape, is_mirrored=False), MirroredArm(shape, is_mirrored=True)

    @property
    def mirror(self) -> Callable[[FloatArray], FloatArray]:
        """The mirror image of configurations, shape (n, 14)."""
        return _mirrored

    def _reach(
        self, torso_m: float, comfort_m: float, memories: Memories | None, *, minds_body: bool, minds_arms: bool
    ) -> Pr2Reach:
        names = tuple(arm.name for arm in self.card.arms)
        room = self._room(torso_m, minds_arms) if minds_body else None
        return Pr2Reach(names, self._arms, torso_m, comfort_m, room, memories)

    def _room(self, torso_m: float, minds_arms: bool) -> Room:
        """Return the room that the body, and the other arm, leave an arm; cached, because every plan needs it."""
        key = (torso_m, minds_arms)
        if key not in self._rooms:
            home = self.home(1) if minds_arms else None
            others = {known: room for known, room in self._rooms.items() if known[0] == torso_m}
            self._rooms = {**others, key: room_beside(self._arms[0].shape, self._parts, torso_m, home)}
        return self._rooms[key]

    def _hand_shape(self, arm: int) -> HandShape:
        """Return an arm's hand; shapes of both are those of the left one."""
        return HandShape.of(self._parts, arm, np.array([self._arms[arm].shape.tool, 0.0, 0.0]), np.eye(3))

    @cached_property
    def _parts(self) -> RobotParts:
        """The parts that may collide; 15 ms the first time, a second where the cache of shapes is empty."""
        return pr2_parts(self._model, self.card)
