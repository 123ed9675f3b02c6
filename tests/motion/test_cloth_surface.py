"""The cloth that is drawn is bent and cut, never stretched; points of the cloth lie on it."""

import numpy as np
import pytest

from planner import Plan, Scene, load_garment, make_plan
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from planner.geometry.woven_mesh import woven_mesh
from planner.motion.cloth_surface import ClothAlone, ClothPoints, ClothSurface, spread_cloth
from planner.motion.timeline import Timeline
from tests.area import require_drawn_whole
from tests.builders import fold, garment, rectangle_points
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.small_plan import small_plan

LOOKS = 40
"""The number of waypoints of a plan at which its cloth is measured."""


def require_unstretched(plan: Plan) -> None:
    """Require cloth to keep its area at every moment."""
    timeline = Timeline.of(plan)
    for t in np.linspace(0.0, timeline.duration_s, LOOKS):
        require_drawn_whole(timeline.at(float(t)).cloth, plan.garment.pattern.area)


@pytest.mark.parametrize("name", ["hand-towel", "big-towel", "letter-towel"])
def test_the_cloth_keeps_its_area_while_it_is_folded_dragged_and_let_hang(name: str) -> None:
    require_unstretched(shipped_plan(name))


def test_a_narrow_flap_stands_as_high_as_it_is_deep() -> None:
    # The flap is 5 cm deep; the tools over it, at their apex, are 2 cm higher than its edge.
    strip = garment(rectangle_points(0.3, 0.2), fold((0.3, 0.05), (0.0, 0.05)), placement=Pose2(-0.6, 0.15, -np.pi / 2))
    plan = make_plan(strip, time_limit_s=60.0)
    (primitive,) = (p for p in plan.primitives if p.kind == "fold")
    assert [required(grip.apex)[2] for grip in primitive.grips] == pytest.approx([0.07, 0.07])
    require_unstretched(plan)
    start, end = primitive.start_s, primitive.start_s + primitive.duration_s
    heights = [Timeline.of(plan).at(t).cloth.vertices[:, 2].max() for t in np.arange(start, end, 0.02)]
    assert max(heights) == pytest.approx(0.05, abs=0.002)


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


def area_m2(cloth: ClothSurface) -> float:
    a, b, c = (cloth.vertices[cloth.triangles[:, corner]] for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def test_a_garment_is_folded_by_nobody_from_spread_out_to_its_packet() -> None:
    garment, table = load_garment("t-shirt"), Scene().table
    alone = ClothAlone.of(FoldSequence.of(garment), table)
    start, done = alone.at(0.0)
    assert not done
    np.testing.assert_array_equal(start.vertices, spread_cloth(garment, table).vertices)
    count = len(garment.folds)
    standing, done = alone.at(1.5 / count)
    assert done == {0}
    assert standing.vertices[:, 2].max() > 0.05 > start.vertices[:, 2].max()
    packet, done = alone.at(1.0)
    assert done == set(range(count))
    assert packet.layers.max() + 1 == len(alone.sequence.final.layers)
    assert [area_m2(cloth) for cloth in (start, standing, packet)] == pytest.approx([garment.pattern.area] * 3)
