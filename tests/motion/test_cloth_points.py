"""Points of the cloth lie where its surface does, at every moment of a plan."""

import numpy as np
import pytest

from planner.geometry.woven_mesh import woven_mesh
from planner.motion.cloth_surface import ClothPoints
from planner.motion.timeline import Timeline
from tests.small_plan import small_plan


@pytest.mark.parametrize("share", (0.0, 0.2, 0.4, 0.5, 0.6, 0.8, 1.0))
def test_points_lie_on_the_surface(share: float) -> None:
    timeline = Timeline.of(small_plan())
    pattern, _ = woven_mesh(small_plan().garment.pattern, 0.05)
    t_s = share * timeline.duration_s
    points = ClothPoints(small_plan().sequence, pattern).at(timeline.cloth_at(t_s))
    cloth = timeline.at(t_s).cloth
    corners = cloth.vertices[cloth.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    off = np.abs(np.einsum("pti,ti->pt", points[:, None] - corners[None, :, 0], normals)).min(axis=1)
    assert off.max() < 3.0 * small_plan().garment.layer_m + 1e-9
    np.testing.assert_allclose(points.min(axis=0), cloth.vertices.min(axis=0), atol=0.05)
    np.testing.assert_allclose(points.max(axis=0), cloth.vertices.max(axis=0), atol=0.05)
