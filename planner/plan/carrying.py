"""Joint paths for a run: both arms from before their grips, along the cloth's way, to where they have let go.

Arms are led one after the other, the second round the first; if that fails, in the other order.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.plan.carried import Carried
from planner.plan.leads import BESIDE, FAR, NEAR, OVER, Lead, Leads, Lines
from planner.plan.machine import Collisions, Machine
from planner.plan.moments import Moments
from planner.robot.arm_path import NoPath

_STEEP = 0.6
"""Hands that point down by more than the angle of this sine may have one finger over the other; flatter ones would
push the lower one into the table."""

_LOOKED_AT = 5
"""At so many moments it is looked whether arms can be in their places together before they are led there."""

_TOGETHER = 14
"""So many postures of each arm are looked at when arms are to be in their places together."""

_RUNS_KEPT, _PLACES_KEPT = 512, 8192
"""So many answers are remembered: of runs, some 50 kB each, and of places of a hand, some 2 kB each."""


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

    def can_hold(self, moments: Moments) -> bool:
        """Whether the arms can be where they are at a few moments of a run; mostly if not, it cannot be carried."""
        looks = _LOOKED_AT if moments.is_held.any(axis=1).sum() > 1 else 2
        return self.can_hold_at(moments, np.linspace(0, len(moments) - 1, looks).astype(np.int64).tolist())

    def can_hold_at(self, moments: Moments, which: Iterable[int]) -> bool:
        """Whether the arms can be where they are at some moments, each looked at by itself."""
        arms = [int(arm) for arm in np.flatnonzero(moments.is_held.any(axis=1))]
        return all(self._can_hold(arms, moments, moment) for moment in which)

    def _search(self, asked: "_Asked") -> Carried | None:
        moments = asked.moments
        arms = [int(arm) for arm in np.flatnonzero(moments.is_held.any(axis=1))]
        is_steep = all(moments.rotations[arm, 0, 2, 0] < -_STEEP for arm in arms)
        for roll in (OVER, BESIDE) if is_steep else (BESIDE,):
            for shares in (FAR, NEAR):
                found = self._with_lines(moments, Lines(roll, shares))
                if isinstance(found, Carried):
                    return found
                if len(found.blocked) or found.is_core:
                    break
        return None

    def adapted(self, moments: Moments, like: Carried) -> Carried | None:
        """The joints of a run that differs a little from one that is known; None if they cannot be much the same."""
        if _Asked.of(moments) == _Asked.of(like.moments):
            return like
        if not np.array_equal(moments.is_held.any(axis=1), like.is_used):
            return None
        leads = Leads.of(moments, like.lines, self._height_m, self._has_room)
        guides = like.guides(leads.first, moments, len(leads.bases))
        joints = self._at_home(len(leads.bases))
        for number, lead in enumerate(leads.each):
            others = None if number == 0 and len(leads.each) > 1 else joints
            question = _Question(self._collisions, lead.arm, leads.bases, others)
            near = guides[: lead.last, lead.arm]
            found = self._machine.guided_arm_path(lead.arm, lead.path, self._torso_m, question.is_free, near)
            if found is None:
                return None
            _put(joints, lead, found)
        return Carried(moments, leads.bases, joints, leads.first, like.is_used, like.lines)

    def _with_lines(self, moments: Moments, lines: Lines) -> Carried | NoPath:
        """The joints of a run whose hands come and leave along the first of some lines that there is room for.

        Where there are none, the moments are told at which an arm collides whatever it does, or cannot pass the other.
        """
        leads = Leads.of(moments, lines, self._height_m, self._has_room)
        each, bases = leads.each, leads.bases
        alone = {lead.arm: self._arm_path(lead, bases, None) for lead in each} if len(each) > 1 else {}
        none = [found for found in alone.values() if isinstance(found, NoPath)]
        for order in () if none else permutations(each):
            joints = self._led(order, bases, alone.get(order[0].arm))
            if not isinstance(joints, NoPath):
                is_used = np.asarray(moments.is_held.any(axis=1))
                return Carried(moments, bases, joints, leads.first, is_used, lines)
            none.append(joints if len(each) == 1 else replace(joints, is_core=False))
        return min(none, key=lambda one: len(one.blocked))

    def _arm_path(self, lead: Lead, bases: FloatArray, others: FloatArray | None) -> FloatArray | NoPath:
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
        self, order: tuple[Lead, ...], bases: FloatArray, first: FloatArray | NoPath | None
    ) -> FloatArray | NoPath:
        """All arms' joints, one arm led after the other, the first as it would go alone where that is known."""
        joints = self._at_home(len(bases))
        for lead in order:
            found = first if lead is order[0] and first is not None else self._arm_path(lead, bases, joints)
            if isinstance(found, NoPath):
                return found
            _put(joints, lead, found)
        return joints

    def _at_home(self, steps: int) -> FloatArray:
        homes = np.array([self._machine.home(arm) for arm in range(len(self._machine.card.arms))])
        return np.broadcast_to(homes, (steps, *homes.shape)).copy()

    def _has_room(self, arm: int, base: FloatArray, position: FloatArray, rotation: FloatArray) -> bool:
        return len(self._postures(arm, base, position, rotation)) > 0


def _put(joints: FloatArray, lead: Lead, found: FloatArray) -> None:
    """An arm goes its way, and waits where it withdrew to."""
    joints[: lead.last, lead.arm] = found
    joints[lead.last :, lead.arm] = found[-1]


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
