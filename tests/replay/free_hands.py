"""Hands that hold nothing, seen independently: what of them is in the table, or too low over the cloth.

The robot's hulls and poses are those of `tests.replay.hulls`, the cloth that lies is taken from the drawn surface.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import coal
import numpy as np
import shapely
import trimesh

from planner import Plan
from planner.geometry.table import Table, table_parts
from planner.motion.timeline import Sample, Timeline
from tests.replay.hands import CLOSED_M, seen
from tests.replay.hulls import Body, bodies, robot

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
