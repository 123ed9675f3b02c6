"""Validate motions lazily: look for joint paths only where the search is about to accept a path.

The search assumes for each primitive the cost that it has if the arms can follow, which is a lower bound. When it has
found a path, the path's transfers are validated one after the other. A step that fails is rejected, a step that takes
longer gets its true cost, and the search continues with these costs. Costs only rise, so the first path that is
validated at the cost at which it was found is the quickest: the path that a search validating every step would find.

The search knows only one way between two states. Where that way fails, similar ways from elsewhere usually fail too,
and finding this out one by one would take long. The validator therefore looks at once at a spread of other ways to do
the same, begun and ended elsewhere, and tries some of the promising ones. In every state in which the hands would do
the same, the first few that succeed replace all ways that the search had, except those validated before. A task at
which the same arms failed several times from one station, wherever the cloth lay, and never succeeded, is not tried
from there any more. "Infeasible" is therefore no proof where steps were rejected.

Where one of the other ways leads to the same state and takes no longer, the search can go on as if nothing had failed,
and the rest are found only once no path is left that takes no longer than the one at which the step was rejected.
A step that takes longer than it seemed to may have hidden ways that are quicker than it is; then too, a few are tried.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice

from planner.geometry.tolerance import TIME_S
from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s, is_transfer, linked, transfers_of
from planner.motion.transfer import Transfer
from planner.motion.transfer_candidate import QUICK, Candidate, SearchLimits, ways_of
from planner.motion.transfer_planner import TransferPlanner
from planner.planning.budget import Budget, OutOfTimeError
from planner.planning.sequence_costs import SequenceCosts, step_key
from planner.primitives.primitive import Step
from planner.primitives.state import State

_EDGES_TRIED = 2
"""Transfers in which hands hold edges that are tried where hands that open widely have no path."""


@dataclass(frozen=True, slots=True, eq=False)
class _Rejection:
    """A rejected step, and the other ways to do the same.

    Attributes:
        culprit: the step.
        before: the steps before it in its transfer.
        elsewhere: a spread of other ways to do the same.
        path_s: the time that the path on which it was rejected seemed to take (s).
    """

    culprit: Step
    before: tuple[Step, ...]
    elsewhere: tuple[Step, ...]
    path_s: float

    def as_good(self) -> Iterator[tuple[Step, ...]]:
        """Yield those ways to the same state that seem to take no longer, each with the steps before it."""
        most_s = self.culprit.duration_s + TIME_S
        for other in self.elsewhere:
            if other.duration_s <= most_s and other.after.key == self.culprit.after.key:
                yield (*self.before, other)


@dataclass(frozen=True, slots=True, eq=False)
class _Slow:
    """A step that takes longer than it seemed to, and may hide ways that are quicker than it is.

    Attributes:
        step: the step.
        before: the steps before it in its transfer.
        lasts_s: what it takes (s).
        path_s: the time that its path seemed to take (s).
    """

    step: Step
    before: tuple[Step, ...]
    lasts_s: float
    path_s: float

    def quicker(self, count: int) -> Iterator[tuple[Step, ...]]:
        """Yield some other ways to do the same that seem to take less, each with the steps before it."""
        for other in self.step.elsewhere(count):
            if other.duration_s < self.lasts_s - TIME_S:
                yield (*self.before, other)


class _FailureMemory:
    """The tasks given up in one search, wherever the cloth lies.

    The same arms failed at them several times from one station, and never succeeded.
    """

    def __init__(self, failures_max: int) -> None:
        """Start without any; a task is given up after so many failures."""
        self._failures_max = failures_max
        self._failures: Counter[tuple[object, ...]] = Counter()
        self._succeeded: set[tuple[object, ...]] = set()
        self._stations: dict[tuple[object, ...], int] = {}

    def __contains__(self, step: Step) -> bool:
        """Return whether the step's task is given up."""
        return bool(self._stations) and step.task in self._stations

    def is_given_up_from(self, station: int) -> bool:
        """Return whether some task is given up from a station."""
        return station in self._stations.values()

    def fail(self, step: Step) -> None:
        """Note that a step failed."""
        self._failures[step.task] += 1
        if self._failures[step.task] >= self._failures_max and step.task not in self._succeeded:
            self._stations[step.task] = step.before.station

    def succeed(self, step: Step) -> None:
        """Note that a step succeeded: its task is not given up, or no longer."""
        self._succeeded.add(step.task)
        self._stations.pop(step.task, None)


class MotionValidator:
    """The steps of one planning problem that are slower than assumed, or rejected.

    Attributes:
        maker: plans the transfers.
        rejected: the transfers that failed, each up to the step that failed.
        slower: the segments of the steps validated last, where they succeed but take longer than assumed.
        sequence_costs: what sequences of steps take longer because hands come late from one transfer to the next.
    """

    def __init__(
        self,
        maker: TransferPlanner,
        budget: Budget,
        search_limits: SearchLimits = QUICK,
        transfers_max: float = math.inf,
        hands: EdgeHands | None = None,
    ) -> None:
        """Start with nothing known.

        Args:
            maker: plans the transfers.
            budget: ends validation once it is over.
            search_limits: how much is tried.
            transfers_max: the most transfers that the arms are led through.
            hands: finds transfers in which hands hold edges, where others have no path; None: those are not looked for.
        """
        self.maker = maker
        self._budget = budget
        self._search_limits = search_limits
        self._last_try = maker.path_requests + transfers_max
        self._made: dict[tuple[object, ...], Transfer | None] = {}
        self._ways: dict[tuple[object, ...], tuple[Transfer, ...]] = {}
        self._hands = hands
        self._least_s: dict[object, float] = {}
        self._others: dict[object, tuple[Step, ...]] = {}
        self._real_steps: set[object] = set()
        self._given_up = _FailureMemory(search_limits.failures)
        self._doubted: set[tuple[object, ...]] = set()
        self._postponed: list[_Rejection] = []
        self._slow: list[_Slow] = []
        self._besides: dict[object, tuple[Step, ...]] = {}
        self.rejected: list[tuple[Step, ...]] = []
        self.slower: tuple[PlanSegment, ...] = ()
        self.sequence_costs = SequenceCosts()

    def possible(self, state: State, steps: Iterable[Step]) -> list[tuple[Step, float]]:
        """Return the steps leaving a state that may succeed, each with the least known cost (s)."""
        if not (self._others or self._least_s):
            return [(step, step.duration_s) for step in steps]
        situations: dict[tuple[object, ...], None] = {}
        found: list[Step] = []
        for step in steps:
            if step in self._given_up:
                continue
            situation = step.situation
            situations[situation] = None
            if situation not in self._others or step_key(step) in self._real_steps:
                found.append(step)
        for situation in situations:
            others = (*self._others.get(situation, ()), *self._besides.get(situation, ()))
            found += [other.begun_in(state) for other in others]
        costs_s = [self.known_s(step) for step in found]
        return [(step, cost_s) for step, cost_s in zip(found, costs_s, strict=True) if cost_s < math.inf]

    @property
    def has_doubts(self) -> bool:
        """Whether some steps were rejected or cost more than the bounds; steps left untried may then succeed."""
        return bool(self._least_s or self.sequence_costs)

    def is_in_doubt(self, held: State) -> bool:
        """Return whether ways to or from a grasp have failed or turned out to take longer than assumed."""
        return held.grasp in self._doubted or self._given_up.is_given_up_from(held.station)

    def plan_segments(self, steps: Sequence[Step]) -> tuple[PlanSegment, ...] | None:
        """Validate a plan's steps; return None if a step was rejected, or if some take longer than assumed.

        In the second case the segments can still be performed: they are in `slower`.

        Raises `OutOfTimeError` where there is no time to find out; what is known by then stays.
        """
        self.slower = ()
        seemed_s = sum(self.known_s(step) for step in steps) + self.sequence_costs.of(steps)
        found: list[PlanSegment] = []
        transfers: list[tuple[tuple[Step, ...], Transfer]] = []
        for first, part in transfers_of(steps):
            made = self._real(part) if is_transfer(part) else None
            found.append(PlanSegment(first, part if made is None else made.steps, made))
            if made is not None:
                transfers.append((part, made))
            elif is_transfer(part):
                self._all_agree(transfers, seemed_s)
                self._reject(part, seemed_s)
                return None
        plan_segments = linked(self._sooner(linked(found, self.maker)), self.maker, hastens=True)
        if duration_s(plan_segments) <= seemed_s + TIME_S:
            return plan_segments
        is_known = self._all_agree(transfers, seemed_s)
        for late in self.sequence_costs.noted(steps, plan_segments):
            is_known = False
            self._doubt(late)
        if is_known:
            return plan_segments
        self.slower = plan_segments
        return None

    def _sooner(self, plan_segments: tuple[PlanSegment, ...]) -> tuple[PlanSegment, ...]:
        """Return segments with quicker ways in place of those to which hands come late, or of those before.

        A transfer is chosen by how long it takes itself. How soon hands come to the next one depends on where they are.
        """
        before: int | None = None
        for number, plan_segment in enumerate(plan_segments):
            if plan_segment.transfer is None:
                continue
            for place in (number, before) if before is not None else (number,):
                for other in (
                    self._alternatives(plan_segments[place].steps) if plan_segments[number].late_s > TIME_S else ()
                ):
                    changed = PlanSegment(plan_segments[place].first, other.steps, other)
                    tried = linked((*plan_segments[:place], changed, *plan_segments[place + 1 :]), self.maker)
                    if duration_s(tried) < duration_s(plan_segments) - TIME_S:
                        plan_segments = tried
                    if plan_segments[number].late_s <= TIME_S:
                        break
            before = number
        return plan_segments

    def _alternatives(self, steps: tuple[Step, ...]) -> tuple[Transfer, ...]:
        """Return the first few transfers that do as some steps do, found once; fewer if there is no time."""
        key = tuple(step_key(step) for step in steps)
        if key not in self._ways:
            found: list[Transfer] = []
            failed = 0
            with suppress(OutOfTimeError):
                for candidate in self.maker.candidates(self._in_time(ways_of(steps, self._search_limits))):
                    made = self.maker.made(candidate)
                    if made is None:
                        failed += 1
                    else:
                        found.append(made)
                    if len(found) > self._search_limits.late or failed >= (
                        self._search_limits.together if candidate.is_together else self._search_limits.alone
                    ):
                        break
            self._ways[key] = tuple(found)
        return self._ways[key]

    def _real(self, steps: tuple[Step, ...]) -> Transfer | None:
        """Return a transfer that does as some steps do, whose hands hold in any way; None if none is found.

        Raises `OutOfTimeError` where there is no time to find out.
        """
        key = tuple(step_key(step) for step in steps)
        if key not in self._made:
            ways = self._in_time(ways_of(steps, self._search_limits))
            made = self.maker.first_valid(ways, self._search_limits)
            self._made[key] = self._at_edges(steps) if made is None else made
        return self._made[key]

    def _at_edges(self, steps: tuple[Step, ...]) -> Transfer | None:
        """Return a transfer that does as some steps do and in which hands hold edges; None if none is soon found."""
        if self._hands is None:
            return None
        self._require_time()
        return next(self._hands.ways(steps, _EDGES_TRIED), None)

    def _reject(self, steps: tuple[Step, ...], path_s: float) -> None:
        """Reject the first step at which a transfer fails, and find other ways to do the same.

        Where one of them is as good as the step itself, the others are left for later; see `catch_up`.
        """
        number = next((n for n in range(len(steps) - 1) if self._real(steps[: n + 1]) is None), len(steps) - 1)
        culprit, before = steps[number], steps[:number]
        self.rejected.append(steps[: number + 1])
        self._least_s[step_key(culprit)] = math.inf
        self._doubt(steps)
        rejection = _Rejection(culprit, before, tuple(culprit.elsewhere(self._search_limits.spread)), path_s)
        found = self._as_good(rejection)
        if found:
            self._postponed.append(rejection)
            self._others[culprit.situation] = found
        else:
            self._replace(rejection)
        if self._others[culprit.situation]:
            self._given_up.succeed(culprit)
        self._given_up.fail(culprit)

    def _as_good(self, rejection: _Rejection) -> tuple[Step, ...]:
        """Return a valid way to the same state that takes no longer than the rejected step; empty if none is found."""
        for candidate in islice(self.maker.candidates(self._in_time(rejection.as_good())), self._search_limits.enough):
            made = self._noted(candidate)
            if made is not None and made.durations_s()[-1] <= rejection.culprit.duration_s + TIME_S:
                return (candidate.steps[-1],)
        return ()

    def _replace(self, rejection: _Rejection) -> None:
        """Set the ways that replace a rejected step in every state of its situation."""
        search_limits, situation = self._search_limits, rejection.culprit.situation
        others = {step_key(other): other for other in self._others.get(situation, ()) if rejection in self._postponed}
        enough = len(others) + search_limits.enough
        new = ((*rejection.before, other) for other in rejection.elsewhere if step_key(other) not in others)
        for tried, candidate in enumerate(islice(self.maker.candidates(self._in_time(new)), search_limits.tried)):
            if candidate.is_together and tried == search_limits.vain and not others:
                break
            if self._noted(candidate) is not None:
                others[step_key(candidate.steps[-1])] = candidate.steps[-1]
            if len(others) == enough:
                break
        self._others[situation] = tuple(others.values())

    def _noted(self, candidate: Candidate) -> Transfer | None:
        """Return the transfer of a candidate for another way, and note what its last step takes."""
        made = self.maker.made(candidate)
        if made is not None:
            self._made[tuple(step_key(step) for step in candidate.steps)] = made
            self._least_s[step_key(candidate.steps[-1])] = made.durations_s()[-1]
        return made

    def catch_up(self, path_s: float) -> bool:
        """Find the postponed ways that may give a path quicker than one that takes `path_s`; return if any were due.

        No way to do a rejected step makes a path quicker than the one on which it was rejected seemed to be: as long as
        the search finds paths no slower than that, these ways are not needed.

        Raises `OutOfTimeError` where there is no time to find out.
        """
        due = [rejection for rejection in self._postponed if rejection.path_s < path_s - TIME_S]
        for rejection in due:
            self._replace(rejection)
            self._postponed.remove(rejection)
        late = [slow for slow in self._slow if slow.path_s < path_s - TIME_S]
        is_quicker = False
        for slow in late:
            is_quicker |= self._go_beside(slow)
            self._slow.remove(slow)
        return bool(due) or is_quicker

    def _go_beside(self, slow: _Slow) -> bool:
        """Add a way that is quicker than a slow step, beside those that the search has; return whether there is one."""
        search_limits, situation = self._search_limits, slow.step.situation
        ways = self.maker.candidates(self._in_time(slow.quicker(search_limits.spread)))
        for candidate in islice(ways, search_limits.enough):
            made = self._noted(candidate)
            if made is not None and made.durations_s()[-1] < slow.lasts_s - TIME_S:
                self._besides[situation] = (*self._besides.get(situation, ()), candidate.steps[-1])
                return True
        return False

    def _in_time(self, choices: Iterable[tuple[Step, ...]]) -> Iterator[tuple[Step, ...]]:
        for steps in choices:
            self._require_time()
            yield steps

    def _require_time(self) -> None:
        """Raise `OutOfTimeError` where the budget is over, or no more transfers are to be tried."""
        if self._budget.is_over or self.maker.path_requests >= self._last_try:
            raise OutOfTimeError

    def known_s(self, step: Step) -> float:
        """Return the least time that a step is known to take (s)."""
        return max(step.duration_s, self._least_s.get(step_key(step), 0.0))

    def _all_agree(self, transfers: Sequence[tuple[tuple[Step, ...], Transfer]], path_s: float) -> bool:
        """Return whether the steps of all transfers take as long as was known; note their true durations."""
        agreed = [self._agrees(steps, made, path_s) for steps, made in transfers]
        return all(agreed)

    def _agrees(self, steps: tuple[Step, ...], made: Transfer, path_s: float) -> bool:
        is_known = True
        for number, (step, lasts_s) in enumerate(zip(steps, made.durations_s(), strict=True)):
            known = self.known_s(step)
            if lasts_s > known + TIME_S:
                is_known = False
                self._slow.append(_Slow(step, steps[:number], lasts_s, path_s))
            self._least_s[step_key(step)] = max(lasts_s, known)
            self._real_steps.add(step_key(step))
            self._given_up.succeed(step)
        if not is_known:
            self._doubt(steps)
        return is_known

    def _doubt(self, steps: Iterable[Step]) -> None:
        """Mark the grasps on the way: the ways that seemed best for them may no longer be."""
        self._doubted.update(step.after.grasp for step in steps if step.after.held)
