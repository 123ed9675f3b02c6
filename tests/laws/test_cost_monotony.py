"""More freedom never costs more."""

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.cloth.garment_files import load_garment
from planner.primitives.context import Context
from planner.primitives.primitive import Primitive
from planner.primitives.primitive_set import PRIMITIVES
from planner.task.scene import DEFAULT_STATIONS, Scene
from tests.laws.law import law
from tests.laws.scenes import FOLDABLE, Kinds, Problem, problems
from tests.sweep import sweep

SECOND = 1e-6
PROPER_SUBSETS = tuple(some for n in range(len(PRIMITIVES)) for some in combinations(PRIMITIVES, n))


@given(problems(), st.floats(0.0, 1.5), st.floats(0.0, 1.5))
@law("planning", short=4, long=40)
def test_more_friction_never_costs_more(problem: Problem, one: float, other: float) -> None:
    rough, smooth = (
        replace(problem, scene=replace(problem.scene, friction=mu)) for mu in (max(one, other), min(one, other))
    )
    assert rough.cost_s() <= smooth.cost_s() + SECOND


@given(problems(most_stations=2), st.sampled_from(sorted(DEFAULT_STATIONS)))
@law("planning", short=4, long=40)
def test_one_more_station_never_costs_more(problem: Problem, name: str) -> None:
    before = problem.scene.stations
    after = before if name in dict(before) else (*before, (name, DEFAULT_STATIONS[name]))
    more = replace(problem, scene=replace(problem.scene, stations=after))
    assert more.cost_s() <= problem.cost_s() + SECOND


@given(problems(), st.sampled_from(PROPER_SUBSETS), st.sampled_from(PRIMITIVES))
@law("planning", short=4, long=40)
def test_one_more_primitive_never_costs_more(
    problem: Problem, some: Kinds, another: Callable[[Context], Primitive]
) -> None:
    more = (*some, another)
    assert problem.cost_s(kinds=more) <= problem.cost_s(kinds=some) + SECOND


@given(problems(standoffs=7), st.integers(1, 3))
@law("planning", short=4, long=30)
def test_more_room_to_back_off_never_costs_more(problem: Problem, steps: int) -> None:
    scene = problem.scene
    roomy = replace(problem, scene=replace(scene, back_off_max_m=scene.back_off_max_m + 0.05 * steps))
    assert roomy.cost_s() <= problem.cost_s() + SECOND


@sweep("name", FOLDABLE, ("vest", "hand-towel", "letter-towel"))
@pytest.mark.slow
def test_a_shipped_garment_is_no_cheaper_with_less_friction_a_station_less_or_a_primitive_less(name: str) -> None:
    problem = Problem(load_garment(name), Scene(), "front", 0.03)
    scene, cost_s = problem.scene, problem.cost_s()
    fewer = tuple((station, pose) for station, pose in scene.stations if station != "left")
    for less in (replace(scene, friction=0.4), replace(scene, stations=fewer)):
        assert replace(problem, scene=less).cost_s() >= cost_s - SECOND
    for one in PRIMITIVES:
        assert problem.cost_s(kinds=[kind for kind in PRIMITIVES if kind is not one]) >= cost_s - SECOND
