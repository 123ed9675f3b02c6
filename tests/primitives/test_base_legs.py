"""The base's legs along a path, against Dijkstra's search on the strip of waypoints and standoffs."""

import random

import networkx as nx
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.primitives.base_legs import legs, travel


def strip_of(*masks: int) -> NDArray[np.uint32]:
    return np.array(masks, dtype=np.uint32)


def brute_force(strip: NDArray[np.uint32], count: int) -> NDArray[np.int64]:
    """Return the least steps between all standoffs at the first waypoint and all at the last."""
    graph = nx.DiGraph()
    last = len(strip) - 1
    for waypoint, mask in enumerate(strip.tolist()):
        for j in (j for j in range(count) if mask >> j & 1):
            graph.add_node((waypoint, j))
            for other in (j - 1, j + 1):
                if 0 <= other < count and mask >> other & 1:
                    graph.add_edge((waypoint, j), (waypoint, other), weight=1)
            if waypoint < last and strip[waypoint + 1] >> j & 1:
                graph.add_edge((waypoint, j), (waypoint + 1, j), weight=0)
    steps = np.full((count, count), IMPOSSIBLE)
    for start in range(count):
        if (0, start) in graph:
            reached = nx.single_source_dijkstra_path_length(graph, (0, start))
            for end in range(count):
                steps[start, end] = reached.get((last, end), IMPOSSIBLE)
    return steps


def random_strips(seed: int) -> tuple[NDArray[np.uint32], int]:
    """Return one to three strips of standoffs, dense enough that there mostly is a way."""
    rng = random.Random(seed)
    count, waypoints = rng.randint(1, 9), rng.randint(1, 7)
    share = rng.uniform(0.4, 1.0)
    masks = [
        [sum(1 << j for j in range(count) if rng.random() < share) for _ in range(waypoints)]
        for _ in range(rng.randint(1, 3))
    ]
    return np.array(masks, dtype=np.uint32), count


def test_where_one_standoff_suits_every_waypoint_the_base_stays() -> None:
    (steps,) = travel(strip_of(0b111, 0b110, 0b011)[None], 3)
    assert steps[1, 1] == 0


def test_the_base_drives_no_further_than_the_masks_ask() -> None:
    # From 0 to 2 by way of 1: two steps, taken at the waypoint where all three are in reach.
    (steps,) = travel(strip_of(0b001, 0b111, 0b100)[None], 3)
    assert steps.tolist() == [[IMPOSSIBLE, IMPOSSIBLE, 2], [IMPOSSIBLE] * 3, [IMPOSSIBLE] * 3]
    assert legs(strip_of(0b001, 0b111, 0b100), 0, 2, 3) == (0, 2, 2)


def test_a_gap_in_what_is_in_reach_cannot_be_crossed() -> None:
    (steps,) = travel(strip_of(0b001, 0b101, 0b100)[None], 3)
    assert (steps == IMPOSSIBLE).all()


@given(st.integers(0, 100_000))
def test_travel_is_what_dijkstra_finds_on_every_strip(seed: int) -> None:
    strips, count = random_strips(seed)
    np.testing.assert_array_equal(travel(strips, count), [brute_force(strip, count) for strip in strips])


@given(st.integers(0, 100_000))
def test_the_legs_realise_the_travel(seed: int) -> None:
    strips, count = random_strips(seed)
    strip = strips[0]
    (steps,) = travel(strip[None], count)
    for start, end in zip(*np.nonzero(steps < IMPOSSIBLE), strict=True):
        stands = legs(strip, int(start), int(end), count)
        assert len(stands) == len(strip) and stands[-1] == end
        driven, at = 0, int(start)
        for mask, stand in zip(strip.tolist(), stands, strict=True):
            low, high = sorted((at, stand))
            assert all(mask >> j & 1 for j in range(low, high + 1)), "every standoff on the way is in reach"
            driven, at = driven + abs(stand - at), stand
        assert driven == steps[start, end]
