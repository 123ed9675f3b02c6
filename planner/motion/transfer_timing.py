"""Time a transfer: the time of every moment, and the rests in which fingers open.

Fingers close and open while everything rests, and cloth is released only once it lies. A rest is part of the arm motion
before it, which becomes that much quicker; if there is none before it, as in a drag, the rest is part of the reach.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.motion.moments import Moments
from planner.motion.pacing import paced_s
from planner.motion.timed_phase import TimedPhase
from planner.task.phase import Phase

Carrying = Sequence[tuple[int, Phase]]
"""The phases of a transfer in which cloth is held, each with its primitive's number."""


@dataclass(frozen=True, slots=True, eq=False)
class TransferTiming:
    """The timing of a transfer.

    Attributes:
        times_s: times since the first grip, rising (s), shape (n,).
        moments: the moment at each time, shape (n,); a moment after which a hand lets go appears twice, with a rest in
            between.
        timed_phases: the timed phases; their primitives are counted within the transfer.
        borrowed_s: the rests that are part of the reach before (s).
    """

    times_s: FloatArray
    moments: NDArray[np.int64]
    timed_phases: tuple[TimedPhase, ...]
    borrowed_s: float

    @staticmethod
    def of(carrying: Carrying, moments: Moments, least_s: FloatArray, rest_s: float) -> "TransferTiming":
        """Return the quickest even timing.

        Args:
            carrying: the phases.
            moments: their moments.
            least_s: the least time from each moment to the next (s), shape (moments - 1,).
            rest_s: the time that fingers take to open (s).
        """
        is_last = np.asarray(moments.is_last_held.any(axis=0))
        rests, borrowed_s = _rests(carrying, moments, is_last, rest_s)
        steps = np.append(0.0, _paced(carrying, moments, least_s, rests))
        rows = np.repeat(np.arange(len(moments)), 1 + is_last)
        is_rest = np.append(False, rows[1:] == rows[:-1])
        times = np.cumsum(np.where(is_rest, rest_s, steps[rows]))
        return TransferTiming(times, rows, tuple(_cues(carrying, moments, rows, times)), borrowed_s)

    def first_s(self, moment: int) -> float:
        """Return when a moment is reached (s)."""
        return float(self.times_s[np.searchsorted(self.moments, moment)])


def _rests(
    carrying: Carrying, moments: Moments, is_last: BoolArray, rest_s: float
) -> tuple[dict[tuple[int, int | None], float], float]:
    """Return the rests within each arm motion (s), and the rests before which there is no arm motion (s)."""
    rests: dict[tuple[int, int | None], float] = {}
    borrowed_s = 0.0
    for number in moments.phases[is_last].tolist():
        of_primitive = [motion for motion in _motions(carrying[: number + 1]) if motion[0] == carrying[number][0]]
        if of_primitive:
            rests[of_primitive[-1]] = rests.get(of_primitive[-1], 0.0) + rest_s
        else:
            borrowed_s += rest_s
    return rests, borrowed_s


def _motions(carrying: Carrying) -> list[tuple[int, int | None]]:
    """Return the arm motions of some phases, each with its primitive's number."""
    return [*dict.fromkeys((primitive, phase.motion) for primitive, phase in carrying if phase.motion is not None)]


def _paced(
    carrying: Carrying, moments: Moments, least_s: FloatArray, rests: dict[tuple[int, int | None], float]
) -> FloatArray:
    """Return the duration of each step from moment to moment (s), shape (moments - 1,).

    The phases of one arm motion share its time, less its rests; a drive keeps its nominal speed, even in parts.
    """
    phases, nominal = moments.phases[1:], moments.nominal_s[1:]
    found = np.maximum(least_s, nominal)
    for motion in _motions(carrying):
        of_motion = [i for i, (primitive, phase) in enumerate(carrying) if (primitive, phase.motion) == motion]
        rows = np.flatnonzero(np.isin(phases, of_motion))
        found[rows] = paced_s(nominal[rows], least_s[rows], rests.get(motion, 0.0))
    return found


def _cues(carrying: Carrying, moments: Moments, rows: NDArray[np.int64], times: FloatArray) -> Iterator[TimedPhase]:
    start, phases, fractions = 0.0, moments.phases[rows], moments.fractions[rows]
    for number, (primitive, phase) in enumerate(carrying):
        own = np.flatnonzero((phases == number) & (times > start))
        if len(own) == 0:
            # In a motion slower than its estimate, a phase through which the hands rest takes no time at all.
            yield TimedPhase.even(primitive, phase, 0.0)
            continue
        yield TimedPhase(primitive, phase, np.append(start, times[own]) - start, np.append(0.0, fractions[own]))
        start = float(times[own[-1]])
