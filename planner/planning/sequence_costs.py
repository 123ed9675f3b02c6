"""Sequence costs: what steps that follow one another take beyond the sum of their costs.

How soon empty hands come to a transfer depends on the transfer before it. So a sequence cost belongs to a whole
sequence of steps, and the search must know the last steps of a path to count it. It remembers no more of them than the
known sequence costs need: of the steps since, the longest tail with which a sequence begins (as in the automaton of Aho
and Corasick). Without sequence costs, a node of the search is a state and nothing else.
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import NamedTuple, TypeAlias

from planner.motion.plan_segment import PlanSegment
from planner.planning.edges import Edges
from planner.primitives.primitive import Step
from planner.primitives.state import State, StateKey
from planner.search.a_star import DeferredEdges, Edge, Successors

StepKey: TypeAlias = tuple[str, StateKey, StateKey]
"""A step as the search knows it: its kind, and the states before and after it."""

Since: TypeAlias = tuple[StepKey | None, ...]
"""Steps that follow one another; None stands before the first step of a plan."""

START: Since = (None,)


def step_key(step: Step) -> StepKey:
    """Return the search's key of a step: it knows one way between two states."""
    return (step.kind, step.before.key, step.after.key)


class Reached(NamedTuple):
    """A node of the search: a state, and what must be remembered of the steps to it."""

    state: State
    since: Since


class SequenceCosts:
    """The sequence costs known so far."""

    def __init__(self) -> None:
        """Begin with none."""
        self._extra_s: dict[Since, float] = {}
        self._begun: set[Since] = {()}

    def __bool__(self) -> bool:
        """Return whether there is any."""
        return bool(self._extra_s)

    def charge(self, steps: Since, extra_s: float) -> bool:
        """Set what steps that follow one another take in addition (s); return whether it was known."""
        known_s = self._extra_s.get(steps, 0.0)
        if extra_s > 0.0:
            self._extra_s[steps] = extra_s
            self._begun.update(steps[:count] for count in range(len(steps)))
        return known_s == extra_s

    def noted(self, steps: Sequence[Step], plan_segments: Sequence[PlanSegment]) -> Iterator[Sequence[Step]]:
        """Charge the steps of a plan for hands that come late, and yield those for which this was not known."""
        keys, begin, since = [step_key(step) for step in steps], 0, START
        for plan_segment in plan_segments:
            end = plan_segment.first + len(plan_segment.steps)
            since = (*since, *keys[plan_segment.first : end])
            if plan_segment.transfer is not None:
                if not self.charge(since, plan_segment.late_s):
                    yield steps[begin:end]
                begin, since = plan_segment.first, tuple(keys[plan_segment.first : end])

    def after(self, since: Since, step: StepKey) -> tuple[Since, float]:
        """Return what to remember after one more step, and what is charged for it (s)."""
        whole = (*since, step)
        tails = [whole[begin:] for begin in range(len(whole) + 1)]
        return next(tail for tail in tails if tail in self._begun), sum(self._extra_s.get(tail, 0.0) for tail in tails)

    def of(self, steps: Iterable[Step]) -> float:
        """Return all that is charged for the steps of a plan (s)."""
        since, total_s = self.at_start, 0.0
        for step in steps:
            since, extra_s = self.after(since, step_key(step))
            total_s += extra_s
        return total_s

    @property
    def at_start(self) -> Since:
        """What to remember before the first step of a plan."""
        return START if START in self._begun else ()


class ChargedEdges:
    """The successors of each state of a planning problem, with sequence costs."""

    def __init__(self, edges: Edges, sequence_costs: SequenceCosts) -> None:
        """Keep the edges without sequence costs, and these."""
        self._edges = edges
        self._sequence_costs = sequence_costs

    def leaving(self, node: Reached, cost_s: float) -> Successors[Reached, Step]:
        """Return the edges that leave a node reached at a cost (s), and the deferred successors."""
        return self._charged(node.since, self._edges.leaving(node.state, cost_s, node.since))

    def _charged(
        self, since: Since, found: Successors[State, Step]
    ) -> Iterator[Edge[Reached, Step] | DeferredEdges[Reached, Step]]:
        for way in found:
            if isinstance(way, DeferredEdges):
                yield DeferredEdges(way.cost, Reached(way.towards, ()), partial(self._computed, since, way))
            else:
                after, extra_s = self._sequence_costs.after(since, step_key(way.action))
                yield Edge(way.action, way.cost + extra_s, Reached(way.after, after))

    def _computed(self, since: Since, way: DeferredEdges[State, Step]) -> Successors[Reached, Step]:
        return self._charged(since, way.compute())
