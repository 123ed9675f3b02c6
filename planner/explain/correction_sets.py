"""Find correction sets: minimal sets of changes that together allow a fold for which there is no plan.

What seems to stand in a fold's way is measured where the fold was tried. Whether it is the cause shows when it is
removed and the problem is planned again. Each single change that is enough is a set of its own. Where there is none,
what still stands in the way is removed too, until the fold can be done. No member of a set can be left out, and the
least amount of each change is found by bisection.

Checking that all places are in reach takes a hundredth of the time that joint paths take, and what is out of reach has
no joint paths. So sets and their amounts are found with collisions ignored, and joint paths are looked for only with
the result. If they fail there, what the arms touch is part of the cause, or a larger amount is needed.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from planner.errors import FoldingError
from planner.explain.correction import COLLISIONS_IGNORED, Candidate, Way, candidates
from planner.explain.reason_obstacle import lacking
from planner.explain.reason_out_of_reach import remedied_by
from planner.explain.relaxed import Ask, Relaxed
from planner.geometry.tolerance import LENGTH_M
from planner.planning.trial import Trial
from planner.task.reason import Code, Reason

ASKS_MAX = 80
"""Trials that are made to find the reasons of one problem."""

_MEMBERS_MAX = 3
"""Causes in one set at most."""

_SHIFTS = (("cloth", "station"), ("table", "torso"))
"""Ways that shift the hands' path alike."""

_A_LITTLE_M = 0.003
"""Added to the least shift found together with another change, which is then tried alone (m)."""

_SLACKS = ("comfort", "cone")
"""Ways that are tried together with a shift where no change alone is enough."""


def corrected(base: Relaxed, met: Trial, ask: Ask, is_enough: Callable[[], bool]) -> tuple[Reason, ...]:
    """Return the reasons why a problem has no plan, each tried.

    Args:
        base: the problem.
        met: its trial, with the reasons met.
        ask: tries relaxed problems.
        is_enough: polled before each trial; true ends them.
    """
    measured = met.measured()
    asked = _Asked(ask, is_enough)
    found: list[Reason] = []
    for fold in dict.fromkeys(reason.fold for reason in measured):
        mine = tuple(reason for reason in measured if reason.fold == fold)
        if any(reason.code is Code.WAITS_FOR_FOLD for reason in mine):
            found += mine
            continue
        corrections = _Corrections(base, fold, asked)
        sets = corrections.sets(met, mine)
        number = 1 + max((-1 if reason.set is None else reason.set for reason in found), default=-1)
        found += [replace(reason, set=number + n) for n, members in enumerate(sets) for reason in members]
        if not (sets or corrections.is_but_touching):
            found += untried(mine)
    return tuple(found) or untried(measured)


def untried(measured: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons that were met but not tried, without their shifts."""
    return tuple(replace(reason, shift_m=None, shift_towards=None) for reason in measured)


class _SpentError(Exception):
    """The trials, or the time for them, are used up."""


class _Asked:
    """Runs trials within limits; a change that gives no valid problem counts as no help."""

    def __init__(self, ask: Ask, is_enough: Callable[[], bool]) -> None:
        self._ask = ask
        self._is_enough = is_enough
        self._left = ASKS_MAX
        self._known: dict[tuple[Way, Relaxed, float, bool], tuple[Relaxed, Trial] | None] = {}

    def __call__(
        self, way: Way, base: Relaxed, amount: float, folds: int, *, with_arms: bool
    ) -> tuple[Relaxed, Trial] | None:
        """Return a problem with a cause removed and its trial; None where the change gives no valid problem."""
        key = (way, base, amount, with_arms)
        if key not in self._known:
            changed = _applied(way, base, amount)
            self._known[key] = None if changed is None else (changed, self.trial(changed, folds, with_arms=with_arms))
        return self._known[key]

    def trial(self, relaxed: Relaxed, folds: int, *, with_arms: bool) -> Trial:
        """Return the trial of a problem; without arms it is enough that all places are in reach."""
        if not self._left or self._is_enough():
            raise _SpentError
        self._left -= 1
        return self._ask(relaxed if with_arms else relaxed.with_collisions_ignored(), folds)

    def measured(self, trial: Trial) -> tuple[Reason, ...]:
        """Return the reasons that a trial met."""
        if self._is_enough():
            raise _SpentError
        return trial.measured()


def _applied(way: Way, base: Relaxed, amount: float) -> Relaxed | None:
    """Return a problem with a cause removed; None where the change gives no valid problem."""
    try:
        return way.applied(base, amount)
    except FoldingError:
        return None


@dataclass(frozen=True, slots=True, eq=False)
class _Member:
    """A cause, the way in which it is removed, the amount, and other ways that are enough with the same amount."""

    reason: Reason
    way: Way
    amount: float
    also: tuple[str, ...] = ()

    @property
    def told(self) -> Reason:
        return self.way.told(self.reason, self.amount)


def _needed(way: Way, amount: float, trial: Trial) -> float:
    """Return how much of a sufficient amount the path found with it really needs."""
    return amount if way.needed is None else min(way.needed(trial), amount)


def _stays(relaxed: Relaxed) -> bool:
    """Return whether the cloth stays where it lies at the start."""
    return relaxed.problem.unrest is None


class _Corrections:
    """The correction sets for one fold; for None, of the whole garment.

    Attributes:
        is_but_touching: whether all places are in reach, so that only what the arms touch stands in the way.
    """

    def __init__(self, base: Relaxed, fold: int | None, asked: _Asked) -> None:
        self._base = base
        self._fold = fold
        self._asked = asked
        dag, everything = base.context.sequence.dag, range(len(base.context.sequence.folds))
        wanted = everything if fold is None else (fold, *dag.before(fold))
        self._folds = sum(1 << index for index in wanted)
        self.is_but_touching = False
        self._gives = "plan" if len(tuple(wanted)) == len(everything) else "fold"

    def sets(self, met: Trial, measured: tuple[Reason, ...]) -> list[tuple[Reason, ...]]:
        """Return sets of causes, each of which is enough; empty where none was found."""
        found: list[tuple[_Member, ...]] = []
        own = list(candidates(met.context, measured, self._fold))
        with suppress(_SpentError):
            if met.has_collided:
                self.is_but_touching = self._asked.trial(self._base, self._folds, with_arms=False).is_possible
            for candidate in own:
                found += self._enough(candidate)
            if not (found or self.is_but_touching):
                found += self._together(self._base, (), own)
        found.sort(key=self._repair)
        return [self._told(members) for members in found] or [(told,) for told in self._at_rest(own)]

    def _repair(self, members: tuple[_Member, ...]) -> tuple[int, float]:
        """Return the number of changes, in which one that no robot allows counts as three, and the total shortfall."""
        dreams = sum(2 for member in members if member.way.is_dream)
        return len(members) + dreams, sum(lacking(member.told, self._base.context) for member in members)

    def _enough(self, candidate: Candidate) -> Iterator[tuple[_Member, ...]]:
        """Yield a cause that is enough, removed in the first way that works, or that would work but for collisions."""
        *ways, last = candidate.ways
        if last.is_dream and not self._is_enough(last, self._base, last.most, with_arms=False):
            return
        slacks = [way for way in ways if way.kind == "cone"]
        touching: list[tuple[_Member, ...]] = []
        for way in candidate.ways if not last.is_dream else (way for way in ways if way not in slacks):
            found, touched = self._least(way, self._base)
            if touched is not None and found is not None:
                also = self._alike(candidate, way, found, self._base.with_collisions_ignored())
                touching.append(
                    (_Member(candidate.reason, way, found, also), _Member(touched, COLLISIONS_IGNORED, 0.0))
                )
            elif found is not None:
                yield (_Member(candidate.reason, way, found, self._alike(candidate, way, found, self._base)),)
                return
        if touching:
            yield touching[0]
        elif last.is_dream and not self.is_but_touching:
            yield self._stretched(candidate, slacks) or (_Member(candidate.reason, last, last.most),)

    def _stretched(self, candidate: Candidate, slacks: Sequence[Way]) -> tuple[_Member, ...] | None:
        """Return a less convenient change that is enough, or two that bring into reach what neither does alone."""
        with suppress(_SpentError):
            for way in slacks:
                found, touched = self._least(way, self._base)
                if found is not None and touched is None:
                    return (_Member(candidate.reason, way, found),)
            for way in (way for way in candidate.ways if way.kind in _SLACKS):
                first = _Member(candidate.reason, way, way.most)
                tried = self._asked(way, self._base, way.most, self._folds, with_arms=False)
                second = None if tried is None else next(self._shifted((first,), tried), None)
                if tried is not None and second is not None:
                    low = self._settled(second.way, tried[0], 0.0, second.amount, with_arms=False)
                    amounts = (low, low + _A_LITTLE_M, second.amount)
                    alone = self._first(second.way, self._base, 0.0, amounts, with_arms=True)
                    if alone is not None:
                        return (_Member(candidate.reason, second.way, alone),)
                    return self._least_of((first, replace(second, amount=low)))
        return None

    def _alike(self, candidate: Candidate, way: Way, amount: float, base: Relaxed) -> tuple[str, ...]:
        """Return the ways with the same effect that are also enough with the same amount."""
        alike = next((kinds for kinds in _SHIFTS if way.kind in kinds), ())
        others = (other for other in candidate.ways if other.kind in alike and other.kind != way.kind)
        return tuple(other.kind for other in others if self._is_enough(other, base, amount))

    def _is_enough(self, way: Way, base: Relaxed, amount: float, *, with_arms: bool = True) -> bool:
        found = self._asked(way, base, amount, self._folds, with_arms=with_arms)
        return found is not None and found[1].is_possible

    def _least(self, way: Way, base: Relaxed) -> tuple[float | None, Reason | None]:
        """Return the least sufficient amount, and what the arms touch with it; None where there is none.

        Where collisions are what is left in the way, the amount is the least that brings all places into reach.
        """
        is_in_reach = base is self._base and self.is_but_touching
        least = 0.0 if is_in_reach else self._first(way, base, 0.0, way.amounts or (0.0,), with_arms=False)
        if least is None or (way.amounts and least <= 0.0 and not is_in_reach):
            return None, None
        beyond = (*(() if is_in_reach else (least,)), *(amount for amount in way.amounts or (0.0,) if amount > least))
        real = self._first(way, base, max(least - way.exact, 0.0), beyond or (least,), with_arms=True)
        if real is not None or is_in_reach:
            return real, None
        tried = self._asked(way, base, least, self._folds, with_arms=True)
        touched = () if tried is None or not tried[1].has_collided else self._asked.measured(tried[1])
        touching = next((reason for reason in touched if reason.code is Code.COLLISION), None)
        return (None, None) if touching is None else (least, touching)

    def _first(self, way: Way, base: Relaxed, low: float, amounts: Sequence[float], *, with_arms: bool) -> float | None:
        """Return the least amount up to the first sufficient one of some amounts; None if none is sufficient."""
        for amount in amounts:
            found = self._asked(way, base, amount, self._folds, with_arms=with_arms)
            if found is not None and found[1].is_possible:
                return self._settled(way, base, low, _needed(way, amount, found[1]), with_arms=with_arms)
            low = amount
        return None

    def _settled(self, way: Way, base: Relaxed, low: float, high: float, *, with_arms: bool) -> float:
        """Return the least sufficient amount in an interval: try just below its upper end first, then halfway."""
        probe = high - way.exact
        with suppress(_SpentError):
            while high - low > way.exact + LENGTH_M:
                tried = self._asked(way, base, probe, self._folds, with_arms=with_arms)
                if tried is not None and tried[1].is_possible:
                    high = _needed(way, probe, tried[1])
                else:
                    low = probe
                probe = high - way.exact if way.needed is not None and low < 0.5 * high else 0.5 * (low + high)
        return high

    def _together(
        self, base: Relaxed, members: tuple[_Member, ...], own: Sequence[Candidate]
    ) -> list[tuple[_Member, ...]]:
        """Return sets that together are enough: remove one cause and look what still stands in the way.

        Arms that reach everything come first, since they soon show what else stands in the way.
        """
        kinds = {member.way.kind for member in members}
        onwards: list[tuple[tuple[_Member, ...], Relaxed, Trial]] = []
        firsts = [(one, one.ways[-1] if one.ways[-1].kind == "arms" else one.ways[0]) for one in own]
        for candidate, way in sorted(firsts, key=lambda pair: pair[1].kind != "arms"):
            if way.kind in kinds:
                continue
            amount = way.most if way.needed is not None else next(iter(way.amounts), 0.0)
            tried = self._asked(way, base, amount, self._folds, with_arms=False)
            if tried is None:
                continue
            chosen = (*members, _Member(candidate.reason, way, amount))
            if tried[1].is_possible:
                return [self._least_of(self._shortened(chosen))]
            onwards.append((chosen, *tried))
        for chosen, changed, trial in onwards if len(members) + 1 < _MEMBERS_MAX else ():
            measured = self._asked.measured(trial)
            mine = tuple(r for r in measured if r.fold in (self._fold, None)) or measured
            further = list(candidates(trial.context, mine, mine[0].fold if mine else self._fold))
            found = self._together(changed, chosen, further)
            if found:
                return found
        return []

    def _shortened(self, members: tuple[_Member, ...]) -> tuple[_Member, ...]:
        """Leave out members that are not needed; replace arms of any length by a sufficient shift, if there is one."""
        with suppress(_SpentError):
            for member in members:
                rest = tuple(other for other in members if other is not member)
                for others in _further(rest) if member.way.is_dream else [rest] if rest else []:
                    if self._asked.trial(self._with(others), self._folds, with_arms=False).is_possible:
                        return self._shortened(others)
            others = tuple(member for member in members if not member.way.is_dream)
            if others and len(others) < len(members):
                base = self._with(others)
                trial = self._asked.trial(base, self._folds, with_arms=False)
                shifted = next(self._shifted(others, (base, trial)), None)
                return members if shifted is None else (*others, shifted)
        return members

    def _shifted(self, others: tuple[_Member, ...], tried: tuple[Relaxed, Trial]) -> Iterator[_Member]:
        """Yield the least shifts that are enough for what is out of reach once other causes are removed."""
        kinds = {member.way.kind for member in others}
        far = [r for r in self._asked.measured(tried[1]) if r.fold == self._fold and r.code is Code.OUT_OF_REACH]
        for candidate in candidates(tried[1].context, tuple(far), self._fold):
            for way in candidate.ways[:-1] if candidate.ways[-1].is_dream else ():
                for amount in way.amounts if way.kind not in kinds else ():
                    if self._is_enough(way, tried[0], amount, with_arms=False):
                        yield _Member(candidate.reason, way, amount)
                        break

    def _least_of(self, members: tuple[_Member, ...]) -> tuple[_Member, ...]:
        """Reduce each member to the least with which the others are enough; add what the arms touch then."""
        least = self._halved(members, (0.0,) * len(members), with_arms=False)
        if any(member.way.is_dream or member.way is COLLISIONS_IGNORED for member in members):
            return least
        trial = self._asked.trial(self._with(least), self._folds, with_arms=True)
        if trial.is_possible:
            return least
        if self._asked.trial(self._with(members), self._folds, with_arms=True).is_possible:
            return self._halved(members, [member.amount for member in least], with_arms=True)
        touching = next((reason for reason in self._asked.measured(trial) if reason.code is Code.COLLISION), None)
        if touching is None:
            raise _SpentError
        return (*least, _Member(touching, COLLISIONS_IGNORED, 0.0))

    def _halved(self, members: tuple[_Member, ...], lows: Sequence[float], *, with_arms: bool) -> tuple[_Member, ...]:
        """Reduce each member in turn to the least above its lower limit with which the others are enough."""
        settled = list(members)
        for number, (member, low) in enumerate(zip(members, lows, strict=True)):
            if member.way.amounts:
                rest = self._with([other for n, other in enumerate(settled) if n != number])
                amount = self._settled(member.way, rest, low, member.amount, with_arms=with_arms)
                settled[number] = replace(member, amount=amount)
        return tuple(settled)

    def _at_rest(self, own: Sequence[Candidate]) -> Iterator[Reason]:
        """Yield what lets the cloth stay as it lies at the start, though it may not give a plan."""
        for candidate in own if self._fold is None else ():
            for way in candidate.ways:
                tried = ((amount, _applied(way, self._base, amount)) for amount in way.amounts)
                enough = next(((amount, at) for amount, at in tried if at is not None and _stays(at)), None)
                if enough is not None:
                    amount, changed = enough
                    yield replace(way.told(candidate.reason, amount), change=changed.change, gives="start")
                    break

    def _with(self, members: Sequence[_Member]) -> Relaxed:
        relaxed = self._base
        for member in members:
            relaxed = member.way.applied(relaxed, member.amount)
        return relaxed

    def _told(self, members: tuple[_Member, ...]) -> tuple[Reason, ...]:
        change = self._with(members).change
        return tuple(replace(self._advised(member), change=change, gives=self._gives) for member in members)

    def _advised(self, member: _Member) -> Reason:
        """Return a member's reason, with the advice that proved true when tried."""
        told, kind = member.told, member.way.kind
        shifts = tuple(k for pair in _SHIFTS for k in pair if k in (kind, *member.also))
        if told.code is not Code.OUT_OF_REACH or not (shifts or member.way.is_dream):
            return told
        return remedied_by(told, self._base.context, shifts)


def _further(members: tuple[_Member, ...]) -> Iterator[tuple[_Member, ...]]:
    """Yield causes removed by their amounts, and then by their larger amounts, as long as there are any."""
    most = max((len(member.way.amounts) for member in members), default=0)
    for number in range(most):
        amounts = (member.way.amounts for member in members)
        yield tuple(
            replace(member, amount=max(member.amount, of_way[min(number, len(of_way) - 1)])) if of_way else member
            for member, of_way in zip(members, amounts, strict=True)
        )
