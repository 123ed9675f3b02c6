"""Poses in viser's form, as matrices."""

import numpy as np
from numpy.typing import NDArray


def matrix(position: object, wxyz: object) -> NDArray[np.float64]:
    w, x, y, z = np.asarray(wxyz, dtype=float)
    placed = np.eye(4)
    placed[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    placed[:3, 3] = np.asarray(position, dtype=float)
    return placed
