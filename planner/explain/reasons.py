"""Report why there is no plan: for each fold that was never done, what stood in its way, where, and by how much.

Blocked folds come first, each with its causes, the smallest repair first. Folds that only wait for them come last.
Where every fold can be done, but not all of them in sequence, the blocked folds are those left when the most were done.
"""

from collections.abc import Collection, Iterator

from planner.cloth.g_state import Unrest
from planner.explain.reason_causes import Causes
from planner.explain.reason_collision import collisions
from planner.explain.reason_obstacle import of_obstacle
from planner.explain.reason_places import Places
from planner.planning.events import Obstacles
from planner.primitives.context import Context
from planner.primitives.obstacle import BlockingContact, Obstacle, Situation
from planner.primitives.primitive import Step
from planner.task.reason import Code, Reason
from planner.words.catalogue import worded


def reasons_met(obstacles: Obstacles) -> tuple[Reason, ...]:
    """Return the reasons that a search met, not tried yet."""
    context = obstacles.problem.context
    unrest = obstacles.problem.unrest
    if unrest is not None:
        return (reason_at_start(context, unrest),)
    for step, contact in obstacles.contacts():
        note_collision(context, step, contact)
    return reasons(context, obstacles.reached, obstacles.impossible)


def reasons(context: Context, reached: Collection[Situation], impossible: Collection[int]) -> tuple[Reason, ...]:
    """Return the reasons once it is proven that there is no plan.

    Args:
        context: the planning context, with the obstacles met.
        reached: the situations that the search reached.
        impossible: folds that cannot be done even alone, for which the search may have ended early; empty if the search
            has exhausted all states.
    """
    return _Reasons(context, reached, impossible).all()


def reason_at_start(context: Context, unrest: Unrest) -> Reason:
    """Return why there is no plan for cloth that does not stay as it lies at the start."""
    state = context.start
    spread, top = context.sequence.cloth(state.done).silhouette, context.table_in_article(state.offset)
    is_too_large = all(spread.contains(edge.start) for edge in top.edges)
    says = worded("at_start", {"what": unrest.says.to_dict(), "is_too_large": is_too_large})
    return of_obstacle(context, Obstacle(None, Code(unrest.code), says, unrest.severity, state, unrest.point))


def note_collision(context: Context, step: Step, contact: BlockingContact | None) -> None:
    """Note that the arms cannot perform a step although its places are in reach, and the blocking contact."""
    for obstacle in collisions(context, step, contact):
        context.obstacles.note(obstacle)


class _Reasons:
    """Collects the reasons why one problem has no plan."""

    def __init__(self, context: Context, reached: Collection[Situation], impossible: Collection[int]) -> None:
        self._context = context
        self._places = Places(context, reached)
        self._dones = {0, *(situation[0] for situation in reached)}
        self._impossible = impossible

    def all(self) -> tuple[Reason, ...]:
        blocked = self._blocked()
        causes = [reason for fold in blocked for reason in self._causes(fold)]
        return (*causes, *self._of_no_fold(), *self._waiting(blocked))

    def _of_no_fold(self) -> Iterator[Reason]:
        """Yield the mildest drag that the arms could not follow and that only another drag would have made useful."""
        met = sorted(self._context.obstacles.of(None), key=lambda obstacle: obstacle.severity)
        yield from (of_obstacle(self._context, obstacle) for obstacle in met[:1])

    def _blocked(self) -> list[int]:
        """Return the folds that could come next but cannot be done."""
        if self._impossible:
            return sorted(self._impossible)
        achieved = 0
        for done in self._dones:
            achieved |= done
        never = {fold for done in self._dones for fold in self._next(done) if not achieved >> fold & 1}
        return sorted(never or {fold for done in self._furthest(self._dones) for fold in self._next(done)})

    def _next(self, done: int) -> tuple[int, ...]:
        return self._context.sequence.dag.available(done)

    @staticmethod
    def _furthest(dones: Collection[int]) -> set[int]:
        """Return those sets of folds with the most folds in them."""
        most = max((done.bit_count() for done in dones), default=0)
        return {done for done in dones if done.bit_count() == most}

    def _causes(self, fold: int) -> tuple[Reason, ...]:
        """Return why a fold could not be done when the most others were."""
        could = {done for done in self._dones if fold in self._next(done)}
        met = self._context.obstacles.dones(fold)
        found = Causes(self._context, fold, self._furthest(could & met or met), self._places).reasons()
        return found or (self._nothing_known(fold),)

    def _nothing_known(self, fold: int) -> Reason:
        """Return the reason for a fold of which nothing is known but that it was not done."""
        says = worded("not_with_the_others", {}, self._context.sequence.folds, fold)
        return Reason(fold, Code.WAITS_FOR_FOLD, says)

    def _waiting(self, blocked: list[int]) -> Iterator[Reason]:
        folds = self._context.sequence.folds
        for fold in folds:
            roots = [b for b in blocked if b in self._context.sequence.dag.before(fold.index)]
            if roots and fold.index not in blocked:
                says = worded("waits_for", {"folds": roots}, folds, fold.index)
                yield Reason(fold.index, Code.WAITS_FOR_FOLD, says)
