"""Find joint paths for a transfer: all arms from before their grips, along the cloth's path, to after letting go."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import combinations
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.motion.answer_memory import RecentAnswers, digest
from planner.motion.hand_holds import HandHold, Holds, edge_holds, opening_of, settles, usual_holds
from planner.motion.lying_cloth import LyingCloth
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.transfer_path import TransferPath
from planner.motion.transfer_tool_paths import (
    FAR,
    NEAR,
    UP,
    ApproachLines,
    Cloths,
    TransferToolPath,
    TransferToolPaths,
    rolled,
)
from planner.motion.waypoints import Waypoints
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import JointLayout
from planner.robots.collision.collisions import Collisions
from planner.robots.tool_path import IsFree, NoPath

_LOOKED_AT = 5
"""The waypoints at which the arms' postures are tested together before a path is searched."""

_PLACES_KEPT = 2048
"""Size of the caches of tool poses, some 2 kB each. Twice as many save 0.02 % of a plan's time (measured)."""

_Pose: TypeAlias = tuple[Collisions, bytes, bytes, bytes]
"""The cache key of a tool pose: the collisions that count, the base's pose, the tool's position and its axes."""


def _pose(collisions: Collisions, base: FloatArray, position: FloatArray, rotation: FloatArray) -> _Pose:
    return collisions, base.tobytes(), position.tobytes(), rotation.tobytes()


class FreePostures:
    """Finds and caches the arms' collision-free postures at tool poses. May be shared between threads.

    To test single waypoints is much cheaper than to search for a joint path.
    """

    def __init__(self, machine: ArmedRobot, collisions: OpenedCollisions, torso_m: float, height_m: float) -> None:
        """Keep a robot, the height of its lift and that of the table (m), and empty caches."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m, self._height_m = torso_m, height_m
        self._layout = JointLayout.of(machine.card)
        self._rolling = np.array([-1.0 if arm.is_mirrored else 1.0 for arm in machine.card.arms])
        self._free_postures = RecentAnswers[tuple[int, _Pose], FloatArray](_PLACES_KEPT)
        self._are_apart = RecentAnswers[tuple[_Pose | None, ...], bool](_PLACES_KEPT)

    def can_hold(self, waypoints: Waypoints, first: Iterable[int] = (), ways: Sequence[Holds] = ()) -> bool:
        """Return whether the arms have free postures at a few waypoints; without them there is hardly ever a path.

        Args:
            waypoints: the waypoints of the transfer.
            first: the waypoints that are tested before others.
            ways: the ways in which hands may hold; none given: the usual ones.
        """
        looks = _LOOKED_AT if waypoints.is_held.any(axis=1).sum() > 1 else 2
        which = [*first, *np.linspace(0, len(waypoints) - 1, looks).astype(np.int64).tolist()]
        return self.can_hold_at(waypoints, which, ways)

    def can_hold_at(self, waypoints: Waypoints, which: Iterable[int], ways: Sequence[Holds] = ()) -> bool:
        """Return whether the arms have free postures at some waypoints, each tested alone; see `can_hold`."""
        arms = [int(arm) for arm in np.flatnonzero(waypoints.is_held.any(axis=1))]
        ways = ways or usual_holds(waypoints, self._height_m)[::-1]
        return all(any(self._can_hold(arms, waypoints, waypoint, holds) for holds in ways) for waypoint in which)

    def _can_hold(self, arms: list[int], waypoints: Waypoints, waypoint: int, holds: Holds) -> bool:
        """Return whether the arms have free postures at a waypoint, each alone and all together, given how hands hold.

        An arm that takes no part in the transfer is at home.
        """
        held = [arm for arm in arms if waypoints.is_held[arm, waypoint]]
        poses: list[_Pose | None] = [None] * len(self._layout.arms)
        for arm in held:
            rotation = waypoints.rotations[arm, waypoint] @ rolled(holds[arm].roll_rad * self._rolling[arm])
            is_open = holds[arm].raised_m == 0.0 and waypoint in waypoints.is_held[arm].nonzero()[0][[0, -1]]
            collisions = self._collisions.of(holds[arm], is_open=is_open)
            poses[arm] = _pose(collisions, waypoints.bases[waypoint], waypoints.positions[arm, waypoint], rotation)
        if len(held) < len(arms):
            return all(len(self._able(arm, pose)) > 0 for arm, pose in enumerate(poses))
        return self._are_apart.answer(tuple(poses), self._search_apart)

    def _search_apart(self, poses: "tuple[_Pose | None, ...]") -> bool:
        """Return whether all arms can take their tool poses at once without contact; None: at home."""
        able = [self._able(arm, pose) for arm, pose in enumerate(poses)]
        pairs = [*combinations(self._layout.arms, 2)]
        if not all(self._collisions.wide.are_some_apart(pair, able[pair[0]], able[pair[1]]) for pair in pairs):
            return False
        if len(pairs) == 1:
            return True
        apart = np.ones([len(postures) for postures in able], dtype=np.bool_)
        for pair in pairs:
            beside = [arm for arm in self._layout.arms if arm not in pair]
            of_pair = self._collisions.wide.postures_apart(pair, able[pair[0]], able[pair[1]])
            apart &= np.expand_dims(of_pair, beside)
        return bool(apart.any())

    def _able(self, arm: int, pose: "_Pose | None") -> FloatArray:
        """Return the postures of one arm at a tool pose, or at home, that touch neither body nor table."""
        if pose is None:
            return self._layout.home[None, self._layout.spans[arm]]
        return self._free_postures.answer((arm, pose), self._search_postures)

    def _search_postures(self, wanted: "tuple[int, _Pose]") -> FloatArray:
        arm, (collisions, base, position, rotation) = wanted
        stand, place, axes = (np.frombuffer(part) for part in (base, position, rotation))
        return self._machine.free_postures(
            arm,
            place,
            axes.reshape(3, 3),
            self._torso_m,
            lambda joints: collisions.arm_free(arm, stand[None], joints),
        )

    def has_room(
        self,
        arm: int,
        hold: HandHold,
        base: FloatArray,
        position: FloatArray,
        rotation: FloatArray,
        cloth: LyingCloth | None,
    ) -> bool:
        """Return whether an arm has a free posture at a tool pose, and one that is high enough above cloth.

        Its fingers are open as far as they are before and after it holds cloth.
        """
        able = self._able(arm, _pose(self._collisions.of(hold, is_open=True), base, position, rotation))
        is_clear = cloth is None or cloth.arm_clear(arm, base[None], able, opening_m=opening_of(hold)).any()
        return len(able) > 0 and bool(is_clear)


TRANSFERS_KEPT = 256
"""Size of the cache of transfers, some 45 kB each: one search may ask for 140 (measured), and the next for the same."""


@dataclass(frozen=True, slots=True)
class _TransferKey:
    """A transfer, identified by all that its joints depend on."""

    key: bytes
    cloths: Cloths
    waypoints: Waypoints = field(compare=False)

    @staticmethod
    def of(waypoints: Waypoints, cloths: Cloths) -> "_TransferKey":
        parts = (waypoints.positions, waypoints.rotations, waypoints.bases, waypoints.nominal_s, waypoints.is_driving)
        # The arrays are there once already, in the waypoints.
        texts = (text for part in parts for text in (f"{part.dtype}{part.shape}".encode(), part.tobytes()))
        return _TransferKey(digest(*texts), cloths, waypoints)


class TransferPathFinder:
    """Finds and caches the joint paths of transfers; most of them recur after a small change to the garment.

    May be shared between threads.

    Attributes:
        postures: the arms' free postures at single tool poses.
    """

    def __init__(self, machine: ArmedRobot, collisions: OpenedCollisions, torso_m: float, height_m: float) -> None:
        """Keep a robot, the height of its lift and that of the table (m), and empty caches."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m = torso_m
        self._height_m = height_m
        self._layout = JointLayout.of(machine.card)
        self._rolling = np.array([-1.0 if arm.is_mirrored else 1.0 for arm in machine.card.arms])
        self._searched = RecentAnswers[tuple[_TransferKey, Holds], TransferPath | NoPath](TRANSFERS_KEPT)
        self.postures = FreePostures(machine, collisions, torso_m, height_m)

    def transfer_path(self, waypoints: Waypoints, cloths: Cloths, ways: Sequence[Holds] = ()) -> TransferPath | NoPath:
        """Return the joint paths of a transfer, or the waypoints at which there is no path. Cached.

        Args:
            waypoints: the waypoints while cloth is held.
            cloths: the cloth on the table before and after.
            ways: the ways in which hands may hold, the best first; none given: the usual ones.
        """
        key = _TransferKey.of(waypoints, cloths)
        *others, last = ways or usual_holds(waypoints, self._height_m)
        found = (self._searched.answer((key, holds), self._search) for holds in others)
        best = next((one for one in found if isinstance(one, TransferPath)), None)
        return self._searched.answer((key, last), self._search) if best is None else best

    def _search(self, wanted: tuple[_TransferKey, Holds]) -> TransferPath | NoPath:
        """Return the joint paths of a transfer whose hands hold in given ways."""
        key, holds = wanted
        found = self._with_lines(key, ApproachLines(holds, FAR))
        for shares in (UP, NEAR):
            if isinstance(found, TransferPath) or found.is_hopeless:
                break
            found = self._with_lines(key, ApproachLines(holds, shares))
        return found

    def adapted(self, waypoints: Waypoints, cloths: Cloths, like: TransferPath) -> TransferPath | NoPath:
        """Return the joint paths of a transfer similar to a known one, close to its joints if possible."""
        near = self._near(waypoints, cloths, like)
        return self.transfer_path(waypoints, cloths) if near is None else near

    def _near(self, waypoints: Waypoints, cloths: Cloths, like: TransferPath) -> TransferPath | None:
        if _TransferKey.of(waypoints, cloths) == _TransferKey.of(like.waypoints, like.cloths):
            return like
        are_same_arms = np.array_equal(waypoints.is_used, like.waypoints.is_used)
        holds = (*usual_holds(waypoints, self._height_m), edge_holds(self._machine, waypoints))
        if not are_same_arms or like.lines.holds not in holds:
            return None
        tool_paths = self._tool_paths(waypoints, like.lines, cloths)
        joints, guides = (
            self._layout.at_home(len(tool_paths.bases)),
            like.guides(tool_paths.first, waypoints, len(tool_paths.bases)),
        )
        are_free = self._are_free(tool_paths, cloths, like.lines.holds)
        for approach in tool_paths.each:
            span = self._layout.spans[approach.arm]
            known = guides[:, span]
            found = self._machine.arm_path_near(
                approach.arm, approach.path, self._torso_m, are_free[approach.arm], known
            )
            if found is None:
                return None
            joints[:, span] = found
        if len(tool_paths.each) > 1 and not self._are_all_apart(joints):
            return None
        return self._half_turned(tool_paths, waypoints, cloths, joints, like.lines)

    def _with_lines(self, key: _TransferKey, lines: ApproachLines) -> TransferPath | NoPath:
        """Return the joint paths of a transfer, each hand on the first of its lines for which there is room.

        Without a path, return the waypoints at which an arm collides in every posture, or cannot pass the other.
        """
        waypoints, cloths = key.waypoints, key.cloths
        tool_paths = self._tool_paths(waypoints, lines, cloths)
        found = self._machine.arm_paths(
            {approach.arm: approach.path for approach in tool_paths.each},
            self._torso_m,
            self._height_m,
            self._are_free(tool_paths, cloths, lines.holds),
            self._collisions.wide,
        )
        if isinstance(found, NoPath):
            return found
        joints = self._layout.at_home(len(tool_paths.bases))
        joints[:, self._layout.joints_of(approach.arm for approach in tool_paths.each)] = found
        return self._half_turned(tool_paths, waypoints, cloths, joints, lines)

    def _tool_paths(self, waypoints: Waypoints, lines: ApproachLines, cloths: Cloths) -> TransferToolPaths:
        rolls = self._rolling * [hold.roll_rad for hold in lines.holds]
        return TransferToolPaths.of(waypoints, lines, rolls, self._height_m, self.postures.has_room, cloths)

    def _are_all_apart(self, joints: FloatArray) -> bool:
        """Return whether no arm touches another in any of some configurations."""
        return bool(self._collisions.wide.arms_apart(tuple(self._layout.arms), joints).all())

    def _half_turned(
        self,
        tool_paths: TransferToolPaths,
        waypoints: Waypoints,
        cloths: Cloths,
        joints: FloatArray,
        lines: ApproachLines,
    ) -> TransferPath:
        """Return the transfer with each hand turned by half a turn if that is nearer to home and collision-free.

        A hand stays as it is if its last joint does not turn without end, or if that would move its tool aside.
        """
        layout = self._layout
        if settles(lines.holds):
            joints = self._rested(tool_paths, waypoints, joints, lines.holds)
        turned = joints.copy()
        half_turns, are_free = np.zeros_like(layout.home), self._are_free(tool_paths, cloths, lines.holds)
        for approach in tool_paths.each:
            span = layout.spans[approach.arm]
            last = span.stop - 1
            away = joints[[0, -1], last] - layout.home[last]
            as_is, half = (np.abs(np.remainder(away + turn, 2.0 * np.pi) - np.pi).max() for turn in (np.pi, 0.0))
            is_nearer = layout.is_continuous[last] and half < as_is - ANGLE_RAD
            if is_nearer and keeps_tool(self._machine, approach.arm, joints[0, span], self._torso_m):
                turned[:, last] += np.pi
                if are_free[approach.arm](np.arange(len(turned)), turned[:, span]).all():
                    half_turns[last] = np.pi
                else:
                    turned[:, last] = joints[:, last]
        if len(tool_paths.each) > 1 and half_turns.any() and not self._are_all_apart(turned):
            half_turns, turned = np.zeros_like(layout.home), joints
        return TransferPath(waypoints, cloths, tool_paths.bases, turned, tool_paths.first, lines, half_turns)

    def _rested(
        self, tool_paths: TransferToolPaths, waypoints: Waypoints, joints: FloatArray, holds: Holds
    ) -> FloatArray:
        """Return joints of which those of hands that open where they hold rest while other hands settle."""
        rested, first, last = joints.copy(), tool_paths.first, tool_paths.first + len(waypoints) - 1
        for approach in tool_paths.each:
            if holds[approach.arm].raised_m == 0.0:
                span = self._layout.spans[approach.arm]
                rested[first - 1, span], rested[last + 1, span] = joints[first, span], joints[last, span]
        return rested

    def _are_free(self, tool_paths: TransferToolPaths, cloths: Cloths, holds: Holds) -> dict[int, IsFree]:
        """Return for each arm that takes part a test for collisions with body, table and arms that stay at home.

        An empty hand also has to stay above the cloth, except near its grip.
        """
        layout, collisions = self._layout, self._collisions

        def arm_free(approach: TransferToolPath, steps: NDArray[np.int64], joints: FloatArray) -> BoolArray:
            """Return at which steps an arm touches neither body nor table, its fingers open as they are then."""
            arm, bases = approach.arm, tool_paths.bases[steps]
            opened, held = (collisions.of(holds[arm], is_open=is_open) for is_open in (True, False))
            if opened is held:
                return opened.arm_free(arm, bases, joints)
            answers = np.empty(len(steps), dtype=np.bool_)
            is_open = approach.is_open(steps, opens_on_path=holds[arm].raised_m == 0.0)
            for rows, fingers in ((is_open, opened), (~is_open, held)):
                answers[rows] = fingers.arm_free(arm, bases[rows], joints[rows])
            return answers

        idle = set(layout.arms) - {approach.arm for approach in tool_paths.each}

        def is_free(approach: TransferToolPath, steps: NDArray[np.int64], joints: FloatArray) -> BoolArray:
            arm = approach.arm
            answers = arm_free(approach, steps, joints)
            for cloth, must_clear in zip(cloths, approach.must_clear(steps), strict=True):
                rows = np.flatnonzero(answers & must_clear)
                if cloth is not None and len(rows):
                    bases = tool_paths.bases[steps[rows]]
                    opening_m = opening_of(holds[arm])
                    answers[rows] = cloth.arm_clear(arm, bases, joints[rows], opening_m=opening_m)
            if idle:
                every, near = layout.at_home(len(joints)), tuple(sorted({arm, *idle}))
                every[:, layout.spans[arm]] = joints
                answers &= self._collisions.wide.arms_apart(near, every[:, layout.joints_of(near)])
            return answers

        return {approach.arm: partial(is_free, approach) for approach in tool_paths.each}


def keeps_tool(machine: ArmedRobot, arm: int, joints: FloatArray, torso_m: float) -> bool:
    """Return whether half a turn of an arm's last joint leaves its tool where it is, and pointing as it does.

    It does where the joint turns about the approach axis, through the tool, and not beside it.

    Args:
        machine: the robot.
        arm: the arm.
        joints: the arm's joints (rad), shape (joints,).
        torso_m: how far the lift is raised (m).
    """
    turned = joints.copy()
    turned[-1] += np.pi
    (place, axes), (other, others) = (machine.tool_pose(arm, one, torso_m) for one in (joints, turned))
    return bool(np.allclose(place, other, atol=LENGTH_M) and np.allclose(axes[:, 0], others[:, 0], atol=ANGLE_RAD))
