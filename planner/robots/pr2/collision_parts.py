"""The PR2's parts: the left arm's, then the right arm's as their mirror images, then the body's."""

from pathlib import Path

import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.card import RobotCard
from planner.robots.collision.part_poses import Index
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.pr2.arm import MIRROR, read_arm
from planner.robots.pr2.arm_poses import EACH
from planner.robots.pr2.part_shapes import OPENINGS_M, finger_key, part_shapes
from planner.robots.pr2.parts import (
    ARM_PARTS,
    BODY_PARTS,
    ELBOW,
    FINGERS,
    FINGERTIPS,
    PALM,
    pairs_in_arm,
    pairs_with_body,
)


def pr2_parts(model: pin.Model, card: RobotCard, cache: Path | None = None) -> RobotParts:
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
    first = [EACH * arm for arm in range(2)]
    number = np.arange(2 * EACH + len(body))
    return RobotParts(
        kinematics=read_arm(model),
        arms=np.array([(low, low + PALM, low + EACH, len(MIRROR)) for low in first]),
        names=(*(f"{one.name} {part.name}" for one in card.arms for part in ARM_PARTS), *body),
        openings_m=OPENINGS_M,
        hulls=tuple(tuple(shapes[name] for name in (*arm, *arm, *body)) for arm in arms),
        convexes=tuple((*map(left.get, arm), *map(right.get, arm), *map(left.get, body)) for arm in arms),
        is_mirrored=(number >= EACH) & (number < 2 * EACH),
        is_tip=(number % EACH == FINGERTIPS) & (number < 2 * EACH),
        low_parts=tuple(low + ELBOW for low in first),
        own_pairs=tuple(_own_pairs(low) for low in first),
        body_poses=_body_poses(model, card),
        is_lifted=np.array([part.joint != "universe" for part in BODY_PARTS]),
        mirror=MIRROR,
    )


def _own_pairs(low: int) -> Index:
    """Return the pairs of an arm's parts, from a number on, with the body and with each other."""
    with_body = [(low + part, 2 * EACH + body) for part, body in pairs_with_body()]
    return np.array(with_body + [(low + outer, low + inner) for outer, inner in pairs_in_arm()])


def _fingers(opening_m: float) -> tuple[str, ...]:
    return tuple(finger_key(part, opening_m) for part in range(FINGERS, len(ARM_PARTS)))


def _body_poses(model: pin.Model, card: RobotCard) -> FloatArray:
    data, q = model.createData(), pin.neutral(model)
    for name, angle in card.resting:
        q[model.joints[model.getJointId(name)].idx_q] = angle
    pin.forwardKinematics(model, data, q)
    placements = [data.oMi[model.getJointId(part.joint)] for part in BODY_PARTS]
    return np.array([np.vstack([one.rotation, one.translation]) for one in placements])
