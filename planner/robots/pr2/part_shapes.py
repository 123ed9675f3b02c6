"""The parts of the PR2: the left arm's, then the right arm's as their mirror images, then the body's.

Their convex shapes are made once from the meshes and kept in the user's cache directory. The right arm's meshes are not
exact mirror images of the left arm's, and not quite symmetric themselves (5 mm). Each arm part therefore has the points
of the left arm and the mirrored points of the right arm, so that a mirrored posture is free exactly where the posture
is.
"""

import math
from collections.abc import Mapping
from hashlib import blake2b
from importlib.metadata import version
from itertools import product
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.card import EDGE_OPEN_M, HELD_M, GripperCard, RobotCard
from planner.robots.collision.part_poses import Index
from planner.robots.collision.part_source import EDGE_ROUNDING_MAX_M, ROUNDING_MAX_M, TIPS_ROUNDING_MAX_M
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.collision.rounded_hull import RoundedHull, hull_arrays, hull_from, rounded_hull
from planner.robots.kept_arrays import Arrays, kept
from planner.robots.pr2.arm import MIRROR, read_arm
from planner.robots.pr2.arm_poses import EACH
from planner.robots.pr2.description import package_directory, urdf_path
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
from planner.user_cache import cache_folder

_MIRROR = np.array([1.0, -1.0, 1.0])


def points_of_joints(model: pin.Model) -> dict[str, FloatArray]:
    """Return the points of everything that each joint moves, in its frame (m), shape (n, 3), by the joint's name."""
    found: dict[str, list[FloatArray]] = {}
    for kind in (pin.GeometryType.VISUAL, pin.GeometryType.COLLISION):
        shown = pin.buildGeomFromUrdf(model, str(urdf_path()), kind, package_dirs=[str(package_directory())])
        for one in shown.geometryObjects:
            points = _corners(one.geometry) @ one.placement.rotation.T + one.placement.translation
            found.setdefault(model.names[one.parentJoint], []).append(points)
    return {name: np.vstack(points) for name, points in found.items()}


def _corners(geometry: coal.CollisionGeometry) -> FloatArray:
    """Return the corners of a mesh, or of the bounding box of another shape, shape (n, 3)."""
    if isinstance(geometry, coal.BVHModelBase):
        vertices: FloatArray = geometry.vertices()
        return vertices
    geometry.computeLocalAABB()
    box = geometry.aabb_local
    corners: FloatArray = np.array(list(product(*zip(box.min_, box.max_, strict=True))))
    return corners


def finger_points(
    model: pin.Model, points: dict[str, FloatArray], gripper: GripperCard, opening_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return the points of fingers and of fingertips, in the palm's frame, swept from closed to an opening.

    A finger turns about its joint, and the tip on it keeps its orientation, so every point moves along an arc. The arc
    lies within the polygon of its ends and of the points where the tangents of each half meet.
    """
    finger = model.jointPlacements[model.getJointId("l_gripper_l_finger_joint")]
    tip = model.jointPlacements[model.getJointId("l_gripper_l_finger_tip_joint")]
    angle = gripper.angle(opening_m)
    further = 1.0 / math.cos(0.25 * angle)
    arc = [(0.0, 1.0), (0.25 * angle, further), (0.75 * angle, further), (angle, 1.0)]
    on_finger = _of_all_fingers(points, "finger_joint")
    on_tip = _of_all_fingers(points, "finger_tip_joint") @ tip.rotation.T
    fingers = [_turned(on_finger, q, away) for q, away in arc]
    tips = [on_tip + _turned(tip.translation[None], q, away) for q, away in arc]
    found = [np.vstack(each) @ finger.rotation.T + finger.translation for each in (fingers, tips)]
    of_fingers, of_tips = (np.vstack([each, each * _MIRROR]) for each in found)
    return of_fingers, of_tips


def _of_all_fingers(points: dict[str, FloatArray], joint: str) -> FloatArray:
    """Return the points of all four fingers, or tips, mapped onto the left finger of a hand."""
    left = [points[f"{side}_gripper_l_{joint}"] for side in "lr"]
    right = [points[f"{side}_gripper_r_{joint}"] * _MIRROR for side in "lr"]
    return np.vstack(left + right)


def _turned(points: FloatArray, angle: float, further: float) -> FloatArray:
    """Return points turned about z, with their distance from it scaled by a factor."""
    cos, sin = further * math.cos(angle), further * math.sin(angle)
    turned: FloatArray = points @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]).T
    return turned


OPENINGS_M = (0.0, HELD_M, EDGE_OPEN_M, 0.03, 0.06, 0.09)
"""Openings of the fingers for which there are shapes (m)."""

_FORMAT = 1
"""Version of the cache; raise it whenever shapes are made or stored differently."""

PartShapes = Mapping[str, RoundedHull]
"""Shapes by part name, an arm's as those of the left arm; see `finger_key` for fingers."""


def finger_key(part: int, opening_m: float) -> str:
    """Return the name of the shape of fingers or fingertips that may be open up to a width (m)."""
    level = next((level for level in OPENINGS_M if opening_m <= level), OPENINGS_M[-1])
    return f"{ARM_PARTS[part].name} {round(1000 * level)}"


def part_shapes(model: pin.Model, gripper: GripperCard, directory: Path | None = None) -> PartShapes:
    """Return the shapes, read from the cache or made (in a second) and cached.

    A cache that cannot be read is made again; a cache that cannot be written is ignored.

    Args:
        model: the kinematic tree.
        gripper: how the fingers open.
        directory: the cache directory; None: the platform's own.
    """
    path = (directory or cache_folder()) / "shapes" / f"pr2-{_digest()}.npz"
    return kept(path, _read, lambda: make_shapes(model, gripper), _arrays)


def make_shapes(model: pin.Model, gripper: GripperCard) -> PartShapes:
    """Return the shapes, made from the meshes."""
    points = points_of_joints(model)
    body = {part.name: points[part.joint] for part in BODY_PARTS}
    arm = {
        part.name: np.vstack([points[f"l_{part.joint}"], points[f"r_{part.joint}"] * _MIRROR])
        for part in ARM_PARTS[:FINGERS]
    }
    for opening_m in OPENINGS_M:
        fingers = finger_points(model, points, gripper, opening_m)
        arm |= zip((finger_key(part, opening_m) for part in (FINGERS, FINGERTIPS)), fingers, strict=True)
    shapes = {name: rounded_hull(cloud, ROUNDING_MAX_M, is_symmetric=True) for name, cloud in body.items()}
    most = dict.fromkeys(arm, ROUNDING_MAX_M)
    for opening_m in OPENINGS_M:
        tips_m = TIPS_ROUNDING_MAX_M if opening_m > EDGE_OPEN_M else EDGE_ROUNDING_MAX_M
        most[finger_key(FINGERTIPS, opening_m)] = tips_m
    return shapes | {name: rounded_hull(cloud, most[name]) for name, cloud in arm.items()}


def _digest() -> str:
    """Return a digest of everything that the shapes depend on."""
    digest = blake2b(
        f"{_FORMAT} {version('example-robot-data')} {ROUNDING_MAX_M} {TIPS_ROUNDING_MAX_M} "
        f"{EDGE_ROUNDING_MAX_M} {OPENINGS_M}".encode(),
        digest_size=8,
    )
    meshes = sorted(urdf_path().parent.parent.rglob("*.stl"))
    for path in (urdf_path(), *meshes):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _names() -> list[str]:
    fingers = [finger_key(part, opening_m) for opening_m in OPENINGS_M for part in (FINGERS, FINGERTIPS)]
    return [part.name for part in (*BODY_PARTS, *ARM_PARTS[:FINGERS])] + fingers


def _read(arrays: Arrays) -> PartShapes:
    return {name: hull_from(arrays, name) for name in _names()}


def _arrays(shapes: PartShapes) -> Arrays:
    return {key: array for name, shape in shapes.items() for key, array in hull_arrays(name, shape).items()}


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
