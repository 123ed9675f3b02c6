"""Why there is no plan: for each fold that was never done, what stood in its way, where, and by how much."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from planner.geometry.pose import FloatArray, Point3
from planner.geometry.shortfall import Shortfall
from planner.primitives.obstacle import Attempt, Code, Obstacle
from planner.primitives.work import BACK_OFF_STEP_M, BACK_OFFS_PER_M, Work


@dataclass(frozen=True, slots=True)
class Reason:
    """One reason, about one fold or about the whole.

    Attributes:
        fold: the fold's index, or None.
        code: which constraint.
        message: a sentence with the numbers.
        cause: for what is out of reach: too far, too near, which joint's limit, comfort only.
        joint: the joint that limits, where one does.
        point: where, a tool point in the table frame (m).
        short_by_m: by how much (m).
        station: the station from which it came closest.
    """

    fold: int | None
    code: Code
    message: str
    cause: str | None = None
    joint: str | None = None
    point: Point3 | None = None
    short_by_m: float | None = None
    station: str | None = None

    def to_dict(self) -> dict[str, Any]:
        """The reason as JSON."""
        return {
            "fold": self.fold,
            "code": self.code.value,
            "message": self.message,
            "cause": self.cause,
            "joint": self.joint,
            "point": None if self.point is None else list(self.point),
            "short_by_m": self.short_by_m,
            "station": self.station,
        }


def reasons(work: Work, achieved: int, furthest: int) -> tuple[Reason, ...]:
    """The reasons once it is proven that there is no plan.

    Args:
        work: the problem, with the obstacles met on the way.
        achieved: the folds that some state reached had done, as a bit mask.
        furthest: the folds done in a state that had most of them done.

    Returns:
        What blocks first, what merely waits for it last.
    """
    everything = (1 << len(work.sequence.folds)) - 1
    missing = everything & ~(achieved if achieved != everything else furthest)
    folds = [f.index for f in work.sequence.folds if missing >> f.index & 1]
    blocked = [reason for fold in folds for reason in _blocks(work, fold)]
    waiting = [reason for fold in folds for reason in _waits(work, fold, missing)]
    return (*blocked, *waiting) or tuple(_excluded(work, fold, furthest) for fold in folds)


def _blocks(work: Work, fold: int) -> Iterator[Reason]:
    for obstacle in work.obstacles.of(fold):
        if obstacle.attempt is None:
            yield Reason(fold, obstacle.code, obstacle.message)
        else:
            yield _out_of_reach(work, fold, obstacle, obstacle.attempt)


def _waits(work: Work, fold: int, missing: int) -> Iterator[Reason]:
    before = [a for a, b in work.sequence.dag.edges if b == fold and missing >> a & 1]
    if before and not work.obstacles.of(fold):
        names = ", ".join(work.sequence.folds[a].label for a in before)
        label = work.sequence.folds[fold].label
        yield Reason(fold, Code.WAITS_FOR_FOLD, f"{label}: waits for {names}, which cannot be done")


def _excluded(work: Work, fold: int, furthest: int) -> Reason:
    """A fold that can be done, but not once the others are."""
    done = ", ".join(f.label for f in work.sequence.folds if furthest >> f.index & 1)
    label = work.sequence.folds[fold].label
    return Reason(fold, Code.WAITS_FOR_FOLD, f"{label}: can be done, but not once these are: {done}")


@dataclass(frozen=True, slots=True)
class _Miss:
    """What one point of an attempt lacks from one back-off."""

    back_off: int
    grip: int
    point: Point3
    shortfall: Shortfall


def _out_of_reach(work: Work, fold: int, obstacle: Obstacle, attempt: Attempt) -> Reason:
    """What an attempt lacked where it came closest."""
    label = work.sequence.folds[fold].label
    station = work.scene.stations[attempt.station][0]
    miss = _closest(work, attempt)
    if miss is None:
        message = (
            f"{label}: from {station}, where it came closest, the path's ends and apex are in reach, but no arm can "
            "follow all of it in one orientation"
        )
        return Reason(fold, obstacle.code, message, cause="joint_limit", station=station)
    arm = work.reach.arm_names[attempt.arms[miss.grip]]
    x, y, z = miss.point
    message = (
        f"{label}: the {arm} grip at ({x:.2f}, {y:.2f}) m, {z:.2f} m over the table, is "
        f"{miss.shortfall.short_by_m:.2f} m out of {_in_words(miss.shortfall)}; "
        f"closest: {station}, backed off {miss.back_off / BACK_OFFS_PER_M:.2f} m"
    )
    found = miss.shortfall
    return Reason(fold, obstacle.code, message, found.cause, found.joint, miss.point, found.short_by_m, station)


def _in_words(shortfall: Shortfall) -> str:
    if shortfall.cause == "comfort_only":
        return "comfort (it can just be reached)"
    why = {"too_far": "too far", "too_near": "too near", "joint_limit": "joint limit"}[shortfall.cause]
    return f"reach ({why}, {shortfall.joint} limit)" if shortfall.joint else f"reach ({why})"


def _closest(work: Work, attempt: Attempt) -> _Miss | None:
    """Of the path's ends and apex the one furthest out of reach, each from the back-off that suits it best.

    The base may drive while the hands follow the path, so each point has its own.
    """
    misses = []
    for grip, tools in enumerate(attempt.tools):
        for number in sorted({0, len(tools) // 2, len(tools) - 1}):
            miss = _least(work, attempt, grip, tools[number])
            if miss is not None:
                misses.append(miss)
    return max(misses, key=lambda m: m.shortfall.short_by_m, default=None)


def _least(work: Work, attempt: Attempt, grip: int, tool: FloatArray) -> _Miss | None:
    """What one tool point lacks from the best back-off: every fourth is tried, then those beside the best."""
    last, stride = work.back_offs - 1, 4
    candidates = range(0, last + 1, stride)
    tried: dict[int, _Miss | None] = {}
    while stride >= 1:
        for back_off in candidates:
            if 0 <= back_off <= last and back_off not in tried:
                tried[back_off] = _miss(work, attempt, grip, tool, back_off)
                if tried[back_off] is None:
                    return None
        best = min(tried, key=lambda b: _size(tried[b]))
        stride //= 2
        candidates = range(best - stride, best + stride + 1, max(stride, 1))
    return tried[best]


def _size(miss: _Miss | None) -> float:
    return 0.0 if miss is None else miss.shortfall.short_by_m


def _miss(work: Work, attempt: Attempt, grip: int, tool: FloatArray, back_off: int) -> _Miss | None:
    backed_off = np.array([back_off * BACK_OFF_STEP_M, 0.0, 0.0])
    point = work.in_base(attempt.station, tool[None])[0] + backed_off
    found = work.reach.shortfall(attempt.arms[grip], point, attempt.approaches[grip])
    place = (float(tool[0]), float(tool[1]), float(tool[2]))
    return None if found is None else _Miss(back_off, grip, place, found)
