"""The shortfall of an attempt, for a robot whose arms reach only certain bands ahead of its base."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pytest

from planner.deadline import ENDLESS, Deadline
from planner.explain.reason_attempt import miss_of
from planner.explain.reason_miss import Demand, Miss
from planner.geometry.pose import FloatArray, Point3
from planner.geometry.shortfall import Shortfall
from planner.primitives.fold_trial import FoldTrial, fold_trials
from planner.primitives.state import State
from tests.builders import WideReach, context, fold, garment, rectangle_points
from tests.required import required

START = State(0, (0.0, 0.0), 0, 0)
ANYWHERE = (1 << 17) - 1
SLACK_M = 1e-9
Band = tuple[float, float]


class BandReach(WideReach):
    """Arms that reach every point whose x in the base frame lies in one of their bands (m), in either approach."""

    def __init__(self, bands: Mapping[int, Sequence[Band]]) -> None:
        super().__init__(lambda arm, point, standoff: self._lacks(arm, point[0] + 0.05 * standoff) == 0.0)
        self._bands = bands

    def _lacks(self, arm: int, x: float) -> float:
        gaps = (max(low - x, x - high, 0.0) for low, high in self._bands[arm])
        short = min(gaps)
        return 0.0 if short < SLACK_M else short

    def shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: FloatArray,
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> Shortfall | None:
        lacks = [self._lacks(arm, x) for x, _, _ in points]
        nearest = int(np.argmin(lacks))
        if lacks[nearest] == 0.0:
            return None
        return Shortfall("too_far", None, lacks[nearest], False, (-1.0, 0.0, 0.0), int(approaches[0]), nearest)

    def shortfall_together(
        self,
        arm: int,
        places: FloatArray,
        approaches: FloatArray,
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> tuple[int, Shortfall] | None:
        each = [(n, self.shortfall(arm, place, approaches)) for n, place in enumerate(places)]
        found = [(n, one) for n, one in each if one is not None]
        return max(found, key=lambda pair: pair[1].short_by_m, default=None)


def test_nothing_is_lacking_where_every_point_is_reached() -> None:
    assert _miss({0: [(0.3, 1.5)]}, [0.4, 0.6, 0.5]) is None


def test_of_start_apex_and_end_the_one_furthest_out_counts_from_its_nearest_standoff() -> None:
    # Backing off leads further away: 0.9, 0.8 and 0.7 m ahead are 0.4, 0.3 and 0.2 m beyond a reach of 0.5 m.
    miss = required(_miss({0: [(0.3, 0.5)]}, [0.9, 0.8, 0.7]))
    assert (miss.grip, miss.waypoint, miss.standoff) == (0, 0, 0)
    assert miss.short_by_m == pytest.approx(0.4)


def test_in_between_too_the_way_must_be_in_reach() -> None:
    # Only its second waypoint is beyond reach, by 0.1 m.
    miss = required(_miss({0: [(0.3, 0.5)]}, [0.4, 0.6, 0.4, 0.4, 0.4]))
    assert miss.waypoint == 1 and miss.short_by_m == pytest.approx(0.1)


def test_the_base_must_be_able_to_drive_from_one_standoff_to_the_next() -> None:
    # The hand goes from 0.45 to 0.65 m ahead, and the arm reaches 0.40 to 0.50 and 0.70 to 0.80. Each point is in one
    # of them from somewhere; but who begins at standoff 0 is in the first, cannot drive through the gap to the second,
    # and lacks 0.05 m at 0.55.
    miss = required(_miss({0: [(0.4, 0.5), (0.7, 0.8)]}, [0.45, 0.5, 0.55, 0.6, 0.65], stands=0b1))
    assert miss.demand is Demand.DRIVING
    assert (miss.waypoint, miss.standoff) == (2, 0) and miss.short_by_m == pytest.approx(0.05)
    assert _miss({0: [(0.4, 0.8)]}, [0.45, 0.5, 0.55, 0.6, 0.65], stands=0b1) is None


def test_where_the_base_may_begin_is_kept_to() -> None:
    # What is held, 0.4 m ahead at standoff 0, is in reach from there; after a drag that ended 6 steps back it is not.
    assert _miss({0: [(0.3, 0.5)]}, [0.4, 0.4, 0.4], stands=0b111) is None
    miss = required(_miss({0: [(0.3, 0.5)]}, [0.4, 0.4, 0.4], stands=0b1100000))
    assert (miss.waypoint, miss.standoff) == (0, 5) and miss.short_by_m == pytest.approx(0.15)


def test_both_hands_must_be_in_reach_at_once() -> None:
    # Side by side, 0.4 m ahead; the left arm reaches 0.4 to 0.5, the right one 0.7 to 0.8 m ahead. From 2 steps back
    # the left hand is still in reach and the right one lacks 0.2 m.
    bands = {0: [(0.4, 0.5)], 1: [(0.7, 0.8)]}
    miss = required(_miss(bands, [0.4, 0.4, 0.4], [0.4, 0.4, 0.4]))
    assert miss.demand is Demand.WITH_THE_OTHER_HAND
    assert miss.short_by_m == pytest.approx(0.2)
    assert (miss.grip, miss.standoff) in {(1, 2), (0, 6)}
    assert _miss({0: [(0.4, 0.6)], 1: [(0.6, 0.8)]}, [0.4, 0.4, 0.4], [0.4, 0.4, 0.4]) is None


def _miss(bands: Mapping[int, Sequence[Band]], *ways: Sequence[float], stands: int = ANYWHERE) -> Miss | None:
    """Return the shortfall of hands that pass some metres ahead of the base at standoff 0, at equal waypoints."""
    cloth = garment(rectangle_points(0.4, 0.4), fold((0.4, 0.2), (0.0, 0.2)))
    problem = context(cloth, reach=BandReach(bands))
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
