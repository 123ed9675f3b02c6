"""Joint paths for a run: both arms from before their grips, along the cloth's way, to where they have let go."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache, partial
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
from planner.robot.tool_path import IsFree, NoPath

_STEEP = 0.6
"""Hands that point down by more than the angle of this sine may have one finger over the other; flatter ones would
push the lower one into the table."""

_LOOKED_AT = 5
"""At so many moments it is looked whether arms can be in their places together before they are led there."""

_RUNS_KEPT, _PLACES_KEPT = 512, 8192
"""So many answers are remembered: of runs, some 50 kB each, and of places of a hand, some 2 kB each."""


@dataclass(frozen=True, slots=True)
class _Asked:
    """A run, known by all that its joints depend on."""

    key: tuple[bytes, ...]
    cloths: Cloths
    moments: Moments = field(compare=False)

    @staticmethod
    def of(moments: Moments, cloths: Cloths) -> "_Asked":
        parts = (moments.positions, moments.rotations, moments.bases, moments.nominal_s, moments.is_driving)
        return _Asked(tuple(part.tobytes() for part in parts), cloths, moments)


_Pose: TypeAlias = tuple[bytes, bytes, bytes]
"""Where the base stands, a tool's place and its axes, as keys of what is remembered."""


def _pose(base: FloatArray, position: FloatArray, rotation: FloatArray) -> _Pose:
    return base.tobytes(), position.tobytes(), rotation.tobytes()


class Carrier:
    """Finds the joint paths of runs, and remembers them: a plan for a garment that was changed a little repeats most.

    May be shared between threads.
    """

    def __init__(self, machine: RobotPort, collisions: Collisions, torso_m: float, height_m: float) -> None:
        """A carrier for one robot, its torso raised so far, at a table so high (m)."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m = torso_m
        self._height_m = height_m
        self._arms = len(machine.card.arms)
        self._searched = lru_cache(_RUNS_KEPT)(self._search)
        self._free_postures = lru_cache(_PLACES_KEPT)(self._search_postures)
        self._are_apart = lru_cache(_PLACES_KEPT)(self._search_apart)

    def carried(self, moments: Moments, cloths: Cloths) -> Carried | NoPath:
        """The joints of a run; or that the arms cannot be led through it, and at which moments not. Remembered."""
        return self._searched(_Asked.of(moments, cloths))

    def can_hold(self, moments: Moments, first: Iterable[int] = ()) -> bool:
        """Whether the arms can be where they are at a few moments of a run; mostly if not, it cannot be carried.

        `first`: the moments that are looked at before others.
        """
        looks = _LOOKED_AT if moments.is_held.any(axis=1).sum() > 1 else 2
        return self.can_hold_at(moments, [*first, *np.linspace(0, len(moments) - 1, looks).astype(np.int64).tolist()])

    def can_hold_at(self, moments: Moments, which: Iterable[int]) -> bool:
        """Whether the arms can be where they are at some moments, each looked at by itself."""
        arms = [int(arm) for arm in np.flatnonzero(moments.is_held.any(axis=1))]
        rolls = _rolls(moments)[::-1]
        return all(any(self._can_hold(arms, moments, moment, roll) for roll in rolls) for moment in which)

    def _search(self, asked: "_Asked") -> Carried | NoPath:
        over = self._rolled(asked, OVER) if OVER in _rolls(asked.moments) else None
        return over if isinstance(over, Carried) else self._rolled(asked, BESIDE)

    def _rolled(self, asked: "_Asked", roll_rad: float) -> Carried | NoPath:
        """The joints of a run whose hands have rolled so far."""
        found = self._with_lines(asked, Lines(roll_rad, FAR))
        for shares in (UP, NEAR):
            if isinstance(found, Carried) or found.is_hopeless:
                break
            found = self._with_lines(asked, Lines(roll_rad, shares))
        return found

    def adapted(self, moments: Moments, cloths: Cloths, like: Carried) -> Carried | NoPath:
        """The joints of a run that differs a little from one that is known, near to those if they can be."""
        near = self._near(moments, cloths, like)
        return self.carried(moments, cloths) if near is None else near

    def _near(self, moments: Moments, cloths: Cloths, like: Carried) -> Carried | None:
        if _Asked.of(moments, cloths) == _Asked.of(like.moments, like.cloths):
            return like
        are_same_arms = np.array_equal(moments.is_used, like.moments.is_used)
        if not are_same_arms or like.lines.roll_rad not in _rolls(moments):
            return None
        leads = Leads.of(moments, like.lines, self._height_m, self._has_room, cloths)
        joints, guides = self._at_home(len(leads.bases)), like.guides(leads.first, moments, len(leads.bases))
        for lead, is_free in zip(leads.each, self._are_free(leads, cloths), strict=True):
            known = guides[:, lead.arm]
            found = self._machine.arm_path_near(lead.arm, lead.path, self._torso_m, is_free, known)
            if found is None:
                return None
            joints[:, lead.arm] = found
        if len(leads.each) > 1 and not self._collisions.arms_apart(joints).all():
            return None
        return self._half_turned(leads, moments, cloths, joints, like.lines)

    def _with_lines(self, asked: "_Asked", lines: Lines) -> Carried | NoPath:
        """The joints of a run whose hands come and leave along the first of some lines that there is room for.

        Where there are none, the moments are told at which an arm collides whatever it does, or cannot pass the other.
        """
        moments, cloths = asked.moments, asked.cloths
        leads = Leads.of(moments, lines, self._height_m, self._has_room, cloths)
        found = self._arm_paths(leads, cloths)
        if isinstance(found, NoPath):
            return found
        joints = self._at_home(len(leads.bases))
        joints[:, [lead.arm for lead in leads.each]] = found
        return self._half_turned(leads, moments, cloths, joints, lines)

    def _half_turned(self, leads: Leads, moments: Moments, cloths: Cloths, joints: FloatArray, lines: Lines) -> Carried:
        """A run whose hands are turned by half a turn where they are nearer to home then, and nothing touches."""
        half_turns, turned = np.zeros(self._arms), joints.copy()
        for lead, is_free in zip(leads.each, self._are_free(leads, cloths), strict=True):
            away = joints[[0, -1], lead.arm, -1] - self._machine.home(lead.arm)[-1]
            as_is, half = (np.abs(np.remainder(away + turn, 2.0 * np.pi) - np.pi).max() for turn in (np.pi, 0.0))
            if half < as_is - ANGLE_RAD:
                turned[:, lead.arm, -1] += np.pi
                if is_free(np.arange(len(turned)), turned[:, lead.arm], True).all():
                    half_turns[lead.arm] = np.pi
                else:
                    turned[:, lead.arm] = joints[:, lead.arm]
        if len(leads.each) > 1 and half_turns.any() and not self._collisions.arms_apart(turned).all():
            half_turns, turned = np.zeros(self._arms), joints
        return Carried(moments, cloths, leads.bases, turned, leads.first, lines, half_turns)

    def _arm_paths(self, leads: Leads, cloths: Cloths) -> FloatArray | NoPath:
        """The joints of the arms that do something, shape (steps, arms, 7)."""
        are_free = self._are_free(leads, cloths)
        if len(leads.each) > 1:
            left, right = (lead.path for lead in leads.each)
            return self._machine.arm_pair_path(
                (left, right), self._torso_m, self._height_m, (are_free[0], are_free[1]), self._collisions
            )
        (lead,), (is_free,) = leads.each, are_free
        found = self._machine.arm_path(lead.arm, lead.path, self._torso_m, self._height_m, is_free)
        return found if isinstance(found, NoPath) else found[:, None]

    def _are_free(self, leads: Leads, cloths: Cloths) -> list[IsFree]:
        """Of each arm that does something where it collides: with body and table, and an arm that stays at home.

        A hand that holds nothing may not be low over cloth either, but near its grip.
        """
        is_alone = len(leads.each) == 1

        def is_free(lead: Lead, steps: NDArray[np.int64], joints: FloatArray, is_certain: bool) -> BoolArray:
            arm = lead.arm
            answers = self._collisions.arm_free(arm, leads.bases[steps], joints, is_certain=is_certain)
            for cloth, must_clear in zip(cloths, lead.must_clear(steps), strict=True):
                asked = np.flatnonzero(answers & must_clear)
                if cloth is not None and len(asked):
                    bases = leads.bases[steps[asked]]
                    answers[asked] = cloth.arm_clear(arm, bases, joints[asked], is_certain=is_certain)
            if is_alone:
                both = self._at_home(len(joints))
                both[:, arm] = joints
                answers &= self._collisions.arms_apart(both, is_certain=is_certain)
            return answers

        return [partial(is_free, lead) for lead in leads.each]

    def _can_hold(self, arms: list[int], moments: Moments, moment: int, roll_rad: float) -> bool:
        """Whether the arms, rolled so far, can be where they are at a moment, each by itself and all of them together.

        One that does nothing in the whole run is at home.
        """
        held = [arm for arm in arms if moments.is_held[arm, moment]]
        poses: list[_Pose | None] = [None] * self._arms
        for arm in held:
            rotation = moments.rotations[arm, moment] @ rolled(arm, roll_rad)
            poses[arm] = _pose(moments.bases[moment], moments.positions[arm, moment], rotation)
        if len(held) < len(arms):
            return all(len(self._able(arm, pose)) > 0 for arm, pose in enumerate(poses))
        return self._are_apart(*poses)

    def _search_apart(self, left: "_Pose | None", right: "_Pose | None") -> bool:
        """Whether both arms can have their tools in poses at once without touching each other; None: at home."""
        return self._collisions.are_some_apart(self._able(0, left), self._able(1, right))

    def _able(self, arm: int, pose: "_Pose | None") -> FloatArray:
        """How an arm by itself can take a tool pose, or be at home, without touching body or table."""
        return self._machine.home(arm)[None] if pose is None else self._free_postures(arm, *pose)

    def _postures(self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray) -> FloatArray:
        """How an arm by itself can take a tool pose without touching body or table. Remembered."""
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

    def _at_home(self, steps: int) -> FloatArray:
        homes = np.array([self._machine.home(arm) for arm in range(self._arms)])
        return np.broadcast_to(homes, (steps, *homes.shape)).copy()

    def _has_room(
        self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray, cloth: LyingCloth | None
    ) -> bool:
        able = self._postures(arm, base, position, rotation)
        is_clear = cloth is None or cloth.arm_clear(arm, base[None], able, is_certain=True).any()
        return len(able) > 0 and bool(is_clear)


def _rolls(moments: Moments) -> tuple[float, ...]:
    """The rolls with which hands may hold cloth in a run (rad), the best first."""
    starts = (moments.rotations[arm, 0, 2, 0] for arm in np.flatnonzero(moments.is_held.any(axis=1)))
    return (OVER, BESIDE) if all(start < -_STEEP for start in starts) else (BESIDE,)
