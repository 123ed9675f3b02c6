"""A step that was rejected, and the other ways to do the same."""

from collections.abc import Iterator
from dataclasses import dataclass

from planner.geometry.tolerance import TIME_S
from planner.primitives.primitive import Step


@dataclass(frozen=True, slots=True, eq=False)
class Rejection:
    """A rejected step.

    Attributes:
        culprit: the step.
        before: the steps before it in its transfer.
        elsewhere: a spread of other ways to do the same.
        path_s: the time that the path on which it was rejected seemed to take (s).
    """

    culprit: Step
    before: tuple[Step, ...]
    elsewhere: tuple[Step, ...]
    path_s: float

    def as_good(self) -> Iterator[tuple[Step, ...]]:
        """Yield those ways to the same state that seem to take no longer, each with the steps before it."""
        most_s = self.culprit.duration_s + TIME_S
        for other in self.elsewhere:
            if other.duration_s <= most_s and other.after.key == self.culprit.after.key:
                yield (*self.before, other)
