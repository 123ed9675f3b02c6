"""The cloth that is drawn is bent and cut, never stretched."""

import numpy as np
import pytest

from planner import Plan, make_plan
from planner.geometry.pose import Pose2
from planner.motion.timeline import Timeline
from tests.area import require_drawn_whole
from tests.builders import fold, garment, rectangle_points
from tests.replay.planned import shipped_plan
from tests.required import required

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
