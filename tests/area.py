"""The area of drawn cloth."""

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.motion.cloth_surface import ClothSurface


def require_drawn_whole(cloth: ClothSurface, area_m2: float) -> None:
    """Require all of a pattern to be drawn once, and none of it to be stretched that no fold has lifted."""
    lies = ~np.isnan(cloth.unrolled[cloth.triangles]).any(axis=(1, 2))
    drawn, pattern = (_areas_m2(points[cloth.triangles]) for points in (cloth.vertices, cloth.pattern))
    assert pattern.sum() == pytest.approx(area_m2, rel=1e-6)
    assert drawn[lies].sum() == pytest.approx(pattern[lies].sum(), rel=1e-3)


def _areas_m2(points: FloatArray) -> FloatArray:
    """Return the areas of triangles, shape (n, 3, 2 or 3), m^2."""
    sides = points[:, 1:] - points[:, :1]
    squares = (sides**2).sum(axis=2).prod(axis=1) - (sides[:, 0] * sides[:, 1]).sum(axis=1) ** 2
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / 2.0)
