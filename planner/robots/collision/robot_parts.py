"""The PR2's parts with everything about them that does not depend on the posture."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.arm import ArmShape, read_arm
from planner.robots.card import RobotCard
from planner.robots.collision.part_shapes import OPENINGS_M, finger_key, part_shapes
from planner.robots.collision.parts import ARM_PARTS, BODY_PARTS, FINGERS
from planner.robots.collision.rounded_hull import RoundedHull
from planner.robots.collision.separation import Parts


@dataclass(frozen=True, slots=True, eq=False)
class RobotParts:
    """The PR2's parts: the left arm's, then the right arm's, then the body's.

    Attributes:
        arm: lengths and limits of the left arm.
        names: the name of each part for people.
        hulls: for each of `OPENINGS_M` the parts' shapes, those of the right arm as the left arm's.
        convexes: the same shapes for coal, those of the right arm mirrored.
        body_poses: rotations and, in their last row, positions (m) of the body's parts in the base frame, with the
            torso down, shape (b, 4, 3).
    """

    arm: ArmShape
    names: tuple[str, ...]
    hulls: tuple[tuple[RoundedHull, ...], ...]
    convexes: tuple[tuple[coal.Convex, ...], ...]
    body_poses: FloatArray


def robot_parts(model: pin.Model, card: RobotCard, cache: Path | None = None) -> RobotParts:
    """Return the parts of the PR2 (15 ms; a second when the cache has no shapes yet).

    Args:
        model: its kinematic tree.
        card: the robot's card, with the rest pose of head and laser and the kinematics of the fingers.
        cache: the cache directory; None: the platform's own.
    """
    shapes = part_shapes(model, card.arms[0].gripper, cache)
    left, right = {}, {}
    for name, shape in shapes.items():
        left[name], right[name] = shape.convex(), shape.mirrored().convex()
    body = [part.name for part in BODY_PARTS]
    arms = [[*(part.name for part in ARM_PARTS[:FINGERS]), *_fingers(opening_m)] for opening_m in OPENINGS_M]
    return RobotParts(
        arm=read_arm(model),
        names=(*(f"{one.name} {part.name}" for one in card.arms for part in ARM_PARTS), *body),
        hulls=tuple(tuple(shapes[name] for name in (*arm, *arm, *body)) for arm in arms),
        convexes=tuple((*map(left.get, arm), *map(right.get, arm), *map(left.get, body)) for arm in arms),
        body_poses=_body_poses(model, card),
    )


def _fingers(opening_m: float) -> tuple[str, ...]:
    return tuple(finger_key(part, opening_m) for part in range(FINGERS, len(ARM_PARTS)))


def compiled_parts(robot: RobotParts, level: int, clouds: Sequence[FloatArray] = ()) -> Parts:
    """Return the robot's parts, and the hulls of point clouds, in the form of the compiled pass.

    Args:
        robot: the robot's parts.
        level: the index in `OPENINGS_M` of the fingers' opening.
        clouds: the points of each hull, shape (n, 3), m; these hulls come last.
    """
    parts = _compiled_robot(robot, level)
    if not clouds:
        return parts
    others = _compiled(clouds, np.zeros(len(clouds)))
    spans = others.spans + len(parts.corners)
    return Parts(*(np.vstack(both) for both in zip(parts, others._replace(spans=spans), strict=True)))


@lru_cache(maxsize=len(OPENINGS_M))
def _compiled_robot(robot: RobotParts, level: int) -> Parts:
    hulls = robot.hulls[level]
    return _compiled([hull.corners for hull in hulls], np.array([hull.radius_m for hull in hulls]))


def _compiled(clouds: Sequence[FloatArray], rounding: FloatArray) -> Parts:
    low, high = (np.array([limit(cloud, axis=0) for cloud in clouds]) for limit in (np.min, np.max))
    middle, half = (low + high) / 2, (high - low) / 2 + rounding[:, None]
    radius = [np.linalg.norm(cloud - at, axis=1).max() for cloud, at in zip(clouds, middle, strict=True)] + rounding
    last = np.cumsum([len(cloud) for cloud in clouds])
    spans = np.column_stack([last - [len(cloud) for cloud in clouds], last])
    return Parts(np.vstack(clouds), spans, np.column_stack([middle, half, radius, rounding]))


def _body_poses(model: pin.Model, card: RobotCard) -> FloatArray:
    data, q = model.createData(), pin.neutral(model)
    for name, angle in card.resting:
        q[model.joints[model.getJointId(name)].idx_q] = angle
    pin.forwardKinematics(model, data, q)
    placements = [data.oMi[model.getJointId(part.joint)] for part in BODY_PARTS]
    return np.array([np.vstack([one.rotation, one.translation]) for one in placements])
