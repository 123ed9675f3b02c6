"""A reason is about the attempt that came closest, and that was possible otherwise."""

import math
from functools import cache

import numpy as np
import pytest

from planner import Scene, load_garment
from planner.explain.reason_attempt import miss_of
from planner.explain.reason_places import Places
from planner.explain.reason_reach import nearest_miss
from planner.planning.found_plan import FoundPlan
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import fold_trials
from planner.primitives.g_drag import GDrag
from planner.primitives.state import State
from planner.robots.shortfall import DIRECTIONS
from tests.builders import fold, garment, rectangle_points
from tests.planning.provoked import met, refused
from tests.required import required
from tests.sweep import sweep

PROBLEMS = {
    "scarf": (load_garment("scarf-halved"), Scene()),
    # At the top of its way, 0.795 m over the table, a hand is out of reach in any orientation.
    "sheet": (garment(rectangle_points(0.9, 1.55), fold((0.9, 0.775), (0.0, 0.775))), Scene()),
    "low": (
        garment(rectangle_points(0.4, 0.4), fold((0.4, 0.2), (0.0, 0.2))),
        Scene.from_dict({"table": {"height_m": 0.3}}),
    ),
}
START = (0.0, 0.0)


@sweep("name", PROBLEMS, ("sheet",))
def test_no_attempt_came_closer(name: str) -> None:
    context = _met(name)
    places = Places(context, ())
    nearest = nearest_miss(context, 0, {0}, places)
    assert nearest is not None
    others = []
    for attempt in context.obstacles.attempts(0):
        for index in range(len(attempt.places)):
            state = attempt.at(index)
            if places.stands(state) and geometric_obstacle(context, state, 0) is None:
                trials = (
                    t for t in fold_trials(context, state, 0) if (t.cover, t.arms) == (attempt.cover, attempt.arms)
                )
                others += [miss_of(context, state, trial, places.stands(state), math.inf) for trial in trials]
    assert len(others) > 10
    assert nearest.short_by_m == pytest.approx(min(o.short_by_m for o in others if o is not None), abs=1e-9)


@sweep("name", PROBLEMS, ("sheet",))
def test_the_robot_can_bring_the_cloth_to_where_it_came_closest(name: str) -> None:
    context = _met(name)
    nearest = nearest_miss(context, 0, {0}, Places(context, ()))
    assert nearest is not None
    state = nearest.state
    stations = [state.station] if state.held else range(len(context.scene.stations))
    drags = [s.after for station in stations for s in GDrag(context).successors(State(0, START, station, 0))]
    led_to = [after for after in drags if math.dist(after.offset, state.offset) < 1e-6]
    held = {(h.arm, h.point) for h in state.held}
    is_at_start = math.dist(state.offset, START) < 1e-6 and not held
    assert is_at_start or any({(h.arm, h.point) for h in after.held} == held for after in led_to)


def test_displaced_by_what_it_is_short_the_point_is_in_reach_and_by_less_nowhere() -> None:
    # What is held may be held in any approach, so the reason's point must not be in reach in any.
    reason = _answer("sheet").plan.reasons[0]
    assert "and held on to" in reason.message and "orientation" not in reason.message
    context = _met("sheet")
    station = [name for name, _ in context.scene.stations].index(required(reason.station))
    arm, every = context.reach.arm_names.index(required(reason.arm)), np.arange(len(context.reach.approaches))
    there = context.in_base(station, np.array([reason.point]))
    pose = context.station_pose(station)
    towards = pose.to_inner(np.array(reason.towards) + np.array([pose.x_m, pose.y_m, 0.0]))
    back = np.array([reason.back_off_m, 0.0, 0.0])
    short_by_m = required(reason.short_by_m)
    assert context.reach.from_anywhere(arm, there + back + (short_by_m + 0.001) * towards, every, 1, 0.0).any()
    for distance in np.arange(0.0, short_by_m - 0.002, 0.004):
        assert not context.reach.from_anywhere(arm, there + distance * DIRECTIONS, every, context.standoffs, 0.05).any()


@pytest.mark.parametrize("name", ["scarf", "low"])
def test_turned_as_the_reason_says_the_hand_lacks_what_it_says_and_no_less(name: str) -> None:
    (reason, *_) = _answer(name).plan.reasons
    context = _met(name)
    arm, approaches = context.reach.arm_names.index(required(reason.arm)), list(context.reach.approaches)
    turned = np.array([approaches.index(required(reason.approach))])
    base = dict(context.scene.stations)[required(reason.station)].ahead(-required(reason.back_off_m))
    over_floor = np.array([0.0, 0.0, context.scene.table.height_m])
    short_by_m = required(reason.short_by_m)
    lengths = np.arange(0.0, short_by_m + 0.0025, 0.001)
    way = np.array(reason.point) + lengths[:, None] * np.array(reason.towards)
    is_there = context.reach.from_anywhere(arm, base.to_inner(way + over_floor), turned, 1, 0.0)[0]
    assert is_there[-1] and not is_there[lengths < short_by_m - 0.002].any()


def test_with_the_drag_taken_back_the_point_is_over_the_cloth_as_it_starts() -> None:
    # One hand takes the middle of the scarf's near end, 0.254 / 2 m from both corners, and lays it 1.524 m further on.
    # It rises as far as it has gone, until it is over the fold line, and comes down as far as it goes on.
    scarf = load_garment("scarf-halved")
    reason = _answer("scarf").plan.reasons[0]
    offset_m = required(reason.offset_m)
    assert math.hypot(*offset_m) > 0.05
    x_m, y_m, height_m = required(reason.point)
    dragged_x_m, dragged_y_m = offset_m
    across, along = scarf.placement.to_inner(np.array([x_m - dragged_x_m, y_m - dragged_y_m]))
    assert across == pytest.approx(0.254 / 2)
    assert height_m == pytest.approx(0.02 + min(along, 1.524 - along))
    told_x, told_y = (round(length, 2) + 0.0 for length in offset_m)
    assert f"(the cloth dragged by ({told_x:.2f}, {told_y:.2f}) m" in reason.message


@pytest.mark.long
def test_a_reason_is_the_same_every_time() -> None:
    again = refused(*PROBLEMS["scarf"])
    assert again.to_dict()["reasons"] == _answer("scarf").plan.to_dict()["reasons"]


@cache
def _answer(name: str) -> FoundPlan:
    return met(*PROBLEMS[name])


def _met(name: str) -> Context:
    """Return a problem with all reasons that were met before it was known to have no plan."""
    return _answer(name).context
