"""What one attempt lacks, for arms that reach only certain bands ahead of the base; and which attempt came closest."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from planner import Scene, load_garment
from planner.explain.reason_attempt import Demand, Miss, miss_of
from planner.explain.reason_reach import Places, nearest_miss
from planner.geometry.pose import FloatArray, Point3
from planner.geometry.reach_query import ReachQuery
from planner.planning.found_plan import FoundPlan
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import FoldTrial, fold_trials
from planner.primitives.g_drag import GDrag
from planner.primitives.state import State
from planner.robots.displacements import DIRECTIONS
from tests.builders import context, fold, garment, rectangle_points
from tests.planning.found import found_plan
from tests.planning.provoked import met
from tests.replay.planned import planned
from tests.required import required
from tests.sweep import sweep
from tests.wide_reach import WideReach

START = State(0, (0.0, 0.0), 0, 0)
ANYWHERE = (1 << 17) - 1

PROBLEMS = {
    "scarf": (load_garment("scarf-halved"), Scene()),
    # At the top of its way, 0.795 m over the table, a hand is out of reach in any orientation.
    "sheet": (garment(rectangle_points(0.9, 1.55), fold((0.9, 0.775), (0.0, 0.775))), Scene()),
    "low": (
        garment(rectangle_points(0.4, 0.4), fold((0.4, 0.2), (0.0, 0.2))),
        Scene.from_dict({"table": {"height_m": 0.3}}),
    ),
}
HERE = (0.0, 0.0)


def test_nothing_is_lacking_where_every_point_is_reached() -> None:
    assert _miss(WideReach([(0.3, 1.5)]), [0.4, 0.6, 0.5]) is None


def test_of_start_apex_and_end_the_one_furthest_out_counts_from_its_nearest_standoff() -> None:
    # Backing off leads further away: 0.9, 0.8 and 0.7 m ahead are 0.4, 0.3 and 0.2 m beyond a reach of 0.5 m.
    miss = required(_miss(WideReach([(0.3, 0.5)]), [0.9, 0.8, 0.7]))
    assert (miss.grip, miss.waypoint, miss.standoff) == (0, 0, 0)
    assert miss.short_by_m == pytest.approx(0.4)


def test_in_between_too_the_way_must_be_in_reach() -> None:
    # Only its second waypoint is beyond reach, by 0.1 m.
    miss = required(_miss(WideReach([(0.3, 0.5)]), [0.4, 0.6, 0.4, 0.4, 0.4]))
    assert miss.waypoint == 1 and miss.short_by_m == pytest.approx(0.1)


def test_the_base_must_be_able_to_drive_from_one_standoff_to_the_next() -> None:
    # The hand goes from 0.45 to 0.65 m ahead, and the arm reaches 0.40 to 0.50 and 0.70 to 0.80. Each point is in one
    # of them from somewhere; but who begins at standoff 0 is in the first, cannot drive through the gap to the second,
    # and lacks 0.05 m at 0.55.
    miss = required(_miss(WideReach([(0.4, 0.5), (0.7, 0.8)]), [0.45, 0.5, 0.55, 0.6, 0.65], stands=0b1))
    assert miss.demand is Demand.DRIVING
    assert (miss.waypoint, miss.standoff) == (2, 0) and miss.short_by_m == pytest.approx(0.05)
    assert _miss(WideReach([(0.4, 0.8)]), [0.45, 0.5, 0.55, 0.6, 0.65], stands=0b1) is None


def test_where_the_base_may_begin_is_kept_to() -> None:
    # What is held, 0.4 m ahead at standoff 0, is in reach from there; after a drag that ended 6 steps back it is not.
    assert _miss(WideReach([(0.3, 0.5)]), [0.4, 0.4, 0.4], stands=0b111) is None
    miss = required(_miss(WideReach([(0.3, 0.5)]), [0.4, 0.4, 0.4], stands=0b1100000))
    assert (miss.waypoint, miss.standoff) == (0, 5) and miss.short_by_m == pytest.approx(0.15)


def test_both_hands_must_be_in_reach_at_once() -> None:
    # Side by side, 0.4 m ahead; the left arm reaches 0.4 to 0.5, the right one 0.7 to 0.8 m ahead. From 2 steps back
    # the left hand is still in reach and the right one lacks 0.2 m.
    miss = required(_miss(WideReach([(0.4, 0.5)], [(0.7, 0.8)]), [0.4, 0.4, 0.4], [0.4, 0.4, 0.4]))
    assert miss.demand is Demand.WITH_THE_OTHER_HAND
    assert miss.short_by_m == pytest.approx(0.2)
    assert (miss.grip, miss.standoff) in {(1, 2), (0, 6)}
    assert _miss(WideReach([(0.4, 0.6)], [(0.6, 0.8)]), [0.4, 0.4, 0.4], [0.4, 0.4, 0.4]) is None


def _miss(reach: WideReach, *ways: Sequence[float], stands: int = ANYWHERE) -> Miss | None:
    """Return the shortfall of hands that pass some metres ahead of the base at standoff 0, at equal waypoints."""
    cloth = garment(rectangle_points(0.4, 0.4), fold((0.4, 0.2), (0.0, 0.2)))
    problem = context(cloth, reach=reach)
    like = next(iter(fold_trials(problem, START, 0)))
    pose = problem.station_pose(START.station)
    tools = [[_tool(pose.to_outer(np.array([x, 0.0])), 0.1 * hand) for x in way] for hand, way in enumerate(ways)]
    trial = FoldTrial(
        0,
        like.cover[: len(ways)],
        tuple(range(len(ways))),
        like.path,
        like.points[: len(ways)],
        np.linspace(0.0, 2.0, len(ways[0])),
        np.array(tools),
        like.approaches[: len(ways)],
    )
    return miss_of(problem, START, trial, stands, math.inf)


def _tool(place: FloatArray, aside: float) -> Point3:
    return (float(place[0]), float(place[1]) + aside, 0.02)


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
    drags = [s.after for station in stations for s in GDrag(context).successors(State(0, HERE, station, 0))]
    led_to = [after for after in drags if math.dist(after.offset, state.offset) < 1e-6]
    held = {(h.arm, h.point) for h in state.held}
    is_at_start = math.dist(state.offset, HERE) < 1e-6 and not held
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
    assert context.reach.from_anywhere(ReachQuery(arm, there + back + (short_by_m + 0.001) * towards, every)).any()
    for distance in np.arange(0.0, short_by_m - 0.002, 0.004):
        tried = ReachQuery(arm, there + distance * DIRECTIONS, every, context.standoffs)
        assert not context.reach.from_anywhere(tried).any()


@pytest.mark.parametrize("name", ["scarf", pytest.param("low", marks=pytest.mark.long)])
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
    is_there = context.reach.from_anywhere(ReachQuery(arm, base.to_inner(way + over_floor), turned))[0]
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
    again = found_plan(*PROBLEMS["scarf"], time_limit_s=60.0).plan
    assert again.to_dict()["reasons"] == _answer("scarf").plan.to_dict()["reasons"]


def _answer(name: str) -> FoundPlan:
    return planned("scarf-halved").found if name == "scarf" else met(*PROBLEMS[name])


def _met(name: str) -> Context:
    """Return a problem with all reasons that were met before it was known to have no plan."""
    return _answer(name).context
