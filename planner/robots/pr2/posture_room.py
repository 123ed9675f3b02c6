"""A test of whether any of the arm's postures at a tool pose is clear of the robot's own body.

To reach something close to the body the arm folds its forearm against the shoulder. Joint limits allow it, the body
does not. Paths are validated only in the end, so without this test the search would plan with such places and have them
rejected one by one. So a place counts as reachable only if at least one of some sampled postures there is clear of what
stands still whatever the arms do: the body and its own shoulder. Whether a path leads from one posture to the next,
past the table and the other arm, which may be anywhere, is left to the joint paths. A restricted task may ask for room
beside the other arm at home, too: there, joint paths are mostly found at once.

Answers are remembered for places on a grid (`PlaceMemory`).

As in `planner.robots.pr2.kernel` the arm is a left arm, and tool poses are seen from its shoulder.
"""

import math
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.collision.part_poses import PLACE, Index, set_middles
from planner.robots.collision.robot_parts import RobotParts, compiled_parts
from planner.robots.collision.separation import Parts, first_close_pair
from planner.robots.pr2.aim import ToolPose
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_poses import EACH, pose_arm
from planner.robots.pr2.inverse_kinematics import place_wrist, turn_hand
from planner.robots.pr2.joint_slack import slacks
from planner.robots.pr2.pan_arcs import pan_arcs, pan_on

CELL_BITS = 18
"""Bits of a coordinate in grid steps: with steps of `LENGTH_M`, 1.3 m either way."""

_SCATTER = 0x1E3779B97F4A7C15
"""Odd multiplier of the hash function, which spreads neighbouring keys over the table."""


class PlaceMemory(NamedTuple):
    """The memory of answers: the hash table, its length a power of two, and its number of entries.

    An entry is twice its key, plus the answer; 0 is empty; collisions are resolved by linear probing. When the table is
    three quarters full it stores no more, and the answers stay the same.
    """

    table: NDArray[np.int64]
    entries: NDArray[np.int64]


def empty_memory(bits: int = 18) -> PlaceMemory:
    """Return a memory with room for 2 ** bits entries, of which it uses three quarters."""
    return PlaceMemory(np.zeros(1 << bits, dtype=np.int64), np.zeros(1, dtype=np.int64))


@kernel
def place_key(label: int, x: int, y: int, z: int) -> int:
    """Return the key of a place, in steps of `LENGTH_M` from the shoulder, and an approach's label."""
    half = 1 << (CELL_BITS - 1)
    return (((((label << CELL_BITS) + x + half) << CELL_BITS) + y + half) << CELL_BITS) + z + half


@kernel
def slot_of(table: NDArray[np.int64], key: int) -> int:
    """Return the slot in the table where a key is, or should go."""
    scattered = key * _SCATTER
    slot = (scattered ^ (scattered >> 29) ^ (scattered >> 45)) & (len(table) - 1)
    while table[slot] != 0 and table[slot] >> 1 != key:
        slot = (slot + 1) & (len(table) - 1)
    return slot


@kernel
def learn(memory: PlaceMemory, slot: int, key: int, answer: bool) -> None:
    """Store an answer in the slot that was found for its key, while there is room."""
    if 4 * memory.entries[0] < 3 * len(memory.table):
        memory.table[slot] = 2 * key + (1 if answer else 0)
        memory.entries[0] += 1


SAMPLES = 12
"""Postures at each tool pose for each branch of the elbow, over all arcs."""

SHOULDER, SHOULDER_LIFT, UPPER_ARM, FOREARM, WRIST, PALM, FINGERS = 0, 1, 2, 4, 5, 6, 7
BASE, TORSO = 0, 1
"""Indices of parts: those of an arm above, those of the body here."""

CELL_M = 0.02
"""Size of a cell (m); the answer at its centre holds for all of it."""

AHEAD_M = 0.5
"""Distance ahead of the shoulder beyond which the body never hinders a wrist (m)."""


class Room(NamedTuple):
    """The obstacles to an arm's postures.

    Attributes:
        lift: how far the torso is raised (m).
        parts: all parts of the robot.
        poses: the parts' poses; those of the left arm are overwritten, shape (p, 5, 3).
        pairs: the parts compared, shape (q, 2); none: there is room everywhere.
        margin: the distance that they should keep (m).
        memory: earlier answers for cells of places.
    """

    lift: float
    parts: Parts
    poses: FloatArray
    pairs: Index
    margin: float
    memory: PlaceMemory


@kernel
def may_be_hindered(aim: ToolPose) -> bool:
    """Return whether a wrist is so near that the body may hinder it; a test at no cost."""
    return aim.x <= AHEAD_M


@kernel
def has_room_about(shape: ArmShape, room: Room, label: int, aim: ToolPose, arcs: FloatArray) -> bool:
    """Return whether some posture is clear at the centre of the cell that contains the wrist.

    `label` distinguishes approaches. The room's margin should allow for the size of a cell, so that a cell without room
    at its centre has none anywhere.
    """
    if len(room.pairs) == 0 or not may_be_hindered(aim):
        return True
    x, y, z = round(aim.x / CELL_M), round(aim.y / CELL_M), round(aim.z / CELL_M)
    key = place_key(label, x, y, z)
    slot = slot_of(room.memory.table, key)
    if room.memory.table[slot] != 0:
        known: bool = room.memory.table[slot] & 1 == 1
        return known
    middle = ToolPose(x * CELL_M, y * CELL_M, z * CELL_M, aim.ax, aim.ay, aim.az)
    answer = has_room(shape, room, middle, arcs)
    learn(room.memory, slot, key, answer)
    return answer


@kernel
def blocked_for(room: Room, label: int, aim: ToolPose, towards: FloatArray) -> float:
    """Return how far a wrist moves along a direction within a cell known to have no room (m); 0 if none is known."""
    if len(room.pairs) == 0 or not may_be_hindered(aim):
        return 0.0
    x, y, z = round(aim.x / CELL_M), round(aim.y / CELL_M), round(aim.z / CELL_M)
    known = room.memory.table[slot_of(room.memory.table, place_key(label, x, y, z))]
    if known == 0 or known & 1 == 1:
        return 0.0
    out = math.inf if towards[0] <= 0.0 else (AHEAD_M - aim.x) / towards[0]
    for at, cell, along in ((aim.x, x, towards[0]), (aim.y, y, towards[1]), (aim.z, z, towards[2])):
        if along != 0.0:
            out = min(out, ((cell + math.copysign(0.5, along)) * CELL_M - at) / along)
    return max(out, 0.0)


@kernel
def has_room(shape: ArmShape, room: Room, aim: ToolPose, arcs: FloatArray) -> bool:
    """Return whether some posture at a tool pose is clear; `arcs`, shape (MOST_ARCS, 2), is scratch space."""
    joints, near, rotation = np.empty(7), np.zeros(7), np.zeros((3, 3))
    _level(aim, rotation)
    count = pan_arcs(shape, aim, arcs)
    per = max(SAMPLES // max(count, 1), 2)
    for arc in range(count):
        for sample in range(2 * per):
            theta = (sample // 2 + 0.5) * math.pi / per
            branch = 1.0 - 2.0 * (sample % 2)
            pan = pan_on(arcs[arc], theta)
            if slacks(shape, aim, pan)[sample % 2] < 0.0:
                continue
            place_wrist(shape, aim, pan, branch, joints)
            turn_hand(shape, aim, rotation, near, joints)
            if not np.isnan(joints.sum()) and _is_clear(shape, room, joints):
                return True
    return False


@kernel
def _is_clear(shape: ArmShape, room: Room, joints: FloatArray) -> bool:
    """Return whether the left arm's parts are apart from what they are compared with."""
    corners, spans, bounds, _ = room.parts
    pose_arm(shape, room.lift, joints, 1.0, room.poses[:EACH])
    set_middles(bounds[:EACH], room.poses[:EACH])
    return first_close_pair(corners, spans, bounds, room.poses, room.pairs, 0, room.margin) < 0


@kernel
def _level(aim: ToolPose, rotation: FloatArray) -> None:
    """Set a tool's axes for a tool pose, its y axis horizontal."""
    flat = math.hypot(aim.ax, aim.ay)
    cos, sin = (aim.ax / flat, aim.ay / flat) if flat > 0.0 else (1.0, 0.0)
    rotation[0, 0], rotation[1, 0], rotation[2, 0] = aim.ax, aim.ay, aim.az
    rotation[0, 1], rotation[1, 1], rotation[2, 1] = -sin, cos, 0.0
    rotation[0, 2], rotation[1, 2], rotation[2, 2] = -cos * aim.az, -sin * aim.az, flat


def room_beside(shape: ArmShape, robot: RobotParts, torso_m: float, home: FloatArray | None = None) -> Room:
    """Return the room that the body leaves the left arm.

    Args:
        shape: the left arm.
        robot: the robot's parts.
        torso_m: how far the torso is raised (m).
        home: the joints of the right arm if its upper part is an obstacle too (rad), shape (7,).
    """
    parts = compiled_parts(robot, 0)
    poses = np.zeros((len(parts.bounds), 5, 3))
    poses[2 * EACH :, : PLACE + 1] = robot.body_poses
    poses[2 * EACH + 1 :, PLACE, 2] += torso_m
    others: tuple[int, ...] = ()
    if home is not None:
        pose_arm(shape, torso_m, home, -1.0, poses[EACH : 2 * EACH])
        others = tuple(EACH + part for part in (SHOULDER, SHOULDER_LIFT, UPPER_ARM))
    set_middles(parts.bounds, poses)
    body = (2 * EACH + part for part in (BASE, TORSO))
    pairs = np.array([*product((FOREARM, WRIST, PALM, FINGERS), (SHOULDER, *others, *body))])
    return Room(torso_m, parts, poses, pairs, -CELL_M / 2, empty_memory())


def no_walls() -> Room:
    """Return a room without obstacles."""
    corners, bounds = np.empty((0, 3)), np.empty((0, 8))
    nothing = Parts(corners, np.empty((0, 2), dtype=np.int64), bounds, np.empty((0, 4), dtype=np.int64))
    return Room(0.0, nothing, np.empty((0, 5, 3)), np.empty((0, 2), dtype=np.int64), 0.0, empty_memory(1))
