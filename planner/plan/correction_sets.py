"""Why there is no plan, tried: what has to be removed, together, so that a fold can be done, and no less of it.

What seems to stand in a fold's way is measured where the fold was tried. Whether it is the cause shows when it is
removed and the planner is asked again. Where one change is enough, each that is makes a set of its own; where none is,
what still stands in the way then is removed too, until the fold can be done. Of what remains nothing can be left out,
and of what can be had by degrees the least is found by halving: with `LESS` of it the planner says no.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from planner.errors import FoldingError
from planner.plan.correction import COLLISIONS_IGNORED, Candidate, Way, candidates
from planner.plan.reason_obstacle import lacking
from planner.plan.reason_words import mended_by
from planner.plan.relaxed import Ask, Relaxed, Trial
from planner.task.reason import Code, Reason

LESS = 0.96
"""With so much of an amount that is told, or less, the fold cannot be done."""

ASKS_MAX = 20
"""So often the planner is asked at most to find the reasons of one problem."""

_MEMBERS_MAX = 3
"""Sets of more causes are not looked for."""

_SHIFTS = (("cloth", "station"), ("table", "torso"))
"""Ways that shift what the hands do alike."""


def corrected(base: Relaxed, met: Trial, ask: Ask, is_enough: Callable[[], bool]) -> tuple[Reason, ...]:
    """The reasons why a problem has no plan, those that were tried.

    Args:
        base: the problem.
        met: what became of it.
        ask: tries problems.
        is_enough: asked before each; true means that no more is tried.
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
            found += [_untried(reason) for reason in mine]
    return tuple(found or map(_untried, measured))


def _untried(reason: Reason) -> Reason:
    """A reason of which only is known that it was met: no shift is told that nobody has tried."""
    return replace(reason, shift_m=None, shift_towards=None)


class _SpentError(Exception):
    """There is nothing left of the budget."""


class _Asked:
    """Asks, not for ever; a problem that cannot be put is none that helps."""

    def __init__(self, ask: Ask, is_enough: Callable[[], bool]) -> None:
        self._ask = ask
        self._is_enough = is_enough
        self._left = ASKS_MAX
        self._known: dict[tuple[Way, Relaxed, float], tuple[Relaxed, Trial] | None] = {}

    def __call__(self, way: Way, base: Relaxed, amount: float, folds: int) -> tuple[Relaxed, Trial] | None:
        key = (way, base, amount)
        if key not in self._known:
            changed = _applied(way, base, amount)
            self._known[key] = None if changed is None else (changed, self.trial(changed, folds))
        return self._known[key]

    def trial(self, relaxed: Relaxed, folds: int) -> Trial:
        if not self._left or self._is_enough():
            raise _SpentError
        self._left -= 1
        return self._ask(relaxed, folds)

    def measured(self, trial: Trial) -> tuple[Reason, ...]:
        """What stood in the way of a trial."""
        if self._is_enough():
            raise _SpentError
        return trial.measured()


def _applied(way: Way, base: Relaxed, amount: float) -> Relaxed | None:
    """A problem with a cause removed; None where no such problem can be put."""
    try:
        return way.applied(base, amount)
    except FoldingError:
        return None


@dataclass(frozen=True, slots=True, eq=False)
class _Member:
    """A cause, the way in which it is removed, how much of that, and which other ways do as well with as much."""

    reason: Reason
    way: Way
    amount: float
    also: tuple[str, ...] = ()

    @property
    def told(self) -> Reason:
        return self.way.told(self.reason, self.amount)


def _needed(way: Way, amount: float, trial: Trial) -> float:
    """How much of an amount that is enough what was found with it really needs."""
    return amount if way.needed is None else min(way.needed(trial), amount)


def _stays(relaxed: Relaxed) -> bool:
    """Whether the cloth stays where it lies at the start."""
    return relaxed.work.unrest(0, relaxed.problem.start.offset) is None


def _further(members: tuple[_Member, ...]) -> Iterator[tuple[_Member, ...]]:
    """Causes removed as they are, and then by the amounts beyond, as long as there are any."""
    most = max((len(member.way.amounts) for member in members), default=0)
    for number in range(most):
        amounts = (member.way.amounts for member in members)
        yield tuple(
            replace(member, amount=max(member.amount, of_way[min(number, len(of_way) - 1)])) if of_way else member
            for member, of_way in zip(members, amounts, strict=True)
        )


class _Corrections:
    """The sets for one fold, or with None for all of a garment.

    Attributes:
        is_but_touching: whether all is in reach, and nothing but what the arms touch stands in the way.
    """

    def __init__(self, base: Relaxed, fold: int | None, asked: _Asked) -> None:
        self._base = base
        self._fold = fold
        self._asked = asked
        dag, everything = base.work.sequence.dag, range(len(base.work.sequence.folds))
        wanted = everything if fold is None else (fold, *dag.before(fold))
        self._folds = sum(1 << index for index in wanted)
        self._gives = "plan" if len(tuple(wanted)) == len(everything) else "fold"
        self.is_but_touching = False

    def sets(self, met: Trial, measured: tuple[Reason, ...]) -> list[tuple[Reason, ...]]:
        """Sets of causes; of several each is enough. Empty where none was found."""
        found: list[tuple[_Member, ...]] = []
        own = list(candidates(met.work, measured, self._fold))
        with suppress(_SpentError):
            self.is_but_touching = met.has_collided and self._is_enough(COLLISIONS_IGNORED, self._base, 0.0)
            for candidate in own:
                found += self._enough(candidate)
            if not (found or self.is_but_touching):
                found += [self._least_of(self._shortened(members)) for members in self._extended(self._base, (), own)]
        found.sort(key=self._repair)
        return [self._told(members) for members in found] or [(told,) for told in self._at_rest(own)]

    def _repair(self, members: tuple[_Member, ...]) -> tuple[int, float]:
        """How many things are to be removed, arms that nobody has counted as two, and how much is lacking in all."""
        is_dream = any(member.way.kind == "arms" for member in members)
        return len(members) + is_dream, sum(lacking(member.told, self._base.work) for member in members)

    def _enough(self, candidate: Candidate) -> Iterator[tuple[_Member, ...]]:
        """A cause that is enough, removed in the first way that is, or that would be if nothing collided then."""
        *_, last = candidate.ways
        ways = [way for way in candidate.ways if way.kind != "arms"]
        is_clear = not self.is_but_touching
        if last.kind == "arms" and not self._is_enough(last, self._base, 0.0):
            return
        for way in ways:
            found = self._least(way, self._base)
            if found is not None:
                also = self._alike(candidate, way, found, self._base)
                yield (_Member(candidate.reason, way, found, also),)
                return
        for way in ways if is_clear else ():
            pair = self._but_for_collisions(candidate, way)
            if pair is not None:
                yield pair
                return
        if last.kind == "arms" and is_clear:
            yield (_Member(candidate.reason, last, 0.0),)

    def _alike(self, candidate: Candidate, way: Way, amount: float, base: Relaxed) -> tuple[str, ...]:
        """Which other ways do as well with as much, where they are alike."""
        alike = next((kinds for kinds in _SHIFTS if way.kind in kinds), ())
        others = (other for other in candidate.ways if other.kind in alike and other.kind != way.kind)
        return tuple(other.kind for other in others if self._is_enough(other, base, amount))

    def _but_for_collisions(self, candidate: Candidate, way: Way) -> tuple[_Member, ...] | None:
        """A way to remove a cause with which all is in reach, and what the arms touch then."""
        for amount in way.amounts or (0.0,):
            tried = self._asked(way, self._base, amount, self._folds)
            if tried is not None and tried[1].has_collided:
                touching = [r for r in self._asked.measured(tried[1]) if r.code is Code.COLLISION]
                through = self._base.with_collisions_ignored()
                found = self._least(way, through) if touching else None
                if found is not None:
                    also = self._alike(candidate, way, found, through)
                    return _Member(candidate.reason, way, found, also), _Member(touching[0], COLLISIONS_IGNORED, 0.0)
        return None

    def _advised(self, member: _Member) -> Reason:
        """A reason with what was tried and does."""
        told, kind = member.told, member.way.kind
        if told.code is not Code.OUT_OF_REACH or told.station is None or kind == "comfort":
            return told
        kinds = () if kind == "arms" else tuple(k for pair in _SHIFTS for k in pair if k in (kind, *member.also))
        return mended_by(told, dict(self._base.work.scene.stations)[told.station], kinds)

    def _is_enough(self, way: Way, base: Relaxed, amount: float) -> bool:
        found = self._asked(way, base, amount, self._folds)
        return found is not None and found[1].is_possible

    def _least(self, way: Way, base: Relaxed) -> float | None:
        """The least amount of a change that is enough; None if none is."""
        low = 0.0
        for amount in way.amounts or (0.0,):
            found = self._asked(way, base, amount, self._folds)
            if found is not None and found[1].is_possible:
                if not way.amounts:
                    return amount
                least = self._settled(way, base, low, _needed(way, amount, found[1]))
                return least if least > 0.0 else None
            low = amount
        return None

    def _settled(self, way: Way, base: Relaxed, low: float, high: float) -> float:
        """The least amount between one that is not enough and one that is: first just below, then halfway."""
        probe = LESS * high
        while high > 0.0 and low < LESS * high:
            tried = self._asked(way, base, probe, self._folds)
            if tried is not None and tried[1].is_possible:
                high = _needed(way, probe, tried[1])
            else:
                low = probe
            probe = LESS * high if way.needed is not None and low < 0.5 * high else 0.5 * (low + high)
        return high

    def _extended(
        self, base: Relaxed, members: tuple[_Member, ...], own: Sequence[Candidate]
    ) -> list[tuple[_Member, ...]]:
        """Causes that together are enough, found by removing one and looking what still stands in the way.

        Arms that reach everything come first: what else stands in the way is seen in no time then.
        """
        kinds = {member.way.kind for member in members}
        open_ways = [(c, c.ways[-1]) for c in own if c.ways[-1].kind not in kinds]
        onwards: list[tuple[tuple[_Member, ...], Relaxed, Trial]] = []
        for candidate, way in sorted(open_ways, key=lambda pair: pair[1].kind != "arms"):
            amount = way.most if way.kind == "friction" else way.amounts[0] if way.amounts else 0.0
            found = self._asked(way, base, amount, self._folds)
            if found is None:
                continue
            chosen = (*members, _Member(candidate.reason, way, amount))
            if found[1].is_possible:
                return [chosen]
            onwards.append((chosen, *found))
        if len(members) + 1 < _MEMBERS_MAX:
            for chosen, changed, trial in onwards:
                measured = self._asked.measured(trial)
                mine = tuple(r for r in measured if r.fold in (self._fold, None)) or measured
                further = list(candidates(trial.work, mine, mine[0].fold if mine else self._fold))
                found_set = self._extended(changed, chosen, further)
                if found_set:
                    return found_set
        return []

    def _at_rest(self, own: Sequence[Candidate]) -> Iterator[Reason]:
        """What is enough for the cloth to stay at the start as it lies, if not for a plan."""
        for candidate in own if self._fold is None else ():
            for way in candidate.ways:
                tried = ((amount, _applied(way, self._base, amount)) for amount in way.amounts)
                enough = next(((amount, at) for amount, at in tried if at is not None and _stays(at)), None)
                if enough is not None:
                    amount, changed = enough
                    yield replace(way.told(candidate.reason, amount), change=changed.change, gives="start")
                    break

    def _shortened(self, members: tuple[_Member, ...]) -> tuple[_Member, ...]:
        """No member that can be left out; in place of arms of any length a shift that is enough, if there is one."""
        for member in members:
            rest = tuple(other for other in members if other is not member)
            for others in _further(rest) if member.way.kind == "arms" else [rest] if rest else []:
                if self._asked.trial(self._with(others), self._folds).is_possible:
                    return self._shortened(others)
        others = tuple(member for member in members if member.way.kind != "arms")
        return members if len(others) == len(members) else (*others, self._shifted(others, members))

    def _shifted(self, others: tuple[_Member, ...], members: tuple[_Member, ...]) -> _Member:
        """What is out of reach once all others are removed, and the least shift that is enough, else long arms."""
        base = self._with(others)
        trial = self._asked.trial(base, self._folds)
        far = [r for r in self._asked.measured(trial) if r.fold == self._fold and r.code is Code.OUT_OF_REACH]
        for candidate in candidates(trial.work, tuple(far), self._fold):
            if candidate.ways[-1].kind == "arms":
                for way in candidate.ways[:-1]:
                    found = self._least(way, base)
                    if found is not None:
                        return _Member(candidate.reason, way, found)
                return _Member(candidate.reason, candidate.ways[-1], 0.0)
        return next(member for member in members if member.way.kind == "arms")

    def _least_of(self, members: tuple[_Member, ...]) -> tuple[_Member, ...]:
        """Of each member the least with which the others are enough."""
        settled = list(members)
        for number, member in enumerate(members):
            rest = self._with([other for n, other in enumerate(settled) if n != number])
            found = self._least(replace(member.way, amounts=(member.amount,) if member.way.amounts else ()), rest)
            if found is not None:
                settled[number] = replace(member, amount=found)
        return tuple(settled)

    def _with(self, members: Sequence[_Member]) -> Relaxed:
        relaxed = self._base
        for member in members:
            relaxed = member.way.applied(relaxed, member.amount)
        return relaxed

    def _told(self, members: tuple[_Member, ...]) -> tuple[Reason, ...]:
        change = self._with(members).change
        return tuple(replace(self._advised(member), change=change, gives=self._gives) for member in members)
