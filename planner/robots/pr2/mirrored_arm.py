"""An arm on its side of the robot: queries in the base frame, answered by the left arm's closed form."""

import math
from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.pr2.arm import MIRROR, ArmShape
from planner.robots.pr2.closed_form_samples import filled, solutions
from planner.robots.pr2.forward_kinematics import tool_places, tool_pose

_MIRRORED_PLACE = np.array([1.0, -1.0, 1.0])
_MIRRORED_ROTATION = np.outer(_MIRRORED_PLACE, _MIRRORED_PLACE)

_ENDLESS = (4, 6)
"""The joints that turn without end: forearm and wrist roll."""

_PERIODS = np.where(np.isin(np.arange(7), _ENDLESS), math.tau, 0.0)


@dataclass(frozen=True, slots=True)
class MirroredArm:
    """An arm of the robot.

    Attributes:
        shape: lengths and limits of the left arm.
        is_mirrored: whether this is the right arm.
    """

    shape: ArmShape
    is_mirrored: bool

    def shoulder(self, torso_m: float) -> FloatArray:
        """Return the shoulder of the left arm in the base frame (m), shape (3,)."""
        return np.array([self.shape.shoulder_x, self.shape.shoulder_y, self.shape.shoulder_z + torso_m])

    def mirrored_places(self, places: FloatArray) -> FloatArray:
        """Return points or directions, shape (..., 3), as the left arm sees them; a new array."""
        return np.array(places * _MIRRORED_PLACE if self.is_mirrored else places, dtype=float, order="C")

    def tool_pose(self, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame."""
        position, rotation = tool_pose(self.shape, self.mirrored_joints(joints))
        return self.mirrored_places(position + self.shoulder(torso_m)), self.mirrored_rotations(rotation)

    def tool_places(self, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions in the base frame for rows of joints, shape (n, 7) -> (n, 3), m."""
        return self.mirrored_places(tool_places(self.shape, self.mirrored_joints(joints)) + self.shoulder(torso_m))

    @property
    def stride(self) -> int:
        """Poses of a path from one link of a chain to the next."""
        return 3

    @property
    def periods(self) -> FloatArray:
        """A whole turn for forearm and wrist roll (rad), 0 for the other joints, shape (7,)."""
        return _PERIODS

    def samples(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, floor_m: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return samples of the joints at each tool pose, shape (n, m, 7), and their costs; see `PathArm`."""
        shoulder = self.shoulder(torso_m)
        places = self.mirrored_places(positions) - shoulder
        joints, costs = solutions(self.shape, places, self.mirrored_rotations(rotations), floor_m - float(shoulder[2]))
        return self.mirrored_joints(joints), costs

    def along(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, guides: FloatArray
    ) -> tuple[FloatArray, BoolArray]:
        """Return joints near to guides at each tool pose, shape (n, 7), and whether there are any; see `PathArm`."""
        places = self.mirrored_places(positions) - self.shoulder(torso_m)
        joints, is_found = filled(self.shape, places, self.mirrored_rotations(rotations), self.mirrored_joints(guides))
        return self.mirrored_joints(joints), is_found

    def unwound(self, chain: FloatArray) -> FloatArray:
        """Return a chain of samples with forearm and wrist roll unwound, shape (n, 7)."""
        joints = self.mirrored_joints(chain)
        for joint in _ENDLESS:
            joints[:, joint] = np.unwrap(joints[:, joint])
        return self.mirrored_joints(joints)

    def mirrored_joints(self, joints: FloatArray) -> FloatArray:
        """Return joints, shape (..., 7), as the left arm's, and back; a new array."""
        return np.array(joints * MIRROR if self.is_mirrored else joints, dtype=float, order="C")

    def mirrored_rotations(self, rotations: FloatArray) -> FloatArray:
        """Return rotations, shape (..., 3, 3), as the left arm sees them; a new array."""
        mirrored = rotations * _MIRRORED_ROTATION if self.is_mirrored else rotations
        return np.array(mirrored, dtype=float, order="C")
