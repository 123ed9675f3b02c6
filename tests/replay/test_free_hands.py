"""Free hands in every trajectory: never in the table, never low over cloth, fingers open in time.

They are seen independently: the robot's hulls and poses are those of `tests.replay.hulls`, the cloth that lies is taken
from the drawn surface.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import coal
import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import settings

from planner import Plan
from planner.geometry.table import Table, table_parts
from planner.motion.timeline import Sample, Timeline
from tests.laws.law import LONG
from tests.replay.hands import CLOSED_M, seen
from tests.replay.hulls import Body, bodies, robot
from tests.replay.joints import speed_limits
from tests.replay.planned import SOLVABLE, each_solvable, shipped_plan
from tests.required import required
from tests.sweep import sweep

OVER_CLOTH_M = 0.03
"""The least height of a free arm's parts over cloth (m), except for hands near their grips."""

LAST_M = 0.08
"""The distance to a grip, along the way there, within which a hand may be lower (m)."""

PARTS = ("elbow", "forearm", "wrist", "gripper")
SIDES = {"left": "l_", "right": "r_"}


@dataclass(frozen=True)
class Look:
    """A sample of a trajectory.

    Attributes:
        frame: robot and cloth.
        to_grip_m: by arm, how far its tool goes until it closes on cloth, or has gone since it let go; infinite while
            neither is so, nan while it holds.
    """

    frame: Sample
    to_grip_m: dict[str, float]


def looks(plan: Plan, rate_hz: float) -> list[Look]:
    """Return samples of a plan's trajectory."""
    height_m = plan.scene.table.height_m
    frames = list(Timeline.of(plan).samples(rate_hz))
    moments = [seen(frame.to_dict(), height_m) for frame in frames]
    ways: dict[str, list[float]] = {}
    for arm in SIDES:
        tools = np.array([moment.tools[arm] for moment in moments])
        gone = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(tools, axis=0), axis=1)))
        is_holding = np.array([frame.grippers_m[arm] <= CLOSED_M for frame in frames])
        held = gone[is_holding]
        before = [held[held >= g].min(initial=np.inf) - g for g in gone]
        after = [g - held[held <= g].max(initial=-np.inf) for g in gone]
        ways[arm] = np.where(is_holding, np.nan, np.minimum(before, after)).tolist()
    return [Look(frame, {arm: ways[arm][i] for arm in SIDES}) for i, frame in enumerate(frames)]


def in_table(look: Look, table: Table) -> Iterator[tuple[str, float]]:
    """Return the links of free arms, fingertips too, that are in the table, and how deep (m)."""
    for arm, to_grip_m in look.to_grip_m.items():
        if not np.isnan(to_grip_m):
            for link, pose in _arm_links(arm, look.frame, table):
                for part in table_parts(table):
                    depth_m = _depth(link.shape, pose, coal.Box(*part.size), _at(part.center))
                    if depth_m > 0.0:
                        yield link.name, depth_m


def too_low(look: Look, table: Table) -> Iterator[tuple[str, float]]:
    """Return the links of free arms that are too low over cloth, and how much higher they should be (m)."""
    cloth = None
    for arm, to_grip_m in look.to_grip_m.items():
        if not np.isnan(to_grip_m) and to_grip_m > LAST_M:
            cloth = _slabs(look.frame) if cloth is None else cloth
            for link, pose in _arm_links(arm, look.frame, table):
                depth_m = max((_depth(link.shape, pose, slab, np.eye(4)) for slab in cloth), default=0.0)
                if depth_m > 0.0:
                    yield link.name, depth_m


def _arm_links(arm: str, frame: Sample, table: Table) -> Iterator[tuple[Body, Any]]:
    """Return the low links of an arm from the elbow outwards, and their poses in the table frame."""
    robot().update_cfg(frame.joints)
    base = trimesh.transformations.rotation_matrix(frame.base.yaw_rad, (0.0, 0.0, 1.0))
    base[:3, 3] = (frame.base.x_m, frame.base.y_m, -table.height_m)
    for link in bodies():
        if link.name.startswith(SIDES[arm]) and any(part in link.name for part in PARTS):
            pose = base @ robot().get_transform(link.name)
            middle = pose[:3, :3] @ link.middle + pose[:3, 3]
            if middle[2] - link.radius_m < OVER_CLOTH_M:
                yield link, pose


def _slabs(frame: Sample) -> list[Any]:
    """Return convex regions that must stay empty: the cloth on the table, 3 cm high."""
    corners, unrolled = (points[frame.cloth.triangles] for points in (frame.cloth.vertices, frame.cloth.unrolled))
    is_lying = (np.abs(corners[:, :, 2]) < OVER_CLOTH_M).all(axis=1) & ~np.isnan(unrolled).any(axis=(1, 2))
    lying = corners[is_lying][:, :, :2]
    whole = shapely.union_all(shapely.polygons(lying).tolist(), grid_size=1e-5)
    found = []
    for piece in shapely.get_parts(shapely.constrained_delaunay_triangles(whole)):
        flat = shapely.get_coordinates(piece)[:3]
        prism = np.vstack([np.column_stack([flat, np.full(3, z)]) for z in (0.0, OVER_CLOTH_M)])
        points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
        for point in prism:
            points.append(point)
        for face in trimesh.Trimesh(prism).convex_hull.faces.tolist():
            faces.append(coal.Triangle(*face))
        found.append(coal.Convex(points, faces))
    return found


def _at(place: tuple[float, float, float]) -> Any:
    return trimesh.transformations.translation_matrix(place)


def _depth(a: Any, pose_a: Any, b: Any, pose_b: Any) -> float:
    at_a, at_b = (coal.Transform3s(pose[:3, :3], pose[:3, 3]) for pose in (pose_a, pose_b))
    return -float(coal.distance(a, at_a, b, at_b, coal.DistanceRequest(), coal.DistanceResult()))


IS_LONG = settings.get_current_profile_name() == LONG
RATE_HZ = 50.0 if IS_LONG else 4.0
FINGERS = {"left": "l_gripper_l_finger_joint", "right": "r_gripper_l_finger_joint"}

each_looked_at = sweep("name", SOLVABLE, ("vest", "hand-towel"))
"""Give a test the name of each plan; comparing hulls with the cloth takes 3 ms a sample."""


@cache
def looks_at(name: str) -> list[Look]:
    return looks(shipped_plan(name), RATE_HZ)


@each_looked_at
def test_no_part_of_a_free_hand_is_in_the_table(name: str) -> None:
    for look in looks_at(name):
        found = list(in_table(look, Table()))
        assert not found, f"at {look.frame.t_s:.2f} s: {found}"


@each_looked_at
def test_no_part_of_a_free_arm_is_low_over_cloth_but_near_its_grip(name: str) -> None:
    for look in looks_at(name):
        found = list(too_low(look, Table()))
        assert not found, f"at {look.frame.t_s:.2f} s: {found}"


@each_solvable
def test_no_finger_opens_before_the_cloth_lies(name: str) -> None:
    plan = shipped_plan(name)
    timeline, opened = Timeline.of(plan), 0
    for primitive in plan.primitives:
        end = primitive.start_s + primitive.duration_s
        lies = timeline.at(end - 1e-6).cloth.vertices
        times = np.arange(primitive.start_s, end, 0.02)
        openings = np.array([[track.opening_at(float(t)) for track in timeline.trajectory.grippers] for t in times])
        for arm in range(openings.shape[1]):
            is_opening = (openings[1:, arm] > openings[:-1, arm] + 1e-6) & (openings[1:, arm] > CLOSED_M)
            for t in times[1:][is_opening]:
                opened += 1
                np.testing.assert_allclose(timeline.at(float(t)).cloth.vertices, lies, atol=1e-9)
    assert opened > 0


@each_solvable
def test_fingers_are_no_faster_than_the_urdf_allows(name: str) -> None:
    path = required(shipped_plan(name).trajectory)
    times = np.arange(0.0, path.duration_s, 0.02)
    joints = [path.joints_at(float(t)) for t in times]
    for joint, limit in zip(FINGERS.values(), speed_limits([*FINGERS.values()]), strict=True):
        angles = np.array([at[joint] for at in joints])
        assert np.ptp(angles) > 0.1 or joint.startswith("l_"), f"{joint} never moves"
        assert np.abs(np.diff(angles) / np.diff(times)).max() <= limit + 1e-6


@pytest.mark.parametrize("rate_hz", [1.0, *(pytest.param(rate, marks=pytest.mark.long) for rate in (10.0, 30.0, 50.0))])
@each_solvable
def test_sample_times_strictly_grow_by_whole_steps_to_exactly_the_end(name: str, rate_hz: float) -> None:
    plan = shipped_plan(name)
    times = np.array([sample.t_s for sample in Timeline.of(plan).samples(rate_hz)])
    assert times[-1] == plan.cost_s
    steps = np.diff(times)
    assert steps[:-1] == pytest.approx(np.full(len(steps) - 1, 1.0 / rate_hz), abs=1e-9)
    assert 1e-6 < steps[-1] <= 1.0 / rate_hz + 1e-9
