"""A recorded world: replays the observation, the report and the truth of each step."""

from collections.abc import Sequence
from dataclasses import dataclass

from app.rehearsal.world import Observation, Performed, StepMotion, Truth


@dataclass(frozen=True, slots=True)
class Recorded:
    """The record of one step.

    Attributes:
        performed: what the robot said.
        observation: what was seen afterwards.
        truth: where the cloth was afterwards, if somebody knew.
    """

    performed: Performed
    observation: Observation
    truth: Truth | None = None


class ReplayWorld:
    """Replays the record of one step for each step performed, regardless of its motion."""

    def __init__(self, before: Observation, steps: Sequence[Recorded]) -> None:
        """Begin with what was seen before the first step."""
        self._last = Recorded(Performed(), before)
        self._steps = iter(steps)

    def observe(self) -> Observation:
        """Return what was seen after the latest step."""
        return self._last.observation

    def perform(self, motion: StepMotion) -> Performed:
        """Go on to the next record, and return what the robot said.

        Raises:
            LookupError: the record has ended.
        """
        found = next(self._steps, None)
        if found is None:
            raise LookupError(f"the record ends before step {motion.step}")
        self._last = found
        return found.performed

    def truth(self) -> Truth | None:
        """Return where the cloth was after the latest step, if somebody knew."""
        return self._last.truth
