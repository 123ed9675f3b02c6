"""The surface points of each part of the PR2: the corners of its visual and collision meshes.

The right arm's meshes are not exact mirror images of the left arm's, and not quite symmetric themselves (5 mm). Each
arm part therefore has the points of the left arm and the mirrored points of the right arm, so that a mirrored posture
is free exactly where the posture is.
"""

import math
from itertools import product

import coal
import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.card import GripperCard
from planner.robots.pr2.description import package_directory, urdf_path
from planner.robots.pr2.parts import ARM_PARTS, BODY_PARTS, FINGERS

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


def body_points(points: dict[str, FloatArray]) -> list[FloatArray]:
    """Return the points of each part of the body, in its joint's frame."""
    return [points[part.joint] for part in BODY_PARTS]


def arm_points(points: dict[str, FloatArray]) -> list[FloatArray]:
    """Return the points of the left arm's parts up to and including the palm, in their joints' frames."""
    return [_of_both_sides(points, part.joint) for part in ARM_PARTS[:FINGERS]]


def _of_both_sides(points: dict[str, FloatArray], joint: str) -> FloatArray:
    return np.vstack([points[f"l_{joint}"], points[f"r_{joint}"] * _MIRROR])


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
