"""An independent check of described robots' collisions: pinocchio reads the URDF's shapes, coal compares their hulls.

Nothing of `planner.robots.collision` is used. Every shape for collisions is a hull of its own, or what is shown of a
link that has none; the table is of boxes.
"""

import math
from collections.abc import Iterator, Mapping
from itertools import combinations
from xml.etree.ElementTree import tostring

import coal
import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import table_parts
from planner.robots.card_parts import ParallelogramDrive
from planner.robots.described_robot import DescribedRobot
from planner.robots.urdf_reader import parsed

NEAR = 3
"""Hulls of links with up to so many joints between them may overlap where the links do not."""


class Hulls:
    """A robot at the table of its scene, posed and compared by pinocchio.

    `must` counts the pairs that any check has to compare, `may` those besides of which it may leave some out.
    """

    def __init__(self, robot: DescribedRobot) -> None:
        self.robot = robot
        self.model = pin.buildModelFromXML(robot.urdf)
        self.shapes = pin.GeometryModel()
        urdf = parsed(robot.urdf.encode())
        for link in urdf.iterfind("link"):
            for shown in link.findall("visual") if link.find("collision") is not None else ():
                link.remove(shown)
        text = tostring(urdf, encoding="unicode")
        kinds_of_shape = (pin.GeometryType.COLLISION, pin.GeometryType.VISUAL)
        read = [pin.buildGeomFromUrdfString(self.model, text, kind) for kind in kinds_of_shape]
        for one in (*read[0].geometryObjects, *read[1].geometryObjects):
            if isinstance(one.geometry, coal.BVHModelBase):
                one.geometry.buildConvexHull(True, "Qt")
                one.geometry = one.geometry.convex
            self.shapes.addGeometryObject(one)
        self.count = len(self.shapes.geometryObjects)
        self.whose = [self._owner(one.parentJoint) for one in self.shapes.geometryObjects]
        for part in table_parts(robot.card.scene.table):
            box = pin.GeometryObject(part.name, 0, pin.SE3.Identity(), coal.Box(*part.size))
            self.shapes.addGeometryObject(box)
        kinds = {pair: self._kind(*pair) for pair in combinations(range(len(self.shapes.geometryObjects)), 2)}
        self.pairs = [pair for pair, kind in kinds.items() if kind]
        self.is_must = np.array([kinds[pair] == "must" for pair in self.pairs])
        self.is_between_arms = np.array([self._is_between_arms(*pair) for pair in self.pairs])
        for pair in self.pairs:
            self.shapes.addCollisionPair(pin.CollisionPair(*pair))
        self.data = self.model.createData()

    def _owner(self, joint: int) -> tuple[int, int]:
        """Return the arm that moves a joint's links, and with which of its joints; -1 and -1 for the body."""
        names = {self.model.names[number] for number in self.model.supports[joint]}
        for arm, described in enumerate(self.robot.arms):
            found = [number for number, name in enumerate(described.card.joints) if name in names]
            if found:
                return arm, found[-1]
        return -1, -1

    def _kind(self, a: int, b: int) -> str | None:
        if a >= self.count:
            return None
        (arm, joint), is_fixed = self.whose[a], self.robot.card.base.kind == "fixed"
        if b >= self.count:
            return None if arm < 0 and is_fixed else "must"
        other, outer = self.whose[b]
        if arm < 0 and other < 0:
            return None
        if arm >= 0 and other >= 0 and arm != other:
            return "may" if joint == outer == 0 else "must"
        between = abs(joint - outer)
        return None if between < 2 else "may" if between <= NEAR else "must"

    def _is_between_arms(self, a: int, b: int) -> bool:
        arms = {self.whose[number][0] for number in (a, b) if number < self.count}
        return len(arms) == 2 and -1 not in arms

    def names(self, pair: int) -> tuple[str, str]:
        """Return the names of the shapes of a pair."""
        a, b = (self.shapes.geometryObjects[number].name for number in self.pairs[pair])
        return a, b

    def values(self, joints: FloatArray, openings_m: FloatArray, torso_m: float) -> dict[str, float]:
        """Return all joints that do not rest at 0."""
        card, values = self.robot.card, dict(self.robot.card.resting)
        if card.lift is not None:
            values[card.lift] = torso_m
        values |= zip((name for arm in card.arms for name in arm.joints), joints.tolist(), strict=True)
        for arm, opening_m in zip(card.arms, openings_m, strict=True):
            drive, share = arm.gripper.drive, opening_m / arm.gripper.opening_max_m
            assert not isinstance(drive, ParallelogramDrive)
            value = drive.closed + share * (drive.opened - drive.closed)
            moved = {drive.joint: value} | dict(_mimicking(self.robot.urdf, drive.joint, value))
            values |= {name: at for name, at in moved.items() if self.model.existJointName(name)}
        return values

    def touching(self, values: Mapping[str, float], base: Pose2) -> np.ndarray:
        """Return which of the pairs penetrate each other."""
        q = pin.neutral(self.model)
        for name, value in values.items():
            joint = self.model.joints[self.model.getJointId(name)]
            q[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [math.cos(value), math.sin(value)]
        stand = pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, base.yaw_rad), np.array([base.x_m, base.y_m, 0.0]))
        table = self.robot.card.scene.table
        for number, part in enumerate(table_parts(table), start=self.count):
            place = np.add(part.center, (0.0, 0.0, table.height_m))
            self.shapes.geometryObjects[number].placement = stand.actInv(pin.SE3(np.eye(3), place))
        data = self.shapes.createData()
        pin.computeCollisions(self.model, self.data, self.shapes, data, q, False)
        return np.array([one.isCollision() for one in data.collisionResults])


def _mimicking(urdf: str, driver: str, value: float) -> Iterator[tuple[str, float]]:
    """Yield the joints that mimic a driver, and their values."""
    for joint in parsed(urdf.encode()).iterfind("joint"):
        mimic = joint.find("mimic")
        if mimic is not None and mimic.get("joint") == driver:
            yield joint.get("name", ""), float(mimic.get("multiplier", 1.0)) * value + float(mimic.get("offset", 0.0))
