"""Find the postures in which arms can hold cloth at single waypoints: a test much cheaper than a joint path."""

from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray
from planner.motion.answer_memory import RecentAnswers
from planner.motion.hand_holds import HandHold, Holds, opening_of, wide_holds
from planner.motion.lying_cloth import LyingCloth
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.transfer_tool_paths import rolled
from planner.motion.waypoints import Waypoints
from planner.robots.armed_robot import ArmedRobot
from planner.robots.collision.collisions import Collisions
from planner.robots.joint_layout import JointLayout

_LOOKED_AT = 5
"""The waypoints at which the arms' postures are tested together before a path is searched."""

_PLACES_KEPT = 2048
"""Size of the caches of tool poses, some 2 kB each. Twice as many save 0.02 % of a plan's time (measured)."""

_Pose: TypeAlias = tuple[Collisions, bytes, bytes, bytes]
"""The cache key of a tool pose: the collisions that count, the base's pose, the tool's position and its axes."""


def _pose(collisions: Collisions, base: FloatArray, position: FloatArray, rotation: FloatArray) -> _Pose:
    return collisions, base.tobytes(), position.tobytes(), rotation.tobytes()


class FreePostures:
    """Finds and caches the arms' collision-free postures at tool poses. May be shared between threads."""

    def __init__(self, machine: ArmedRobot, collisions: OpenedCollisions, torso_m: float) -> None:
        """Keep a robot and the height of its lift (m), and empty caches."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m = torso_m
        self._layout = JointLayout.of(machine.card)
        self._rolling = np.array([-1.0 if arm.is_mirrored else 1.0 for arm in machine.card.arms])
        self._free_postures = RecentAnswers[tuple[int, _Pose], FloatArray](_PLACES_KEPT)
        self._are_apart = RecentAnswers[tuple[_Pose | None, ...], bool](_PLACES_KEPT)

    def can_hold(self, waypoints: Waypoints, first: Iterable[int] = (), ways: Sequence[Holds] = ()) -> bool:
        """Return whether the arms have free postures at a few waypoints; without them there is hardly ever a path.

        Args:
            waypoints: the waypoints of the transfer.
            first: the waypoints that are tested before others.
            ways: the ways in which hands may hold; none given: those in which they open widely.
        """
        looks = _LOOKED_AT if waypoints.is_held.any(axis=1).sum() > 1 else 2
        which = [*first, *np.linspace(0, len(waypoints) - 1, looks).astype(np.int64).tolist()]
        return self.can_hold_at(waypoints, which, ways)

    def can_hold_at(self, waypoints: Waypoints, which: Iterable[int], ways: Sequence[Holds] = ()) -> bool:
        """Return whether the arms have free postures at some waypoints, each tested alone; see `can_hold`."""
        arms = [int(arm) for arm in np.flatnonzero(waypoints.is_held.any(axis=1))]
        ways = ways or wide_holds(waypoints)[::-1]
        return all(any(self._can_hold(arms, waypoints, waypoint, holds) for holds in ways) for waypoint in which)

    def _can_hold(self, arms: list[int], waypoints: Waypoints, waypoint: int, holds: Holds) -> bool:
        """Return whether the arms have free postures at a moment, each alone and all together, as hands hold.

        An arm that takes no part in the transfer is at home.
        """
        held = [arm for arm in arms if waypoints.is_held[arm, waypoint]]
        poses: list[_Pose | None] = [None] * len(self._layout.arms)
        for arm in held:
            rotation = waypoints.rotations[arm, waypoint] @ rolled(holds[arm].roll_rad * self._rolling[arm])
            collisions = self._collisions.of(holds[arm], is_open=False)
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
