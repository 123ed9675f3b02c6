"""What a primitive and a step of it are. To add one, write its file and name its class in `PRIMITIVES`."""

from collections.abc import Iterable
from typing import Any, Protocol

from planner.primitives.grip import Grip
from planner.primitives.phase import Phase
from planner.primitives.state import State


class Step(Protocol):
    """One primitive as it is performed in a plan: where it starts, where it leads, what it takes."""

    @property
    def kind(self) -> str:
        """The primitive's name in a plan."""
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

    @property
    def summary(self) -> str:
        """What it does, in a few words."""
        ...

    def phases(self) -> tuple[Phase, ...]:
        """What it looks like while it happens; their durations add up to `duration_s`."""
        ...


class Primitive(Protocol):
    """A kind of motion, for one planning problem."""

    def successors(self, state: State) -> Iterable[Step]:
        """The steps of this kind that are possible in a state."""
        ...
