"""Joint paths for a run: both arms from before their grips, along the cloth's way, to where they have let go.

A hand comes to its grip along its approach axis, fingers first, and leaves it backwards and upwards; these lines are
part of the path, so that the joints with which the cloth is taken are ones with which it can be reached and left.
Arms are led one after the other, the second round the first; if that fails, in the other order.
"""

from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise, permutations, product

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.plan.machine import Collisions, Machine
from planner.plan.moments import Moments, about_x
from planner.robot.arm_path import NoPath, ToolPath

APPROACH_M, RETREAT_M = 0.10, 0.12
"""How far a hand comes straight to a grip, and goes straight away from it, where that is in reach (m)."""

CLEAR_M = 0.12
"""How high over the table a hand then is, where that is in reach: from there it travels (m)."""

_STEP_M = 0.01
"""How far hands go on these ways from one step to the next (m)."""

Shares = tuple[tuple[float, float], ...]

_NEAR: Shares = ((0.2, 0.0), (0.0, 0.0))
_FAR: Shares = ((1.0, 1.0), (0.5, 1.0), (1.0, 0.5), (0.5, 0.5), (0.2, 0.5), (0.0, 1.0), (1.0, 0.0), (0.5, 0.0), *_NEAR)
"""How much of the straight line and of the rise is tried: what must do, and what had better."""

_STEEP = 0.6
"""Hands that point down by more than the angle of this sine may have one finger over the other; flatter ones would
push the lower one into the table."""

_LOOKED_AT = 5
"""At so many moments it is looked whether arms can be in their places together before they are led there."""

_TOGETHER = 14
"""So many postures of each arm are looked at when arms are to be in their places together."""

_RUNS_KEPT, _PLACES_KEPT = 512, 8192
"""So many answers are remembered: of runs, some 50 kB each, and of places of a hand, some 2 kB each."""

_OVER, _BESIDE = 0.5 * np.pi, 0.0
"""The roll of a hand with one finger over the other, and side by side (rad)."""


@dataclass(frozen=True, slots=True, eq=False)
class Carried:
    """The joints of a run.

    Attributes:
        moments: the moments while cloth is held.
        bases: where the base stands at each step: x (m), y (m), yaw (rad), table frame, shape (steps, 3).
        joints: every arm's joints (rad), shape (steps, arms, 7). Arms that do nothing are at home, those that have let
            go wait where they withdrew to.
        first: the step at which the grips are reached: the first of the moments.
        is_used: which arms do something, shape (arms,).
    """

    moments: Moments
    bases: FloatArray
    joints: FloatArray
    first: int
    is_used: BoolArray

    @property
    def last(self) -> int:
        """The step of the last of the moments, at which the hands let go."""
        return self.first + len(self.moments) - 1


@dataclass(frozen=True, slots=True, eq=False)
class _Lead:
    """One arm's part in a run: its tool path, and the step at which that begins."""

    arm: int
    path: ToolPath

    @property
    def last(self) -> int:
        return len(self.path.positions)


@dataclass(frozen=True, slots=True)
class _Asked:
    """A run, known by all that its joints depend on."""

    key: tuple[bytes, ...]
    moments: Moments = field(compare=False)

    @staticmethod
    def of(moments: Moments) -> "_Asked":
        parts = (moments.positions, moments.rotations, moments.bases, moments.nominal_s, moments.is_driving)
        return _Asked(tuple(part.tobytes() for part in parts), moments)


class Carrier:
    """Finds the joint paths of runs, and remembers them: a plan for a garment that was changed a little repeats most.

    May be shared between threads.
    """

    def __init__(self, machine: Machine, collisions: Collisions, torso_m: float, height_m: float) -> None:
        """A carrier for one robot, its torso raised so far, at a table so high (m)."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m = torso_m
        self._height_m = height_m
        self._searched = lru_cache(_RUNS_KEPT)(self._search)
        self._free_postures = lru_cache(_PLACES_KEPT)(self._search_postures)

    def carried(self, moments: Moments) -> Carried | None:
        """The joints of a run; None if the arms cannot be led through it. Remembered."""
        return self._searched(_Asked.of(moments))

    def _search(self, asked: "_Asked") -> Carried | None:
        moments = asked.moments
        is_used = moments.is_held.any(axis=1)
        arms = [int(arm) for arm in np.flatnonzero(is_used)]
        places = np.linspace(0, len(moments) - 1, 2 if len(arms) < 2 else _LOOKED_AT)
        if not all(self._can_hold(arms, moments, int(moment)) for moment in places):
            return None
        is_steep = all(moments.rotations[arm, 0, 2, 0] < -_STEEP for arm in arms)
        for roll in (_OVER, _BESIDE) if is_steep else (_BESIDE,):
            for shares in (_FAR, _NEAR):
                found = self._with_lines(arms, moments, roll, shares)
                if isinstance(found, Carried):
                    return found
                if len(found.blocked) or found.is_core:
                    break
        return None

    def _with_lines(self, arms: list[int], moments: Moments, roll_rad: float, shares: Shares) -> Carried | NoPath:
        """The joints of a run whose hands come and leave along the first of some lines that there is room for.

        Where there are none, the moments are told at which an arm collides whatever it does, or cannot pass the other.
        """
        ways = [self._way(arm, moments, roll_rad, shares) for arm in arms]
        before = max(len(way.coming) for way in ways) - 1
        after = max(len(way.leaving) for way in ways) - 1
        start, end = moments.bases[:1].repeat(before, 0), moments.bases[-1:].repeat(after, 0)
        bases = np.concatenate([start, moments.bases, end])
        leads = [way.lead(before, after) for way in ways]
        alone = {lead.arm: self._arm_path(lead, bases, None) for lead in leads} if len(leads) > 1 else {}
        none = [found for found in alone.values() if isinstance(found, NoPath)]
        for order in () if none else permutations(leads):
            joints = self._led(order, bases, alone.get(order[0].arm))
            if not isinstance(joints, NoPath):
                return Carried(moments, bases, joints, before, np.asarray(moments.is_held.any(axis=1)))
            none.append(joints if len(leads) == 1 else replace(joints, is_core=False))
        return min(none, key=lambda one: len(one.blocked))

    def _arm_path(self, lead: _Lead, bases: FloatArray, others: FloatArray | None) -> FloatArray | NoPath:
        """One arm's joints, the others as they are at each step; None: out of the way."""
        question = _Question(self._collisions, lead.arm, bases, others)
        return self._machine.arm_path(lead.arm, lead.path, self._torso_m, self._height_m, question.is_free)

    def _can_hold(self, arms: list[int], moments: Moments, moment: int) -> bool:
        """Whether the arms can be where they are at a moment, each by itself and all of them together."""
        held = [arm for arm in arms if moments.is_held[arm, moment]]
        found = [
            self._postures(arm, moments.bases[moment], moments.positions[arm, moment], moments.rotations[arm, moment])
            for arm in held
        ]
        if not all(len(postures) for postures in found):
            return False
        if len(held) < 2:
            return True
        some = [postures[:: max(1, len(postures) // _TOGETHER)] for postures in found]
        pairs = np.array([*product(*some)])
        return bool(self._collisions.arms_apart(pairs, is_certain=True).any())

    def _postures(self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray) -> FloatArray:
        """How an arm by itself can take a tool pose without touching body or table. Remembered."""
        return self._free_postures(arm, base.tobytes(), position.tobytes(), rotation.tobytes())

    def _search_postures(self, arm: int, base: bytes, position: bytes, rotation: bytes) -> FloatArray:
        stand, place, axes = (np.frombuffer(part) for part in (base, position, rotation))
        return self._machine.free_postures(
            arm,
            place,
            axes.reshape(3, 3),
            self._torso_m,
            lambda joints: self._collisions.arm_free(arm, stand[None], joints, is_certain=True),
        )

    def _led(
        self, order: tuple[_Lead, ...], bases: FloatArray, first: FloatArray | NoPath | None
    ) -> FloatArray | NoPath:
        """All arms' joints, one arm led after the other, the first as it would go alone where that is known."""
        homes = np.array([self._machine.home(arm) for arm in range(len(self._machine.card.arms))])
        joints = np.broadcast_to(homes, (len(bases), *homes.shape)).copy()
        for lead in order:
            found = first if lead is order[0] and first is not None else self._arm_path(lead, bases, joints)
            if isinstance(found, NoPath):
                return found
            joints[: lead.last, lead.arm] = found
            joints[lead.last :, lead.arm] = found[-1]
        return joints

    def _way(self, arm: int, moments: Moments, roll_rad: float, shares: Shares) -> "_Way":
        held = np.flatnonzero(moments.is_held[arm])
        positions = moments.positions[arm, held]
        rotations = moments.rotations[arm, held] @ about_x(np.array([roll_rad]))[0]
        upwards = np.array([0.0, 0.0, 1.0])
        coming, leaving = -rotations[0, :, 0], -rotations[-1, :, 0] + upwards
        leaving *= RETREAT_M / np.linalg.norm(leaving)
        approach = self._away(arm, moments.bases[held[0]], positions[0], rotations[0], APPROACH_M * coming, shares)
        retreat = self._away(arm, moments.bases[held[-1]], positions[-1], rotations[-1], leaving, shares)
        spans = np.where(moments.is_driving, moments.nominal_s, np.inf)[held[1:]]
        return _Way(arm, positions, rotations, spans, approach, retreat)

    def _away(
        self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray, line: FloatArray, shares: Shares
    ) -> FloatArray:
        """The corners of a way from a place along a line and up, as far as there is room, shape (3, 3)."""
        lines = position + np.array(shares)[:, :1] * line
        rises = np.maximum(self._height_m + CLEAR_M - lines[:, 2], 0.0) * np.array(shares)[:, 1]
        ends = lines + rises[:, None] * np.array([0.0, 0.0, 1.0])
        for corner, tip in zip(lines, ends, strict=True):
            if len(self._postures(arm, base, tip, rotation)):
                return np.array([position, corner, tip])
        return np.array([position, position, position])


@dataclass(frozen=True, slots=True, eq=False)
class _Way:
    """Where an arm's tool goes: to its grip, along the cloth's way, and from where it lets go."""

    arm: int
    positions: FloatArray
    rotations: FloatArray
    spans_s: FloatArray
    approach: FloatArray
    retreat: FloatArray

    @property
    def coming(self) -> FloatArray:
        return _stepped(self.approach)

    @property
    def leaving(self) -> FloatArray:
        return _stepped(self.retreat)

    def lead(self, before: int, after: int) -> _Lead:
        """The tool's path, coming in so many steps and leaving in so many."""
        coming = _resampled(self.coming, before)[:0:-1]
        leaving = _resampled(self.leaving, after)[1:]
        first, last = self.rotations[:1], self.rotations[-1:]
        path = ToolPath(
            np.concatenate([coming, self.positions, leaving]),
            np.concatenate([first.repeat(before, 0), self.rotations, last.repeat(after, 0)]),
            np.concatenate([np.full(before, np.inf), self.spans_s, np.full(after, np.inf)]),
            (before, before + len(self.positions)),
        )
        return _Lead(self.arm, path)


def _stepped(corners: FloatArray) -> FloatArray:
    """The points of a polyline, no more than a step apart, shape (n, 3), m; at least two."""
    parts = [corners[:1]]
    for start, end in pairwise(corners):
        count = int(np.ceil(np.linalg.norm(end - start) / _STEP_M))
        parts.append(start + np.linspace(0.0, 1.0, count + 1)[1:, None] * (end - start))
    points = np.concatenate(parts)
    return points if len(points) > 1 else points.repeat(2, 0)


def _resampled(points: FloatArray, steps: int) -> FloatArray:
    """A polyline's points as so many steps, shape (steps + 1, 3); no fewer than it has."""
    numbers = np.linspace(0.0, len(points) - 1, steps + 1)
    return np.column_stack([np.interp(numbers, np.arange(len(points)), column) for column in points.T])


class _Question:
    """Whether one arm collides at some steps of a run, the other arms where they are then."""

    def __init__(self, collisions: Collisions, arm: int, bases: FloatArray, others: FloatArray | None) -> None:
        self._collisions = collisions
        self._arm = arm
        self._bases = bases
        self._others = others

    def is_free(self, steps: NDArray[np.int64], joints: FloatArray, is_certain: bool) -> BoolArray:
        """For joints of the arm at some steps, shape (m,) and (m, 7)."""
        answers = np.ones(len(steps), dtype=bool)
        if self._others is not None:
            both = self._others[steps].copy()
            both[:, self._arm] = joints
            answers = self._collisions.arms_apart(both, is_certain=is_certain)
        asked = np.flatnonzero(answers)
        answers[asked] = self._collisions.arm_free(
            self._arm, self._bases[steps[asked]], joints[asked], is_certain=is_certain
        )
        return answers
