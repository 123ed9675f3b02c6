"""The edges of the graph that is searched: the primitives possible in each state, worked out once."""

from collections.abc import Callable, Iterable
from functools import partial
from typing import TypeAlias

from planner.primitives.primitive import Later, Step, in_time
from planner.primitives.primitive_set import PRIMITIVES
from planner.primitives.state import State
from planner.primitives.work import Work
from planner.search.a_star import Edge, Promise, Successors

Possible: TypeAlias = Callable[[State, Iterable[Step]], Iterable[tuple[Step, float]]]
"""Of the steps that leave a state those that are to be followed, each with what it costs (s)."""


class Edges:
    """What can be done in each state of one planning problem."""

    def __init__(self, work: Work, possible: Possible) -> None:
        """Nothing is worked out yet.

        Args:
            work: the problem.
            possible: asked each time that edges are wanted.
        """
        self._primitives = [kind(work) for kind in PRIMITIVES]
        self._possible = possible
        self._steps: dict[State, tuple[Step | Later[Step], ...]] = {}
        self._worked_out: dict[Later[Step], tuple[Step | Later[Step], ...]] = {}

    @property
    def expanded(self) -> int:
        """How many states have been asked about, each counted once."""
        return len(self._steps)

    def leaving(self, state: State) -> Successors[State, Step]:
        """The edges that leave a state, and promises of those that have time."""
        if state not in self._steps:
            self._steps[state] = tuple(one for kind in self._primitives for one in in_time(kind.successors(state)))
        return self._of(state, self._steps[state])

    def _of(self, state: State, found: Iterable[Step | Later[Step]]) -> Successors[State, Step]:
        for later in (one for one in found if isinstance(one, Later)):
            yield Promise(later.duration_s, later.towards, partial(self._redeemed, state, later))
        for step, cost_s in self._possible(state, (one for one in found if not isinstance(one, Later))):
            yield Edge(step, cost_s, step.after)

    def _redeemed(self, state: State, later: Later[Step]) -> Successors[State, Step]:
        if later not in self._worked_out:
            self._worked_out[later] = tuple(later.steps())
        return self._of(state, self._worked_out[later])
