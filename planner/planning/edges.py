"""The edges of the search graph: the primitives possible in each state, computed once."""

from collections.abc import Hashable, Iterable
from functools import partial
from typing import NamedTuple, Protocol

from planner.geometry.tolerance import TIME_S
from planner.primitives.context import Context
from planner.primitives.primitive import Deferred, Step, in_time
from planner.primitives.primitive_set import PRIMITIVES
from planner.primitives.state import ANYWHERE, State
from planner.search.a_star import DeferredEdges, Edge, Successors


class Judge(Protocol):
    """Knows which steps the arms could not follow, and what others take."""

    def possible(self, state: State, steps: Iterable[Step]) -> Iterable[tuple[Step, float]]:
        """Return the steps leaving a state that may succeed, each with the least known cost (s)."""
        ...

    def is_in_doubt(self, held: State) -> bool:
        """Return whether spare steps to the grasp of a state are needed by now."""
        ...


class _Found(NamedTuple):
    """The deferred steps and the steps that a primitive found."""

    deferred: tuple[Deferred[Step], ...]
    steps: tuple[Step, ...]

    @staticmethod
    def of(mixed: Iterable[Step | Deferred[Step]]) -> "_Found":
        deferred: list[Deferred[Step]] = []
        steps: list[Step] = []
        for one in mixed:
            if isinstance(one, Deferred):
                deferred.append(one)
            else:
                steps.append(one)
        return _Found(tuple(deferred), tuple(steps))


class Edges:
    """The successors of each state of one planning problem."""

    def __init__(self, context: Context, judge: Judge) -> None:
        """Start with nothing computed; the judge is called each time that edges are wanted."""
        self._primitives = [kind(context) for kind in PRIMITIVES]
        self._context = context
        self._judge = judge
        self._steps: dict[tuple[State, bool], _Found] = {}
        self._expanded: set[State] = set()
        self._left: dict[tuple[object, ...], list[tuple[int, float]]] = {}
        self._worked_out: dict[Deferred[Step], _Found] = {}
        self._towards: dict[Deferred[Step], State] = {}

    @property
    def expanded(self) -> int:
        """The number of distinct states expanded."""
        return len(self._expanded)

    def begin(self) -> None:
        """Begin a search: mark all states as not left yet."""
        self._left.clear()

    def leaving(self, state: State, cost_s: float, since: Hashable = ()) -> Successors[State, Step]:
        """Return the edges that leave a state reached at a cost (s), and the deferred successors.

        Steps that begin with driving are left out where the base could have driven there from a state that was left
        before: from there they took no longer. This holds for states reached by steps since which all costs are alike.
        """
        self._expanded.add(state)
        is_passed = not state.held and self._is_passed(state, cost_s, since)
        key = (state, is_passed)
        if key not in self._steps:
            kinds = [kind for kind in self._primitives if not (is_passed and kind.begins_with_driving)]
            self._steps[key] = _Found.of(one for kind in kinds for one in in_time(kind.successors(state)))
        return self._of(state, self._steps[key])

    def _is_passed(self, state: State, cost_s: float, since: Hashable) -> bool:
        """Return whether the base could have driven here in time from a state left before; otherwise note this one.

        Only states that differ in nothing but the standoff are compared.
        """
        left = self._left.setdefault((state.done, state.place, state.station, since), [])
        drive_s = self._context.drive_s
        if any(before_s + drive_s(abs(standoff - state.standoff)) <= cost_s + TIME_S for standoff, before_s in left):
            return True
        left.append((state.standoff, cost_s))
        return False

    def _of(self, state: State, found: _Found) -> Successors[State, Step]:
        edges: list[Edge[State, Step] | DeferredEdges[State, Step]] = []
        self._collect(state, found, edges)
        return edges

    def _collect(
        self, state: State, found: _Found, edges: list[Edge[State, Step] | DeferredEdges[State, Step]]
    ) -> None:
        """Append the edges of what a primitive found; of deferred steps computed before, those of their results."""
        for later in found.deferred:
            if later.is_spare and not self._judge.is_in_doubt(later.towards):
                continue
            worked_out = self._worked_out.get(later)
            if worked_out is None:
                edges.append(self._edges_of(state, later))
            else:
                self._collect(state, worked_out, edges)
        if found.steps:
            edges += [Edge(step, cost_s, step.after) for step, cost_s in self._judge.possible(state, found.steps)]

    def _edges_of(self, state: State, later: Deferred[Step]) -> DeferredEdges[State, Step]:
        """Return the deferred edges of deferred steps that leave a state."""
        towards = self._towards.get(later)
        if towards is None:
            towards = self._towards[later] = later.towards if later.is_there else _anywhere(later.towards)
        return DeferredEdges(later.duration_s, towards, partial(self._computed, state, later))

    def _computed(self, state: State, later: Deferred[Step]) -> Successors[State, Step]:
        self._worked_out[later] = _Found.of(later.steps())
        return self._of(state, self._worked_out[later])


def _anywhere(state: State) -> State:
    """Return a state that stands for all with these folds done and hands alike, wherever cloth and robot are."""
    return State(state.done, (0.0, 0.0), ANYWHERE, ANYWHERE, dragged=state.dragged)
