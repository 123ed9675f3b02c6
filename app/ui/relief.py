"""The height of the cloth under a point: drawings on the cloth follow its steps from layer to layer.

It depends on one moment's surface alone, so it does not matter how the moment was reached. Hanging cloth has its place
in the unrolled plane; cloth that stands or is in the air is not part of the relief.
"""

from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.motion.cloth_surface import ClothSurface

_ROUND_M = 1e-3  # cloth counts up to this far beyond its edge, as fold lines run along edges of folded cloth


@dataclass(frozen=True, slots=True)
class Relief:
    """The parts of a cloth that lie.

    Attributes:
        triangles: in the unrolled plane, table frame, counter-clockwise, shape (n, 3, 2), m.
        heights: each triangle's height over the table (m), shape (n,).
    """

    triangles: FloatArray
    heights: FloatArray

    @staticmethod
    def of(cloth: ClothSurface) -> "Relief":
        """Return the relief of a surface."""
        unrolled = cloth.unrolled[cloth.triangles]
        lying = unrolled[~np.isnan(unrolled).any(axis=(1, 2))]
        flat = lying[..., :2].copy()
        sides = flat[:, 1:] - flat[:, :1]
        is_turned = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0] < 0.0
        flat[is_turned] = flat[is_turned, ::-1]
        return Relief(flat, lying[..., 2].max(axis=1, initial=0.0))

    def heights_at(self, points: FloatArray) -> FloatArray:
        """Return the height (m) of the topmost cloth under points of the unrolled plane, shape (n, 2) -> (n,).

        -inf where no cloth lies.
        """
        if not len(self.triangles):
            return np.full(len(points), -np.inf)
        sides = np.roll(self.triangles, -1, axis=1) - self.triangles
        lengths = np.maximum(np.hypot(sides[..., 0], sides[..., 1]), LENGTH_M)
        inwards = np.stack([-sides[..., 1], sides[..., 0]], axis=-1) / lengths[..., None]
        offsets = (inwards * self.triangles).sum(axis=-1)
        is_over = np.ones((len(points), len(self.triangles)), dtype=np.bool_)
        for side in range(3):
            is_over &= points @ inwards[:, side].T >= offsets[:, side] - _ROUND_M
        return np.asarray(np.where(is_over, self.heights, -np.inf).max(axis=1))
