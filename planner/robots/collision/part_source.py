"""Make the parts of a described robot from the shapes of its links."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.geometry.pose import FloatArray
from planner.robots.card import EDGE_OPEN_M, HELD_M
from planner.robots.collision.clusters import clusters
from planner.robots.collision.link_shapes import LinkShape, link_shapes
from planner.robots.collision.pair_choice import Solids
from planner.robots.collision.rigid_groups import BODY, Carrier, Skeleton
from planner.robots.collision.rounded_hull import RoundedHull, hull_corners, rounded_hull
from planner.robots.described_robot import DescribedRobot

SMALL_M = (0.0, HELD_M, EDGE_OPEN_M)
"""Openings for which fingers have shapes (m): those with which one of them may be under cloth."""

SHARES = (1 / 3, 2 / 3, 1.0)
"""Shares of the widest opening for which they have shapes besides."""

LEVELS = len(SMALL_M) + len(SHARES)

ROUNDING_MAX_M, TIPS_ROUNDING_MAX_M, EDGE_ROUNDING_MAX_M = 0.003, 0.0003, 0.0001
"""Limits on how far a part may exceed the hull of its meshes (m).

Fingertips have a tighter limit because they pass the table's top by half a millimetre, and the tightest where they are
open so little that one may be under cloth.
"""

ROUNDING_SHARE_MAX = 0.015
"""The same limit as a share of the part's size, for small arms."""

OF_JOINT_MAX, OF_BODY_MAX = 3, 8
"""Largest number of parts that one joint carries, and of the body's parts on either side of the lift."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A part.

    Attributes:
        name: its name for people.
        carrier: what carries it.
        hulls: for each opening of the fingers its shape, in its carrier's frame.
        is_tip: whether it reaches to the tool, and so to the table when cloth is gripped.
        solids: the shapes of its links as they are.
    """

    name: str
    carrier: Carrier
    hulls: tuple[RoundedHull, ...]
    is_tip: bool
    solids: Solids


def make_parts(robot: DescribedRobot) -> list[Part]:
    """Return a robot's parts: those of its arms from the shoulder outwards, then the body's.

    Raises:
        RobotError: a mesh cannot be read or is too large.
    """
    skeleton = Skeleton(robot)
    groups: dict[Carrier, list[LinkShape]] = {}
    for shape in link_shapes(skeleton.model, robot.urdf):
        groups.setdefault(skeleton.carrier(shape.joint), []).append(shape)
    carriers = sorted(groups, key=lambda carrier: (carrier.arm == BODY, carrier))
    return [part for carrier in carriers for part in _parts(robot, skeleton, carrier, groups[carrier])]


def openings_m(robot: DescribedRobot) -> tuple[float, ...]:
    """Return the openings of the fingers for which there are shapes (m)."""
    widest_m = max(arm.card.gripper.opening_max_m for arm in robot.arms)
    return tuple(sorted((*(min(one, widest_m) for one in SMALL_M), *(share * widest_m for share in SHARES))))


def _parts(robot: DescribedRobot, skeleton: Skeleton, carrier: Carrier, shapes: Sequence[LinkShape]) -> Iterator[Part]:
    if carrier.is_finger:
        name = f"{robot.arms[carrier.arm].card.name} fingers"
        hulls = tuple(_finger_hull(skeleton, shapes, opening_m) for opening_m in openings_m(robot))
        yield Part(name, carrier, hulls, True, _solids(skeleton, shapes))
        return
    clouds = [skeleton.points(shape) for shape in shapes]
    for cluster in clusters(clouds, OF_BODY_MAX if carrier.arm == BODY else OF_JOINT_MAX):
        of_cluster = [shapes[number] for number in cluster]
        points = hull_corners(np.vstack([clouds[number] for number in cluster]))
        name = _name(robot, carrier, of_cluster[0].link)
        is_tip = carrier.arm != BODY and _reaches_tool(robot, carrier, points)
        hull = rounded_hull(points, TIPS_ROUNDING_MAX_M if is_tip else _rounding_m(points))
        yield Part(name, carrier, (hull,) * LEVELS, is_tip, _solids(skeleton, of_cluster))


def _finger_hull(skeleton: Skeleton, shapes: Sequence[LinkShape], opening_m: float) -> RoundedHull:
    """Return the shape of fingers that may be anywhere from closed to an opening."""
    ways, bent_m = zip(*(skeleton.swept(shape, opening_m) for shape in shapes), strict=True)
    rounding_m = TIPS_ROUNDING_MAX_M if opening_m > EDGE_OPEN_M else EDGE_ROUNDING_MAX_M
    hull = rounded_hull(hull_corners(np.vstack(ways)), rounding_m)
    return replace(hull, radius_m=hull.radius_m + max(bent_m))


def _solids(skeleton: Skeleton, shapes: Sequence[LinkShape]) -> Solids:
    return tuple((shape.geometry, skeleton.placement(shape)) for shape in shapes)


def _rounding_m(points: FloatArray) -> float:
    return min(ROUNDING_MAX_M, ROUNDING_SHARE_MAX * float(np.linalg.norm(np.ptp(points, axis=0))))


def _reaches_tool(robot: DescribedRobot, carrier: Carrier, points: FloatArray) -> bool:
    """Return whether a part reaches further along the approach axis than to the middle of the fingers."""
    arm = robot.arms[carrier.arm]
    if carrier.joint < len(arm.chain.low) - 1:
        return False
    beyond_m = (points - arm.chain.tool_offset) @ arm.chain.tool_rotation[:, 0]
    return bool(beyond_m.max() > -0.5 * arm.card.gripper.finger_length_m)


def _name(robot: DescribedRobot, carrier: Carrier, link: str) -> str:
    """Return a part's name for people: the arm's, and what the link's adds to it."""
    words = [word for word in link.split("_") if word not in ("link", "")]
    if carrier.arm == BODY:
        return " ".join(words)
    arm = robot.arms[carrier.arm].card.name
    return " ".join([arm, *(word for word in words[:-1] if word != arm), *words[-1:]])
