"""Poses of the parts of the PR2's arms at their seven joints, compiled; see `planner.robots.collision.part_poses`.

The parts of the right arm are mirror images of the left arm's: their frames are left-handed, and in them the corners of
the left arm's hulls give those of the right arm's.
"""

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.collision.part_poses import PLACE
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.forward_kinematics import BASE_FRAME, Frame, Vector, about_x, about_y, about_z, ahead
from planner.robots.pr2.parts import ARM_PARTS, PALM

EACH = len(ARM_PARTS)
"""Number of parts of an arm."""


@kernel
def _set_pose(poses: FloatArray, part: int, frame: Frame, place: Vector, side: float) -> None:
    """Set a part's pose from the left arm's frame; `side` is -1 for the right arm."""
    x, y, z = frame
    poses[part, 0, 0], poses[part, 0, 1], poses[part, 0, 2] = x[0], y[0], z[0]
    poses[part, 1, 0], poses[part, 1, 1], poses[part, 1, 2] = side * x[1], side * y[1], side * z[1]
    poses[part, 2, 0], poses[part, 2, 1], poses[part, 2, 2] = x[2], y[2], z[2]
    poses[part, PLACE, 0], poses[part, PLACE, 1], poses[part, PLACE, 2] = place[0], side * place[1], place[2]


@kernel
def pose_arm(shape: ArmShape, lift_m: float, joints: FloatArray, side: float, poses: FloatArray) -> None:
    """Set rotation and position of an arm's parts in the base frame; from the palm on they are one body.

    Args:
        shape: the left arm.
        lift_m: how far the torso is raised (m).
        joints: the seven joints of this arm (rad).
        side: 1 for the left arm, -1 for the right.
        poses: the poses to set, shape (EACH, 5, 3).
    """
    place = (shape.shoulder_x, shape.shoulder_y, shape.shoulder_z + lift_m)
    frame = about_z(BASE_FRAME, side * joints[0])
    _set_pose(poses, 0, frame, place, side)
    place = ahead(place, frame, shape.offset)
    frame = about_y(frame, joints[1])
    _set_pose(poses, 1, frame, place, side)
    frame = about_x(frame, side * joints[2])
    _set_pose(poses, 2, frame, place, side)
    place = ahead(place, frame, shape.upper)
    frame = about_y(frame, joints[3])
    _set_pose(poses, 3, frame, place, side)
    frame = about_x(frame, side * joints[4])
    _set_pose(poses, 4, frame, place, side)
    place = ahead(place, frame, shape.fore)
    frame = about_y(frame, joints[5])
    _set_pose(poses, 5, frame, place, side)
    frame = about_x(frame, side * joints[6])
    for part in range(PALM, EACH):
        _set_pose(poses, part, frame, place, side)


@kernel
def pose_either(shape: ArmShape, lift_m: float, arm: int, joints: FloatArray, poses: FloatArray) -> None:
    """Set the poses of the parts of an arm, the left (0) or the right one (1), as `pose_arm` does."""
    pose_arm(shape, lift_m, joints, 1.0 - 2.0 * arm, poses)
