"""What a primitive and a step of it are. To add one, write its file and name its class in `PRIMITIVES`."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from planner.primitives.context import Context
from planner.primitives.state import State
from planner.task.grip import Grip, Holding
from planner.task.phase import Phase


class Step(Protocol):
    """One primitive as it is performed in a plan: where it starts, where it leads, what it takes."""

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
        """How long it takes (s)."""
        ...

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Where the hands go, from the leftmost arm to the rightmost."""
        ...

    @property
    def details(self) -> dict[str, Any]:
        """The fields of its JSON that only this kind has."""
        ...

    def holdings(self) -> tuple[Holding, ...]:
        """Return what each arm holds, from the leftmost to the rightmost, and which vertices had to be held."""
        ...

    def phases(self) -> tuple[Phase, ...]:
        """What it looks like while it happens; their durations add up to `duration_s`."""
        ...

    def extremes(self) -> tuple[Phase, ...]:
        """Phases that begin and end where it does while cloth is held; what they are in between does not matter."""
        ...

    def variants(self) -> "Iterable[Step]":
        """This step, and every other way between the same two states, the quickest first."""
        ...

    @property
    def motion(self) -> tuple[object, ...]:
        """What tells it from other steps of the same problem, the way it is done included."""
        ...

    @property
    def situation(self) -> tuple[object, ...]:
        """What it has in common with the same done while the base stands elsewhere; see `begun_in`."""
        ...

    @property
    def task(self) -> tuple[object, ...]:
        """What it has in common with the same done from the same station by the same arms, wherever the cloth lies."""
        ...

    def begun_in(self, state: State) -> "Step":
        """The same from another state of the same situation."""
        ...

    def elsewhere(self, count: int) -> "Iterable[Step]":
        """So many other ways to do the same from the same state, the base starting and ending elsewhere."""
        ...

    def again(self, context: Context, state: State) -> "Iterable[Step]":
        """The same in a state of another problem, a garment that differs a little: the likest first, if any can be."""
        ...


S = TypeVar("S", bound=Step, covariant=True)


@dataclass(frozen=True, eq=False)
class Deferred(Generic[S]):
    """Steps that are worked out only when nothing quicker is left to try.

    Attributes:
        duration_s: none of them takes less (s), or else what has to follow takes so much more than it seems.
        towards: none of them leads to a state nearer to the end of all folds. Where it says that a drag's grips are
            held but not which, any may be.
        steps: works them out; of some it may say once more that there is time.
        is_spare: whether they are of no use as long as all other ways to and from the grasp of `towards` are real and
            take no longer than they seem.
        is_there: whether all of them leave the article and the robot where `towards` says; else only the folds done
            and whether something is held count of it.
    """

    duration_s: float
    towards: State
    steps: "Callable[[], Iterable[S | Deferred[S]]]"
    is_spare: bool = False
    is_there: bool = False


@dataclass(frozen=True, eq=False)
class DeferredSteps(Generic[S]):
    """The steps that leave a state, most of them not worked out yet; to go through them works them all out.

    Attributes:
        found: steps, and what there is time for.
    """

    found: "tuple[S | Deferred[S], ...]"

    def __iter__(self) -> Iterator[S]:
        """All steps."""
        return _worked_out(self.found)


class Primitive(Protocol):
    """A kind of motion, for one planning problem.

    Attributes:
        begins_with_driving: whether the base may first drive on, closer to its station or further off, at the cost of
            the way: what begins further on costs so much less.
    """

    begins_with_driving: bool

    def successors(self, state: State) -> Iterable[Step]:
        """The steps of this kind that are possible in a state; `DeferredSteps` where working them out takes long."""
        ...


def in_time(found: Iterable[Step]) -> "Iterable[Step | Deferred[Step]]":
    """Steps that leave a state, those that have time as such."""
    return found.found if isinstance(found, DeferredSteps) else found


def _worked_out(found: "Iterable[S | Deferred[S]]") -> Iterator[S]:
    for one in found:
        if isinstance(one, Deferred):
            yield from _worked_out(one.steps())
        else:
            yield one
