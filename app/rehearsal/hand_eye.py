"""Estimate the errors of the positions of the robot's camera and hands from pictures of its arms."""

from collections.abc import Mapping

import numpy as np
from scipy.linalg import block_diag

from app.rehearsal.camera.camera import Camera
from app.rehearsal.vision.own_arms import SeenBeside, seen_beside
from app.rehearsal.vision.picture import Image
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray

_MOUNTED_M = 0.01
"""The error of the camera's position before anything is seen, each way (m); an assumption.

Standard deviations, this one and the next.
"""

_ARM_M = 0.005
"""The error of the position of a hand, or of the rest of the arms, each way (m); an assumption."""

_UNLIKELY = 13.8
"""The squared distance, in standard deviations, that one sample in a thousand exceeds in the plane."""


class HandEye:
    """A Kalman filter of the camera's shift, which does not change, and of the hands', which do with each posture.

    Attributes:
        shift_m: from where the camera is to where it is believed to be, in the table's plane, shape (2,), m.
        hands_m: where each hand was in the last picture that showed it, relative to where the robot believed it to be,
            shape (2,), m.
    """

    def __init__(self) -> None:
        """Begin without any picture."""
        self.shift_m: FloatArray = np.zeros(2)
        self.hands_m: dict[str, FloatArray] = {}
        self._covariance_m2: FloatArray = _MOUNTED_M**2 * np.eye(2)

    def corrected(self, image: Image, camera: Camera, hands: Mapping[str, list[FloatArray]]) -> Camera:
        """Return the camera with its position corrected by all pictures until now.

        Args:
            image: the picture that it takes now: blue, green, red.
            camera: where it is believed to be.
            hands: the points of the parts of each hand, those of the rest of the robot as "", table frame, shape
                (n, 3), m, each.
        """
        seen_of_arm: dict[str, SeenBeside] = {}
        here, likely_m2 = self._corrected(camera), self._covariance_m2 + _ARM_M**2 * np.eye(2)
        for name, parts in hands.items():
            others = [part for other, those in hands.items() if other != name for part in those]
            found = seen_beside(image, here, parts, others, likely_m2)
            if found is not None and _is_likely(found, likely_m2):
                seen_of_arm[name] = found
        count = len(seen_of_arm)
        seen = np.concatenate([np.empty(0), *(self.shift_m + one.shift_m for one in seen_of_arm.values())])
        # The state: the camera's shift, then those of the parts seen; each of these is seen shifted by both.
        state = np.concatenate([self.shift_m, np.zeros(2 * count)])
        covariance = block_diag(self._covariance_m2, *[_ARM_M**2 * np.eye(2)] * count)
        sees = np.hstack([np.tile(np.eye(2), (count, 1)), np.eye(2 * count)])
        errors = block_diag(np.empty((0, 0)), *(one.covariance_m2 for one in seen_of_arm.values()))
        gain = covariance @ sees.T @ np.linalg.inv(sees @ covariance @ sees.T + errors)
        state, covariance = state + gain @ (seen - sees @ state), covariance - gain @ sees @ covariance
        self.shift_m, self._covariance_m2 = state[:2], covariance[:2, :2]
        shifts = zip(seen_of_arm, state[2:].reshape(-1, 2), strict=True)
        self.hands_m = {name: shift_m for name, shift_m in shifts if name}
        return self._corrected(camera)

    def _corrected(self, camera: Camera) -> Camera:
        x, y = self.shift_m.tolist()
        return camera.carried(Isometry.rotation(0.0, -x, -y))


def _is_likely(one: SeenBeside, likely_m2: FloatArray) -> bool:
    """Return whether a shift is likely to be that of the part; if not, the edges seen are of something else.

    The measurement's own error is left out, because of shifts that fit as well the likeliest was taken.
    """
    return float(one.shift_m @ np.linalg.solve(likely_m2, one.shift_m)) < _UNLIKELY
