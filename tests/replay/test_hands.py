"""The trajectory of every plan against the URDF: the tools are at the grips of the replay."""

import math
from functools import cache
from typing import Any

import pytest
from hypothesis import settings

from planner.motion.timeline import Timeline
from tests.laws.law import LONG
from tests.replay.checker import check
from tests.replay.hands import Moment, distance_to_way, require_joint_limits, seen
from tests.replay.planned import each_solvable, planned, shipped_plan
from tests.replay.world import Way

NEAR_M = 0.005
RATE_HZ = 50.0 if settings.get_current_profile_name() == LONG else 20.0


@cache
def ways(name: str) -> list[dict[str, Way]]:
    case = planned(name)
    return check(case.garment, case.scene, case.plan)


@cache
def samples(name: str) -> list[dict[str, Any]]:
    return [frame.to_dict() for frame in Timeline.of(shipped_plan(name)).samples(RATE_HZ)]


@cache
def moments(name: str) -> list[Moment]:
    height = planned(name).scene["table"]["height_m"]
    return [seen(sample, height) for sample in samples(name)]


def moment(name: str, t_s: float) -> Moment:
    case = planned(name)
    return seen(Timeline.of(case.found.plan).at(t_s).to_dict(), case.scene["table"]["height_m"])


def holding(name: str, number: int, arm: str) -> list[Moment]:
    """Return the samples well within a primitive at which an arm's gripper is closed."""
    primitive = planned(name).plan["primitives"][number]
    start, end = primitive["start_s"] + 1e-6, primitive["start_s"] + primitive["duration_s"] - 1e-6
    return [m for m in moments(name) if start < m.t_s < end and m.is_closed[arm]]


@each_solvable
def test_the_trajectory_lasts_as_long_as_the_plan_costs_and_knows_which_primitive_is_under_way(name: str) -> None:
    plan, sampled = planned(name).plan, samples(name)
    assert sampled[0]["t_s"] == 0.0
    assert sampled[-1]["t_s"] == pytest.approx(plan["cost_s"], abs=1e-9)
    for sample in sampled[:-1]:
        primitive = plan["primitives"][sample["primitive"]]
        end = primitive["start_s"] + primitive["duration_s"]
        assert primitive["start_s"] - 1e-9 <= sample["t_s"] <= end + 1e-9


@each_solvable
def test_every_joint_of_the_trajectory_is_known_to_the_urdf_and_within_its_limits(name: str) -> None:
    for sample in samples(name):
        require_joint_limits(sample)


@each_solvable
def test_the_base_is_where_each_primitive_leaves_it_when_it_ends(name: str) -> None:
    for primitive in planned(name).plan["primitives"]:
        base = moment(name, primitive["start_s"] + primitive["duration_s"]).base
        wanted = (primitive["base"]["x_m"], primitive["base"]["y_m"])
        assert math.dist(base[:2], wanted) < 1e-6
        assert abs(math.remainder(base[2] - primitive["base"]["yaw_rad"], math.tau)) < 1e-6


@each_solvable
def test_a_tool_passes_its_pick_its_apex_and_its_place_in_that_order(name: str) -> None:
    for number, (primitive, arms) in enumerate(zip(planned(name).plan["primitives"], ways(name), strict=True)):
        for grip in primitive["grips"]:
            arm, looks = grip["arm"], holding(name, number, grip["arm"])
            end = primitive["start_s"] + primitive["duration_s"]
            start = looks[0].t_s if arms[arm].is_new_grip else primitive["start_s"]
            path = [moment(name, start).tools[arm], *(m.tools[arm] for m in looks), moment(name, end).tools[arm]]
            what = f"primitive {number}, {arm} arm"
            assert math.dist(path[0], grip["pick"]) < NEAR_M, f"{what}: the cloth is taken elsewhere"
            assert math.dist(path[-1], grip["place"]) < NEAR_M, f"{what}: the cloth is put down elsewhere"
            if grip["apex"] is not None:
                assert distance_to_way(tuple(grip["apex"]), path) < NEAR_M, f"{what}: the apex is missed"


@each_solvable
def test_a_tool_that_holds_cloth_never_leaves_the_way_of_its_grip(name: str) -> None:
    for number, arms in enumerate(ways(name)):
        for arm, way in arms.items():
            gaps = {m.t_s: distance_to_way(m.tools[arm], list(way.points)) for m in holding(name, number, arm)}
            at = max(gaps, key=lambda t: gaps[t])
            assert gaps[at] < NEAR_M, f"primitive {number}, {arm} arm, {at:.2f} s: {gaps[at] * 1000:.0f} mm off"


@each_solvable
def test_a_tool_takes_cloth_from_outside_at_an_allowed_pitch(name: str) -> None:
    cone = planned(name).scene["approach_cone_rad"]
    for number, arms in enumerate(ways(name)):
        for arm, way in arms.items():
            if not way.is_new_grip:
                continue
            x, y, z = holding(name, number, arm)[0].headings[arm]
            pitch = math.degrees(math.atan2(-z, math.hypot(x, y)))
            assert min(abs(pitch - allowed) for allowed in (15, 30, 45, 60, 90)) < 0.5, f"{pitch:.1f} degrees"
            if pitch < 89:
                off = math.acos(min(1.0, (x * way.into_cloth[0] + y * way.into_cloth[1]) / math.hypot(x, y)))
                assert off <= cone + 0.02, f"primitive {number}, {arm} arm: {math.degrees(off):.0f} degrees off"
