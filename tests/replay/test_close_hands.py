"""Ties of which a corner has been pulled: two hands must be close together, and arms pass each other."""

import math
from dataclasses import replace

import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from planner import Garment, Scene, load_garment, make_plan
from planner.geometry.table import Table
from planner.motion.timeline import Timeline
from tests.replay.checker import check
from tests.replay.joints import require_clear, require_speeds


def pulled_tie(corner: int, by_m: float, towards_rad: float) -> Garment:
    """Return a tie one of whose corners has been pulled, along with its folds."""
    drawing = solve(drawing_of(load_garment("tie"))).drawing
    outline = list(drawing.outline)
    x, y = outline[corner].point
    there = (x + by_m * math.cos(towards_rad), y + by_m * math.sin(towards_rad))
    outline[corner] = replace(outline[corner], point=there)
    garment = solve(replace(drawing, outline=tuple(outline))).garment
    assert garment is not None
    return garment


@pytest.mark.parametrize(
    ("corner", "by_m", "towards_rad"),
    [
        # Of the orientations in which the second fold is in reach few keep the arms off the table and each other.
        pytest.param(0, 0.03, 3.4614, marks=pytest.mark.long),
        # The arms have a way, but none in which one of them goes as it would alone.
        pytest.param(0, 0.01, 1.0868, marks=pytest.mark.long),
        pytest.param(2, 0.01, 4.1663, marks=pytest.mark.long),
    ],
)
def test_two_hands_fold_a_narrow_end(corner: int, by_m: float, towards_rad: float) -> None:
    cloth = pulled_tie(corner, by_m, towards_rad)
    plan = make_plan(cloth, time_limit_s=60.0)
    assert plan.is_solved
    assert any(len(one.grips) == 2 for one in plan.primitives if one.kind == "fold")
    check(cloth.to_dict(), Scene().to_dict(), plan.to_dict())
    require_speeds(Timeline.of(plan))
    require_clear(Timeline.of(plan), Table(), every_s=1.3)
