"""A judge of edges to which all steps are as good as they seem."""

from collections.abc import Iterable, Iterator

from planner.primitives.primitive import Step
from planner.primitives.state import State


class Unjudged:
    """Lets every step pass, whether arms can follow it or not."""

    def __init__(self, *, are_spares_wanted: bool = False) -> None:
        self._are_spares_wanted = are_spares_wanted

    def possible(self, _state: State, steps: Iterable[Step]) -> Iterator[tuple[Step, float]]:
        return ((step, step.duration_s) for step in steps)

    def is_in_doubt(self, _held: State) -> bool:
        return self._are_spares_wanted
