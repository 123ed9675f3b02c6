"""Tasks that are given up: the same arms failed at them several times from one station, and never succeeded."""

from collections import Counter

from planner.primitives.primitive import Step


class FailureMemory:
    """The tasks given up in one search, wherever the cloth lies."""

    def __init__(self, failures_max: int) -> None:
        """Start without any; a task is given up after so many failures."""
        self._failures_max = failures_max
        self._failures: Counter[tuple[object, ...]] = Counter()
        self._succeeded: set[tuple[object, ...]] = set()
        self._stations: dict[tuple[object, ...], int] = {}

    def __contains__(self, step: Step) -> bool:
        """Return whether the step's task is given up."""
        return bool(self._stations) and step.task in self._stations

    def is_given_up_from(self, station: int) -> bool:
        """Return whether some task is given up from a station."""
        return station in self._stations.values()

    def fail(self, step: Step) -> None:
        """Note that a step failed."""
        self._failures[step.task] += 1
        if self._failures[step.task] >= self._failures_max and step.task not in self._succeeded:
            self._stations[step.task] = step.before.station

    def succeed(self, step: Step) -> None:
        """Note that a step succeeded: its task is not given up, or no longer."""
        self._succeeded.add(step.task)
        self._stations.pop(step.task, None)
