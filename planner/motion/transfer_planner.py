"""Makes runs of primitives real: looks at the ways to do what they do, and leads the arms along those that may do."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice, product

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.motion.blocking_contacts import BlockingContacts
from planner.motion.carried import Carried
from planner.motion.carrying import Carrier
from planner.motion.joint_track import CLOSED_M, OPEN_M
from planner.motion.leads import Cloths
from planner.motion.lying_cloth import LyingCloth, LyingCloths
from planner.motion.moments import Moments, moments_of
from planner.motion.pacing import needed_s
from planner.motion.robot_port import Collisions, RobotPort
from planner.motion.transfer import ReachTime, Transfer, is_carrying
from planner.motion.transfer_timing import TransferTiming
from planner.motion.transit_paths import TransitPaths
from planner.motion.tries import QUICK, Tries
from planner.primitives.context import Context
from planner.primitives.obstacle import BlockingContact
from planner.primitives.primitive import Step
from planner.robot.tool_path import NoPath
from planner.task.phase import Phase

MARGIN_M = 0.001
"""How far apart everything keeps that must not touch, at the moments that are looked at (m)."""

_HALF = 0.5
"""The share of a reach's time, fingers closed, in which hands must be able to go home after the run before."""


Lines = tuple[FloatArray | None, FloatArray | None]
"""The straight ways from grips and to grips between which a way leads, each of shape (n, arms, 7); None at home."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """Steps of which it is not known yet whether the arms can follow them.

    Attributes:
        steps: the primitives, none but the last of which lets go.
        carrying: the phases in which cloth is held, each with its primitive's number.
        moments: the same, moment by moment.
        cloths: the cloth that lies before and after.
    """

    steps: tuple[Step, ...]
    carrying: tuple[tuple[int, Phase], ...]
    moments: Moments
    cloths: Cloths

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


class TransferPlanner:
    """Makes runs of one planning problem real.

    Attributes:
        transits: the ways of free hands.
        dwell_s: how long hands rest while fingers close, and while they open (s).
        collisions: what is in whose way.
        glances: how often it was looked whether arms can be where steps begin and end, remembered or not.
        tries: how often arms were led, remembered or not.
    """

    def __init__(self, context: Context, machine: RobotPort) -> None:
        """Nothing has been made real yet."""
        scene = context.scene
        carrier, collisions = _carrier(machine, scene.table, scene.torso_m)
        self._context = context
        self._speeds = np.array([arm.speeds_rad_s for arm in machine.card.arms])
        self._carrier = carrier
        self._stuck = _Stuck()
        self._can_be_there: dict[tuple[object, ...], bool] = {}
        self._candidates: dict[tuple[object, ...], Candidate] = {}
        self._made: dict[Candidate, Transfer | None] = {}
        self.glances = self.tries = 0
        self._contacts = BlockingContacts(machine, collisions, scene.torso_m, scene.table.height_m)
        self.dwell_s = max(scene.grip_dwell_s, *(arm.gripper.least_s(OPEN_M, CLOSED_M) for arm in machine.card.arms))
        self.transits = TransitPaths(machine, collisions, scene.torso_m)
        self._cloths = LyingCloths(context, collisions)
        self.collisions = collisions

    def real(self, steps: Sequence[Step], tries: Tries = QUICK) -> Transfer | None:
        """Return the run that a few primitives make, none but the last of which lets go; None if none was found."""
        return self.first_real(ways_of(steps, tries), tries)

    def first_real(self, choices: Iterable[tuple[Step, ...]], tries: Tries) -> Transfer | None:
        """Return the first that is real of some choices of steps; None where so many tries find none.

        Where all take longer than their steps seem to it is the quickest of the first few.
        """
        late: list[Transfer] = []
        for number, candidate in enumerate(self.candidates(choices), start=1):
            run = self.made(candidate)
            most = tries.together if candidate.is_together else tries.alone
            if run is not None and not run.is_late:
                return run
            late += [] if run is None else [run]
            if len(late) == tries.late or number - len(late) >= most:
                break
        return min(late, key=lambda run: sum(run.durations_at_most_s()), default=None)

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
        self.glances += 1
        key = _motion_of(steps)
        if key not in self._can_be_there:
            phases = [phase for step in steps for phase in step.extremes()]
            moments = moments_of(phases, self._context.scene.table.height_m, only_ends=True)
            ends = np.flatnonzero(np.diff(moments.phases, append=moments.phases[-1] + 1))
            self._can_be_there[key] = self._carrier.can_hold_at(moments, [0, *ends[::-1].tolist()])
        return self._can_be_there[key]

    def candidate(self, steps: tuple[Step, ...]) -> "Candidate":
        """Steps as they are to be performed, moment by moment, whether they may be real or not. Remembered."""
        key = _motion_of(steps)
        if key not in self._candidates:
            self._candidates[key] = self._candidate(steps)
        return self._candidates[key]

    def _candidate(self, steps: tuple[Step, ...]) -> "Candidate":
        phases = [(n, phase) for n, step in enumerate(steps) for phase in step.phases() if phase.duration_s > 0.0]
        carrying = tuple((n, phase) for n, phase in phases if is_carrying(phase))
        before = None if steps[0].before.held else self._cloths.of(steps[0].before)
        cloths = (before, self._cloths.of(steps[-1].after))
        return Candidate(steps, carrying, self._moments([phase for _, phase in carrying]), cloths)

    def made(self, candidate: "Candidate") -> Transfer | None:
        """A candidate made real; None without a way. Remembered."""
        self.tries += 1
        if candidate not in self._made:
            self._made[candidate] = self._run(candidate, self._carrier.carried(candidate.moments, candidate.cloths))
        return self._made[candidate]

    def made_like(self, candidate: "Candidate", like: Transfer) -> Transfer | None:
        """A candidate made real, its joints near to those of another run if they can be; None without a way."""
        self.tries += 1
        return self._run(candidate, self._carrier.adapted(candidate.moments, candidate.cloths, like.carried))

    def _run(self, candidate: "Candidate", carried: Carried | NoPath) -> Transfer | None:
        if isinstance(carried, NoPath):
            self._stuck.note(candidate, carried)
            return None
        least, first, last = needed_s(carried.joints, self._speeds), carried.first, carried.last
        timing = TransferTiming.of(candidate.carrying, candidate.moments, least[first:last], self.dwell_s)
        reach = self._reach(candidate.steps, carried, timing.borrowed_s)
        if reach is None:
            return None
        return Transfer(candidate.steps, carried, timing, least[:first], least[last:], reach)

    def _moments(self, phases: Sequence[Phase]) -> Moments:
        return moments_of(phases, self._context.scene.table.height_m)

    def contact(self, steps: Sequence[Step]) -> BlockingContact | None:
        """What is in the arms' way in a run that cannot be made real; None where they are only cut off."""
        phases = [phase for step in steps for phase in step.phases() if phase.duration_s > 0.0 and is_carrying(phase)]
        return self._contacts.of(self._moments(phases))

    def _reach(self, steps: Sequence[Step], carried: Carried, borrowed_s: float) -> ReachTime | None:
        """The time that hands need to come from home and to go there; None without a way.

        What is left when fingers have closed is shared evenly between going home from the run before and coming, as
        long as that run is not known. Where nothing has been done before, hands wait at home, and after the last fold
        they need not go there.
        """
        home, motion_s = self.transits.home, self._context.scene.arm_motion_s
        lead, tail = carried.joints[: carried.first + 1], carried.joints[carried.last :]
        share_s = _HALF * max(motion_s - self.dwell_s, 0.0)
        room_s = motion_s - self.dwell_s - borrowed_s
        start, before = self._context.start, steps[0].before
        is_first = (before.done, before.place) == (start.done, start.place)
        is_last = steps[-1].after.done == (1 << len(self._context.sequence.folds)) - 1
        came_s: float | None = 0.0
        if carried.cloths[0] is not None:
            came_s = self._needed_s(carried.bases[0], (home, lead[0]), (None, lead), carried.cloths[0])
        left_s: float | None = 0.0
        if came_s is not None and not is_last:
            left_s = self._needed_s(carried.bases[-1], (tail[-1], home), (tail, None), carried.cloths[1])
        if came_s is None or left_s is None:
            return None
        return ReachTime(came_s, left_s, room_s, share_s, 0.0 if is_first else share_s)

    def _needed_s(
        self, base: FloatArray, ends: tuple[FloatArray, FloatArray], lines: Lines, cloth: LyingCloth
    ) -> float | None:
        """How long it takes at least to go along a way and the lines it leads from or to (s); None without a way."""
        way = self.transits.way(Pose2.of(base), *ends, cloth, self.transits.spared(*lines))
        if way is None:
            return None
        return sum(float(self.transits.needed_s(one).sum()) for one in (way, *lines) if one is not None)


def ways_of(steps: Sequence[Step], tries: Tries) -> Iterator[tuple[Step, ...]]:
    """Yield steps, then combinations of their variants, which take time to find; as many as are to be looked at."""
    yield tuple(steps)
    yield from islice(product(*(islice(step.variants(), tries.variants) for step in steps)), 1, tries.ways)


def _motion_of(steps: Sequence[Step]) -> tuple[object, ...]:
    """What tells steps from others of the same problem: a second round of tries looks at many of the first again."""
    return tuple(step.motion for step in steps)


@lru_cache(maxsize=4)
def _carrier(machine: RobotPort, table: Table, torso_m: float) -> tuple[Carrier, Collisions]:
    """What finds joint paths at a table, and what is in the way there: kept from plan to plan."""
    collisions = machine.collisions(table, torso_m, margin_m=MARGIN_M)
    return Carrier(machine, collisions, torso_m, table.height_m), collisions
