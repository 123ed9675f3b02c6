"""Find joint paths for a transfer: all arms from before their grips, along the cloth's path, to after letting go."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache, partial
from itertools import combinations
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import ANGLE_RAD
from planner.motion.carried import Carried
from planner.motion.leads import BESIDE, FAR, NEAR, OVER, UP, Cloths, Lead, Leads, Lines, rolled
from planner.motion.lying_cloth import LyingCloth
from planner.motion.moments import Moments
from planner.motion.robot_port import Collisions, RobotPort
from planner.robots.joint_layout import JointLayout
from planner.robots.tool_path import IsFree, NoPath

_STEEP = 0.6
"""The sine of the pitch from which a hand may have one finger above the other.

The lower finger of a hand that points down less steeply would be pushed into the table.
"""

_LOOKED_AT = 5
"""The moments at which the arms' postures are tested together before a path is searched."""

_RUNS_KEPT, _PLACES_KEPT = 512, 8192
"""Sizes of the caches: transfers of some 50 kB each, and tool poses of some 2 kB each."""


@dataclass(frozen=True, slots=True)
class _Asked:
    """A transfer, identified by all that its joints depend on."""

    key: tuple[bytes, ...]
    cloths: Cloths
    moments: Moments = field(compare=False)

    @staticmethod
    def of(moments: Moments, cloths: Cloths) -> "_Asked":
        parts = (moments.positions, moments.rotations, moments.bases, moments.nominal_s, moments.is_driving)
        return _Asked(tuple(part.tobytes() for part in parts), cloths, moments)


_Pose: TypeAlias = tuple[bytes, bytes, bytes]
"""The cache key of a tool pose: the base's pose, the tool's position and its axes."""


def _pose(base: FloatArray, position: FloatArray, rotation: FloatArray) -> _Pose:
    return base.tobytes(), position.tobytes(), rotation.tobytes()


class Carrier:
    """Finds and caches the joint paths of transfers; most of them recur after a small change to the garment.

    May be shared between threads.
    """

    def __init__(self, machine: RobotPort, collisions: Collisions, torso_m: float, height_m: float) -> None:
        """Keep a robot, the height of its lift and that of the table (m), and empty caches."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m = torso_m
        self._height_m = height_m
        self._layout = JointLayout.of(machine.card)
        self._rolling = np.array([-1.0 if arm.is_mirrored else 1.0 for arm in machine.card.arms])
        self._searched = lru_cache(_RUNS_KEPT)(self._search)
        self._free_postures = lru_cache(_PLACES_KEPT)(self._search_postures)
        self._are_apart = lru_cache(_PLACES_KEPT)(self._search_apart)

    def carried(self, moments: Moments, cloths: Cloths) -> Carried | NoPath:
        """Return the joint paths of a transfer, or the moments at which there is no path. Cached."""
        return self._searched(_Asked.of(moments, cloths))

    def can_hold(self, moments: Moments, first: Iterable[int] = ()) -> bool:
        """Return whether the arms have free postures at a few moments; without them there is hardly ever a path.

        Args:
            moments: the moments of the transfer.
            first: the moments that are tested before others.
        """
        looks = _LOOKED_AT if moments.is_held.any(axis=1).sum() > 1 else 2
        return self.can_hold_at(moments, [*first, *np.linspace(0, len(moments) - 1, looks).astype(np.int64).tolist()])

    def can_hold_at(self, moments: Moments, which: Iterable[int]) -> bool:
        """Return whether the arms have free postures at some moments, each tested alone."""
        arms = [int(arm) for arm in np.flatnonzero(moments.is_held.any(axis=1))]
        rolls = _rolls(moments)[::-1]
        return all(any(self._can_hold(arms, moments, moment, roll) for roll in rolls) for moment in which)

    def _search(self, asked: "_Asked") -> Carried | NoPath:
        over = self._rolled(asked, OVER) if OVER in _rolls(asked.moments) else None
        return over if isinstance(over, Carried) else self._rolled(asked, BESIDE)

    def _rolled(self, asked: "_Asked", roll_rad: float) -> Carried | NoPath:
        """Return the joint paths of a transfer whose hands have a roll (rad)."""
        found = self._with_lines(asked, Lines(roll_rad, FAR))
        for shares in (UP, NEAR):
            if isinstance(found, Carried) or found.is_hopeless:
                break
            found = self._with_lines(asked, Lines(roll_rad, shares))
        return found

    def adapted(self, moments: Moments, cloths: Cloths, like: Carried) -> Carried | NoPath:
        """Return the joint paths of a transfer similar to a known one, close to its joints if possible."""
        near = self._near(moments, cloths, like)
        return self.carried(moments, cloths) if near is None else near

    def _near(self, moments: Moments, cloths: Cloths, like: Carried) -> Carried | None:
        if _Asked.of(moments, cloths) == _Asked.of(like.moments, like.cloths):
            return like
        are_same_arms = np.array_equal(moments.is_used, like.moments.is_used)
        if not are_same_arms or like.lines.roll_rad not in _rolls(moments):
            return None
        leads = self._leads(moments, like.lines, cloths)
        joints, guides = self._layout.at_home(len(leads.bases)), like.guides(leads.first, moments, len(leads.bases))
        are_free = self._are_free(leads, cloths)
        for lead in leads.each:
            span = self._layout.spans[lead.arm]
            known = guides[:, span]
            found = self._machine.arm_path_near(lead.arm, lead.path, self._torso_m, are_free[lead.arm], known)
            if found is None:
                return None
            joints[:, span] = found
        if len(leads.each) > 1 and not self._are_all_apart(joints):
            return None
        return self._half_turned(leads, moments, cloths, joints, like.lines)

    def _with_lines(self, asked: "_Asked", lines: Lines) -> Carried | NoPath:
        """Return the joint paths of a transfer, each hand on the first of its lines for which there is room.

        Where there is no path, return the moments at which an arm collides in every posture, or cannot pass the other.
        """
        moments, cloths = asked.moments, asked.cloths
        leads = self._leads(moments, lines, cloths)
        found = self._machine.arm_paths(
            {lead.arm: lead.path for lead in leads.each},
            self._torso_m,
            self._height_m,
            self._are_free(leads, cloths),
            self._collisions,
        )
        if isinstance(found, NoPath):
            return found
        joints = self._layout.at_home(len(leads.bases))
        joints[:, self._layout.joints_of(lead.arm for lead in leads.each)] = found
        return self._half_turned(leads, moments, cloths, joints, lines)

    def _leads(self, moments: Moments, lines: Lines, cloths: Cloths) -> Leads:
        rolls = lines.roll_rad * self._rolling
        return Leads.of(moments, lines, rolls, self._height_m, self._has_room, cloths)

    def _are_all_apart(self, joints: FloatArray) -> bool:
        """Return whether no arm touches another in any of some configurations."""
        return bool(self._collisions.arms_apart(tuple(self._layout.arms), joints).all())

    def _half_turned(self, leads: Leads, moments: Moments, cloths: Cloths, joints: FloatArray, lines: Lines) -> Carried:
        """Return the transfer with each hand turned by half a turn if that is nearer to home and collision-free.

        A hand whose last joint does not turn without end stays as it is.
        """
        layout, turned = self._layout, joints.copy()
        half_turns, are_free = np.zeros_like(layout.home), self._are_free(leads, cloths)
        for lead in leads.each:
            span = layout.spans[lead.arm]
            last = span.stop - 1
            away = joints[[0, -1], last] - layout.home[last]
            as_is, half = (np.abs(np.remainder(away + turn, 2.0 * np.pi) - np.pi).max() for turn in (np.pi, 0.0))
            if layout.is_continuous[last] and half < as_is - ANGLE_RAD:
                turned[:, last] += np.pi
                if are_free[lead.arm](np.arange(len(turned)), turned[:, span], True).all():
                    half_turns[last] = np.pi
                else:
                    turned[:, last] = joints[:, last]
        if len(leads.each) > 1 and half_turns.any() and not self._are_all_apart(turned):
            half_turns, turned = np.zeros_like(layout.home), joints
        return Carried(moments, cloths, leads.bases, turned, leads.first, lines, half_turns)

    def _are_free(self, leads: Leads, cloths: Cloths) -> dict[int, IsFree]:
        """Return for each arm that takes part a test for collisions with body, table and arms that stay at home.

        An empty hand also has to stay above the cloth, except near its grip.
        """
        layout = self._layout
        idle = set(layout.arms) - {lead.arm for lead in leads.each}

        def is_free(lead: Lead, steps: NDArray[np.int64], joints: FloatArray, is_certain: bool) -> BoolArray:
            arm = lead.arm
            answers = self._collisions.arm_free(arm, leads.bases[steps], joints, is_certain=is_certain)
            for cloth, must_clear in zip(cloths, lead.must_clear(steps), strict=True):
                asked = np.flatnonzero(answers & must_clear)
                if cloth is not None and len(asked):
                    bases = leads.bases[steps[asked]]
                    answers[asked] = cloth.arm_clear(arm, bases, joints[asked], is_certain=is_certain)
            if idle:
                every, near = layout.at_home(len(joints)), tuple(sorted({arm, *idle}))
                every[:, layout.spans[arm]] = joints
                answers &= self._collisions.arms_apart(near, every[:, layout.joints_of(near)], is_certain=is_certain)
            return answers

        return {lead.arm: partial(is_free, lead) for lead in leads.each}

    def _can_hold(self, arms: list[int], moments: Moments, moment: int, roll_rad: float) -> bool:
        """Return whether the arms have free postures at a moment, each alone and all together, with a given roll.

        An arm that takes no part in the transfer is at home.
        """
        held = [arm for arm in arms if moments.is_held[arm, moment]]
        poses: list[_Pose | None] = [None] * len(self._layout.arms)
        for arm in held:
            rotation = moments.rotations[arm, moment] @ rolled(roll_rad * self._rolling[arm])
            poses[arm] = _pose(moments.bases[moment], moments.positions[arm, moment], rotation)
        if len(held) < len(arms):
            return all(len(self._able(arm, pose)) > 0 for arm, pose in enumerate(poses))
        return self._are_apart(*poses)

    def _search_apart(self, *poses: "_Pose | None") -> bool:
        """Return whether all arms can take their tool poses at once without contact; None: at home."""
        able = [self._able(arm, pose) for arm, pose in enumerate(poses)]
        pairs = [*combinations(self._layout.arms, 2)]
        if not all(self._collisions.are_some_apart(pair, able[pair[0]], able[pair[1]]) for pair in pairs):
            return False
        if len(pairs) == 1:
            return True
        apart = np.ones([len(postures) for postures in able], dtype=np.bool_)
        for pair in pairs:
            beside = [arm for arm in self._layout.arms if arm not in pair]
            of_pair = self._collisions.postures_apart(pair, able[pair[0]], able[pair[1]])
            apart &= np.expand_dims(of_pair, beside)
        return bool(apart.any())

    def _able(self, arm: int, pose: "_Pose | None") -> FloatArray:
        """Return the postures of one arm at a tool pose, or at home, that touch neither body nor table."""
        return self._layout.home[None, self._layout.spans[arm]] if pose is None else self._free_postures(arm, *pose)

    def _postures(self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray) -> FloatArray:
        """Return the postures of one arm at a tool pose that touch neither body nor table. Cached."""
        return self._free_postures(arm, *_pose(base, position, rotation))

    def _search_postures(self, arm: int, base: bytes, position: bytes, rotation: bytes) -> FloatArray:
        stand, place, axes = (np.frombuffer(part) for part in (base, position, rotation))
        return self._machine.free_postures(
            arm,
            place,
            axes.reshape(3, 3),
            self._torso_m,
            lambda joints: self._collisions.arm_free(arm, stand[None], joints, is_certain=True),
        )

    def _has_room(
        self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray, cloth: LyingCloth | None
    ) -> bool:
        able = self._postures(arm, base, position, rotation)
        is_clear = cloth is None or cloth.arm_clear(arm, base[None], able, is_certain=True).any()
        return len(able) > 0 and bool(is_clear)


def _rolls(moments: Moments) -> tuple[float, ...]:
    """Return the rolls with which hands may hold cloth in a transfer (rad), the best first."""
    starts = (moments.rotations[arm, 0, 2, 0] for arm in np.flatnonzero(moments.is_held.any(axis=1)))
    return (OVER, BESIDE) if all(start < -_STEEP for start in starts) else (BESIDE,)
