"""The protocols of a primitive and of its steps. To add one, write its file and name its class in `PRIMITIVES`."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

from planner.geometry.pose import Approach, FloatArray, Point2
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.primitives.state import State
from planner.task.plan import PlanStep
from planner.task.trajectory import Phase, Segment
from planner.task.world_state import Grip, Holding


class Step(Protocol):
    """A primitive as a step of a plan: the states before and after it, its duration and its motion.

    By its keys answers about it are kept and shared. Alternatives to it are tried where it has no joint paths, or in a
    similar task.
    """

    @property
    def kind(self) -> str:
        """The primitive's name in a plan."""
        ...

    @property
    def before(self) -> State:
        """The state it starts in."""
        ...

    @property
    def after(self) -> State:
        """The state it leads to."""
        ...

    @property
    def duration_s(self) -> float:
        """Its duration (s)."""
        ...

    @property
    def grips(self) -> tuple[Grip, ...]:
        """The picks and places of the hands, from the leftmost arm to the rightmost."""
        ...

    @property
    def details(self) -> dict[str, Any]:
        """The fields of its JSON that only this kind has."""
        ...

    def holdings(self) -> tuple[Holding, ...]:
        """Return what each arm holds, from the leftmost to the rightmost, and which vertices had to be held."""
        ...

    @property
    def phases(self) -> tuple[Phase, ...]:
        """The phases of the motion; their durations add up to those of the step."""
        ...

    def extremes(self) -> tuple[Phase, ...]:
        """Return phases that begin and end as it does while cloth is held; in between they need not be true to it."""
        ...

    @property
    def hands(self) -> Mapping[int, Approach]:
        """The orientation in which each arm's hand takes hold, by the arm's number."""
        ...

    @property
    def motion(self) -> tuple[object, ...]:
        """The key that tells it from other steps of the same task, the way it is done included."""
        ...

    @property
    def situation(self) -> tuple[object, ...]:
        """The key it shares with the same motion while the base stands elsewhere; see `begun_in`."""
        ...

    @property
    def task(self) -> tuple[object, ...]:
        """The key it shares with the same step from the same station by the same arms, wherever the cloth lies."""
        ...

    def variants(self) -> "Iterable[Step]":
        """Return this step, then every other way between the same two states, the quickest first."""
        ...

    @property
    def turns(self) -> Mapping[int, int]:
        """The number of the approach in which each arm takes or holds its grip."""
        ...

    def turned(self, turns: Mapping[int, int]) -> "Iterable[Step]":
        """Return this step with the hands in given approaches, if they can be and are not; at most one."""
        ...

    def begun_in(self, state: State) -> "Step":
        """Return the step begun in another state of the same situation."""
        ...

    def elsewhere(self, count: int) -> "Iterable[Step]":
        """Return about `count` other ways to do it from the same state, with the base at other standoffs."""
        ...

    def again(self, context: Context, state: State) -> "Iterable[Step]":
        """Return the step repeated in a state of another, similar task, the most alike first; empty if it cannot be."""
        ...


S = TypeVar("S", bound=Step, covariant=True)


@dataclass(frozen=True, eq=False)
class Deferred(Generic[S]):
    """Successors that are computed only when nothing quicker is left to try.

    Attributes:
        duration_s: a lower bound on the duration of each (s). A step may be shorter if the steps that must follow it
            take longer than they seem by as much.
        towards: a state at least as near to the end of all folds as any state they lead to. Where it says that a drag's
            grips are held but not which, any may be.
        steps: computes them; some of the results may be deferred once more.
        is_spare: whether they are of no use as long as all other ways to and from the grasp of `towards` are validated
            and take no longer than they seem.
        is_there: whether all of them leave the garment and the robot where `towards` says; if not, only the folds done
            and whether something is held count of it.
    """

    duration_s: float
    towards: State
    steps: "Callable[[], Iterable[S | Deferred[S]]]"
    is_spare: bool = False
    is_there: bool = False


@dataclass(frozen=True, eq=False)
class DeferredSteps(Generic[S]):
    """The steps that leave a state, most of them not computed yet; iterating computes them all.

    Attributes:
        found: steps and deferred steps.
    """

    found: "tuple[S | Deferred[S], ...]"

    def __iter__(self) -> Iterator[S]:
        """Yield all steps, computing the deferred ones."""
        return _worked_out(self.found)


HeldTools: TypeAlias = Callable[[Segment, float], Mapping[int, FloatArray]]
"""Where each arm that holds cloth must have its tool, given a segment and a time in it: table frame, shape (3,), m."""


class Primitive(Protocol):
    """A kind of motion, for one task.

    Attributes:
        kind: the name of its steps in a plan.
        begins_with_driving: whether the base may first drive to another standoff at its station, at the cost of the
            drive; a step begun there then costs that much less.
    """

    kind: str
    begins_with_driving: bool

    def __init__(self, context: Context) -> None:
        """Take the task's planning context; nothing is computed before it is needed."""

    def successors(self, state: State) -> Iterable[Step]:
        """Return the possible steps of this kind in a state; `DeferredSteps` where computing them is slow."""
        ...

    def tools(self, step: PlanStep, taken: Mapping[int, Point2], before: State, after: State) -> HeldTools:
        """Return where a step of this kind from elsewhere must have its tools while it holds cloth.

        Args:
            step: the step.
            taken: the point that each arm holds, garment frame (m).
            before: the state it starts in.
            after: the state it leads to.

        Raises:
            RequestError: these grips do not hold what the step needs.
        """
        ...


def is_taken_alike(taken: Mapping[int, Point2], other: Mapping[int, Point2]) -> bool:
    """Return whether the same arms hold the same points, within the tolerance."""
    return taken.keys() == other.keys() and all(math.dist(taken[arm], other[arm]) <= LENGTH_M for arm in taken)


def in_time(found: Iterable[Step]) -> "Iterable[Step | Deferred[Step]]":
    """Return the steps that leave a state, deferred ones still deferred."""
    return found.found if isinstance(found, DeferredSteps) else found


def _worked_out(found: "Iterable[S | Deferred[S]]") -> Iterator[S]:
    for one in found:
        if isinstance(one, Deferred):
            yield from _worked_out(one.steps())
        else:
            yield one
