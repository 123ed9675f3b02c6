"""Group a robot's links that move as one: by the arm's joint that carries them, as its fingers, or with the body."""

from dataclasses import dataclass
from itertools import accumulate
from operator import mul

import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.card_parts import GripperFile
from planner.robots.chain import Chain
from planner.robots.chain_reader import at_rest, set_joint
from planner.robots.collision.link_shapes import LinkShape
from planner.robots.described_card import gripper_card
from planner.robots.described_robot import DescribedArm, DescribedRobot
from planner.robots.urdf_reader import mimics_of, parsed

BODY = -1
"""Stands for the arm of what belongs to no arm."""

SWEEP = 33
"""Postures of the fingers between closed and open."""


@dataclass(frozen=True, slots=True, order=True)
class Carrier:
    """The carrier of a link: an arm's joint, its fingers, or the body.

    Attributes:
        arm: the arm's number, or `BODY`.
        joint: which of the arm's joints; of the body 1 for what the lift raises and 0 for the rest.
        is_finger: whether the gripper moves it.
    """

    arm: int
    joint: int
    is_finger: bool = False


class Skeleton:
    """A robot's kinematic tree with its lift down, the arms' joints at 0 and all others at rest.

    Attributes:
        model: the tree.
        frames: the frames of each arm's joints in the base frame, as the arm's chain has them.
    """

    def __init__(self, robot: DescribedRobot) -> None:
        """Read the tree, and which joints mimic which."""
        self.model = pin.buildModelFromXML(robot.urdf)
        self.frames = tuple(_frames(arm) for arm in robot.arms)
        self._arms, self._lift = robot.arms, robot.card.lift
        self._moving = frozenset(name for arm in robot.arms for name in arm.card.joints)
        self._q = at_rest(self.model, dict(robot.card.resting), sorted(self._moving))
        self._data = self.model.createData()  # once: for a robot of a hundred joints it takes 24 ms
        self._places = self._at(self._q)
        self._mimics = mimics_of(parsed(robot.urdf.encode()).iterfind("joint"))

    def carrier(self, joint: int) -> Carrier:
        """Return what carries the links of a joint of pinocchio's model."""
        supports = [self.model.names[number] for number in self.model.supports[joint]]
        best, depth = Carrier(BODY, int(self._lift in supports)), -1
        for number, arm in enumerate(self._arms):
            carrying = [index for index, name in enumerate(arm.card.joints) if name in supports]
            # Arms may share their first joints, so the one that moves the link last is the one it belongs to.
            if carrying and (at := supports.index(arm.card.joints[carrying[-1]])) > depth:
                is_finger = not self._fingers(arm.card.gripper).keys().isdisjoint(supports)
                best, depth = Carrier(number, carrying[-1], is_finger), at
        return best

    def points(self, shape: LinkShape) -> FloatArray:
        """Return a shape's points in the frame of its carrier: of an arm's joint, or the base frame (m)."""
        return _moved(self._place(shape, self._places), shape.corners)

    def placement(self, shape: LinkShape) -> pin.SE3:
        """Return where a shape is in the frame of its carrier."""
        return self._place(shape, self._places) * shape.placement

    def swept(self, shape: LinkShape, opening_m: float) -> tuple[FloatArray, float]:
        """Return a finger's points on its way from closed to an opening, in the frame of the joint that carries it.

        Returns:
            The points, and how far outside of their hull points between them may be (m).
        """
        gripper = self._arms[self.carrier(shape.joint).arm].card.gripper
        low, high = (gripper_card(self.model, gripper).angle(at_m) for at_m in (0.0, opening_m))
        values = np.linspace(low, high, SWEEP if high != low else 1)
        ways = [_moved(self._driven(shape, gripper, value), shape.corners) for value in values]
        # A curve in small steps is off its chords by an eighth of its second differences.
        bent = np.linalg.norm(np.diff(ways, n=2, axis=0), axis=2)
        return np.vstack(ways), float(bent.max(initial=0.0)) / 8.0

    def placement_open(self, shape: LinkShape, opening_m: float) -> pin.SE3:
        """Return where a finger's shape is at an opening (m), in the frame of the joint that carries it."""
        gripper = self._arms[self.carrier(shape.joint).arm].card.gripper
        return self._driven(shape, gripper, gripper_card(self.model, gripper).angle(opening_m)) * shape.placement

    def _driven(self, shape: LinkShape, gripper: GripperFile, value: float) -> pin.SE3:
        """Return where a finger's joint is, in the frame of its carrier, at a value of the driving joint."""
        q = self._q.copy()
        for name, (factor, offset) in self._fingers(gripper).items():
            set_joint(self.model, q, name, factor * value + offset)
        return self._place(shape, self._at(q))

    def _place(self, shape: LinkShape, places: list[pin.SE3]) -> pin.SE3:
        """Return where a shape's joint is in the frame of its carrier."""
        carrier = self.carrier(shape.joint)
        place = places[shape.joint]
        return place if carrier.arm == BODY else self.frames[carrier.arm][carrier.joint].actInv(place)

    def _at(self, q: FloatArray) -> list[pin.SE3]:
        pin.forwardKinematics(self.model, self._data, q)
        return [place.copy() for place in self._data.oMi]

    def _fingers(self, gripper: GripperFile) -> dict[str, tuple[float, float]]:
        """Return the joints that a gripper moves, none of an arm or fixed, each with its factor and offset."""
        driver = gripper.drive.joint
        found = {driver: (1.0, 0.0)} | {
            name: (factor, offset) for name, (driven_by, factor, offset) in self._mimics.items() if driven_by == driver
        }
        return {
            name: how for name, how in found.items() if self.model.existJointName(name) and name not in self._moving
        }


def _frames(arm: DescribedArm) -> tuple[pin.SE3, ...]:
    """Return the frames of an arm's joints in the base frame, all of them at 0."""
    chain: Chain = arm.chain
    steps = [pin.SE3(turn, place) for turn, place in zip(chain.rotations, chain.offsets, strict=True)]
    return tuple(accumulate(steps, mul, initial=pin.SE3(np.eye(3), arm.root)))[1:]


def _moved(by: pin.SE3, points: FloatArray) -> FloatArray:
    moved: FloatArray = points @ by.rotation.T + by.translation
    return moved
