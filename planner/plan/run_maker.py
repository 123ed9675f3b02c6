"""Makes runs of primitives real: looks at the ways to do what they do, and leads the arms along those that may do."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice, product

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.plan.carried import Carried
from planner.plan.carrying import Carrier
from planner.plan.cue import Cue
from planner.plan.machine import Collisions, Machine
from planner.plan.moments import Moments, moments_of
from planner.plan.pacing import needed_s, paced_s
from planner.plan.real_run import RealRun, is_carrying
from planner.plan.snags import Snags
from planner.plan.transits import Transits
from planner.primitives.obstacle import Snag
from planner.primitives.phase import Phase
from planner.primitives.primitive import Step
from planner.primitives.work import Work
from planner.robot.tool_path import NoPath

MARGIN_M = 0.001
"""How far apart everything keeps that must not touch, at the moments that are looked at (m)."""

_WAYS_MAX = 40
"""So many ways to do what a run does are looked at."""

_TRIED_ALONE_MAX, _TRIED_TOGETHER_MAX = 8, 2
"""So many of those that may do are tried with one arm, and with several: to lead these takes several times as long."""

_LATE_MAX = 2
"""So many runs that take longer than their steps seem to are made for a plan that is to be the quickest."""

_VARIANTS_MAX = 6
"""So many choices of each step are combined with those of the others in its run."""

_HALF = 0.5
"""The share of a reach's time in which hands must be able to come from home, and to go home after the run before."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """Steps of which it is not known yet whether the arms can follow them.

    Attributes:
        steps: the primitives, none but the last of which lets go.
        carrying: the phases in which cloth is held, each with its primitive's number.
        moments: the same, moment by moment.
    """

    steps: tuple[Step, ...]
    carrying: tuple[tuple[int, Phase], ...]
    moments: Moments

    @property
    def kind(self) -> tuple[object, ...]:
        """What it has in common with others that do the same with the same arms from the same station."""
        return tuple(step.task for step in self.steps)

    @property
    def is_together(self) -> bool:
        """Whether more than one arm holds cloth."""
        return bool(self.moments.is_held.any(axis=1).sum() > 1)


class _Stuck:
    """Where runs got stuck: others that do the same mostly get stuck nearby."""

    def __init__(self) -> None:
        self._shares: dict[tuple[object, ...], float] = {}

    def note(self, candidate: "Candidate", found: NoPath) -> None:
        """A candidate turned out to have no way: remember the middle of where it is blocked."""
        if len(found.blocked):
            middle = found.blocked[len(found.blocked) // 2]
            self._shares[candidate.kind] = float(middle) / (len(candidate.moments) - 1)

    def suspects(self, candidate: "Candidate") -> list[int]:
        """The moment of a candidate at which the last one of its kind was blocked, if any was."""
        share = self._shares.get(candidate.kind)
        return [] if share is None else [round(share * (len(candidate.moments) - 1))]


class RunMaker:
    """Makes runs of one planning problem real.

    Attributes:
        transits: the ways of free hands.
        collisions: what is in whose way.
    """

    def __init__(self, work: Work, machine: Machine) -> None:
        """Nothing has been made real yet."""
        scene = work.scene
        carrier, collisions = _carrier(machine, scene.table, scene.torso_m)
        self._work = work
        self._speeds = np.array([arm.speeds_rad_s for arm in machine.card.arms])
        self._carrier = carrier
        self._stuck = _Stuck()
        self._snags = Snags(machine, collisions, scene.torso_m, scene.table.height_m)
        self.transits = Transits(machine, collisions)
        self.collisions = collisions

    def real(self, steps: Sequence[Step], ways: int = _WAYS_MAX, late_max: int = _LATE_MAX) -> RealRun | None:
        """The run that a few primitives make, none but the last of which lets go; None if the arms cannot follow.

        Looked at are so many ways to do what they do. Where it takes longer than they seem to, the quickest of the
        first `late_max`.
        """
        return self.first_real(islice(_ways(steps), ways), late_max=late_max)

    def first_real(self, choices: Iterable[tuple[Step, ...]], patience: int = 1, late_max: int = 1) -> RealRun | None:
        """The first that is real of some choices of steps; it is given up when a few, with patience more, are not.

        If it takes longer than its steps seem to, the quickest of the first `late_max`.
        """
        late: list[RealRun] = []
        for number, candidate in enumerate(self.candidates(choices), start=1):
            run = self.made(candidate)
            most = _TRIED_TOGETHER_MAX if candidate.is_together else _TRIED_ALONE_MAX
            if run is not None and not run.is_late:
                return run
            late += [] if run is None else [run]
            if len(late) == late_max or number - len(late) >= patience * most:
                break
        return min(late, key=lambda run: sum(run.durations_s()), default=None)

    def candidates(self, choices: Iterable[tuple[Step, ...]]) -> "Iterator[Candidate]":
        """The choices of steps that may be real.

        That is looked at, much quicker than to lead the arms: whether they can be where they are at a few moments,
        where they begin and end first, and then where the last of their kind got stuck.
        """
        for steps in choices:
            if self.can_begin_and_end(steps):
                candidate = self.candidate(steps)
                if self._carrier.can_hold(candidate.moments, self._stuck.suspects(candidate)):
                    yield candidate

    def can_begin_and_end(self, steps: Sequence[Step]) -> bool:
        """Whether the arms can be where they are when each of some steps takes hold, and when its motions end."""
        moments = self._moments([phase for step in steps for phase in step.extremes()])
        ends = np.flatnonzero(np.diff(moments.phases, append=moments.phases[-1] + 1))
        return self._carrier.can_hold_at(moments, [0, *ends[::-1].tolist()])

    def candidate(self, steps: tuple[Step, ...]) -> "Candidate":
        """Steps as they are to be performed, moment by moment, whether they may be real or not."""
        phases = [(n, phase) for n, step in enumerate(steps) for phase in step.phases() if phase.duration_s > 0.0]
        carrying = tuple((n, phase) for n, phase in phases if is_carrying(phase))
        return Candidate(steps, carrying, self._moments([phase for _, phase in carrying]))

    def made(self, candidate: "Candidate") -> RealRun | None:
        """A candidate made real; None without a way."""
        return self._run(candidate, self._carrier.carried(candidate.moments))

    def made_like(self, candidate: "Candidate", like: RealRun) -> RealRun | None:
        """A candidate made real, its joints near to those of another run if they can be; None without a way."""
        return self._run(candidate, self._carrier.adapted(candidate.moments, like.carried))

    def _run(self, candidate: "Candidate", carried: Carried | NoPath) -> RealRun | None:
        if isinstance(carried, NoPath):
            self._stuck.note(candidate, carried)
            return None
        late = self._late(carried)
        if late is None:
            return None
        carrying, moments = candidate.carrying, candidate.moments
        least = needed_s(carried.joints, self._speeds)
        first, last = carried.first, carried.last
        times = np.append(0.0, np.cumsum(_paced(carrying, moments, least[first:last])))
        cues = tuple(_cues(carrying, moments, times))
        return RealRun(candidate.steps, carried, cues, times, least[:first], least[last:], late)

    def _moments(self, phases: Sequence[Phase]) -> Moments:
        return moments_of(phases, self._work.scene.table.height_m)

    def snag(self, steps: Sequence[Step]) -> Snag | None:
        """What is in the arms' way in a run that cannot be made real; None where they are only cut off."""
        phases = [phase for step in steps for phase in step.phases() if phase.duration_s > 0.0 and is_carrying(phase)]
        return self._snags.of(self._moments(phases))

    def _late(self, carried: Carried) -> tuple[float, float] | None:
        """How much the ways from home and back home exceed their shares of a reach's time (s); None without a way."""
        home, joints, bases = self.transits.home, carried.joints, carried.bases
        late = []
        ends = ((bases[0], joints[0], joints[: carried.first + 1]), (bases[-1], joints[-1], joints[carried.last :]))
        for base, away, line in ends:
            way = self.transits.way(Pose2.of(base), home, away)
            if way is None:
                return None
            needed = float(self.transits.needed_s(way).sum() + self.transits.needed_s(line).sum())
            late.append(max(0.0, needed - _HALF * self._work.scene.arm_motion_s))
        return late[0], late[1]


def _ways(steps: Sequence[Step]) -> Iterator[tuple[Step, ...]]:
    """Steps, then all combinations of their variants, which take time to find."""
    yield tuple(steps)
    yield from islice(product(*(islice(step.variants(), _VARIANTS_MAX) for step in steps)), 1, None)


@lru_cache(maxsize=4)
def _carrier(machine: Machine, table: Table, torso_m: float) -> tuple[Carrier, Collisions]:
    """What finds joint paths at a table, and what is in the way there: kept from plan to plan."""
    collisions = machine.collisions(table, torso_m, margin_m=MARGIN_M)
    return Carrier(machine, collisions, torso_m, table.height_m), collisions


def _paced(carrying: Sequence[tuple[int, Phase]], moments: Moments, least_s: FloatArray) -> FloatArray:
    """How long each step from moment to moment takes (s), shape (moments - 1,).

    The phases of one arm motion share its time; a drive is no quicker than it is, even in parts.
    """
    phases, nominal = moments.phases[1:], moments.nominal_s[1:]
    found = np.maximum(least_s, nominal)
    motions = [(primitive, phase.motion) for primitive, phase in carrying]
    for motion in dict.fromkeys(motions):
        if motion[1] is not None:
            rows = np.flatnonzero(np.isin(phases, [i for i, other in enumerate(motions) if other == motion]))
            found[rows] = paced_s(nominal[rows], least_s[rows])
    return found


def _cues(carrying: Sequence[tuple[int, Phase]], moments: Moments, times: FloatArray) -> Iterator[Cue]:
    start = 0.0
    for number, (primitive, phase) in enumerate(carrying):
        rows = np.flatnonzero((moments.phases == number) & (times > start))
        if len(rows) == 0:
            # In a motion slower than it should be, a phase through which the hands rest takes no time at all.
            yield Cue.even(primitive, phase, 0.0)
            continue
        yield Cue(primitive, phase, np.append(start, times[rows]) - start, np.append(0.0, moments.fractions[rows]))
        start = float(times[rows[-1]])
