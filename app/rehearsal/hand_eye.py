"""How far the robot's camera is beside where it is believed to be, learned from each picture that shows its arms."""

import numpy as np

from app.camera.camera import Camera
from app.vision.own_arms import seen_beside
from app.vision.picture import Image
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray

_MOUNTED_M = 0.01
"""How far a camera may be beside where it is believed to be before anything is seen, each way (m); an assumption.

Standard deviations, this one and the next.
"""

_ARM_M = 0.003
"""How far arms may be beside where the robot believes them to be, each way (m); an assumption."""


class HandEye:
    """A Kalman filter of a shift that does not change."""

    def __init__(self) -> None:
        """Begin without any picture."""
        self.shift_m: FloatArray = np.zeros(2)
        self._covariance_m2: FloatArray = _MOUNTED_M**2 * np.eye(2)

    def corrected(self, image: Image, camera: Camera, parts: list[FloatArray]) -> Camera:
        """Return where a camera is, as far as its pictures until now tell.

        Args:
            image: the picture that it takes now: blue, green, red.
            camera: where it is believed to be.
            parts: the points of the robot's parts, table frame, each of shape (n, 3), m.
        """
        told = seen_beside(image, camera, parts)
        if told is not None:
            error = told.covariance_m2 + _ARM_M**2 * np.eye(2)
            gain = self._covariance_m2 @ np.linalg.inv(self._covariance_m2 + error)
            self.shift_m = self.shift_m + gain @ (told.shift_m - self.shift_m)
            self._covariance_m2 = self._covariance_m2 - gain @ self._covariance_m2
        x, y = self.shift_m.tolist()
        return camera.carried(Isometry.rotation(0.0, -x, -y))
